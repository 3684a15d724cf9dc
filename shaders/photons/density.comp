// How dense photons lie on what each pixel shows, or what they bring there; and the greatest of it, as bits of a float.
#include "lib/invocation.glsl"
#include "overlay/seen.glsl"
#include "photons/around.glsl"
#include "photons/importance.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonDensityPush push; };
layout(scalar) writeonly buffer PhotonDensities { float densities[]; };
layout(scalar) buffer PhotonDensityMost { uint density_most; };

void photon_met(vec4 a, vec4 b, vec3 wi, float kernel) {}

void main() {
  uint pixel = global_index();
  if (pixel >= push.width * push.height) return;
  Seen seen = seen_at(pixel, push.width, push.height);
  Around around = photons_around(seen.position, seen.normal, seen.solid);
  float near = importance_radius(seen.position);
  float importance = seen.solid && push.of == k_density_of_importance ? float(importance_around(seen.position)) / (near * near) : 0.0;
  float value = push.of == k_density_of_importance ? importance : push.of == k_density_of_photons ? around.density : push.of == k_photons_in_disc ? around.count : luminance(around.irradiance);
  densities[pixel] = seen.solid ? value : k_density_none;
  if (value > 0.0) atomicMax(density_most, floatBitsToUint(value));
}
