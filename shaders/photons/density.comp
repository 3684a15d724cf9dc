// Value of the density view (k_density_of_*) at every pixel, and its maximum as the bits of a float.
#include "lib/invocation.glsl"
#include "overlay/lookup_place.glsl"
const uint k_photons_around = 192u;
#include "photons/around.glsl"
#include "photons/importance.glsl"
#include "lib/delegated_regions.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonDensityPush push; };
layout(scalar) writeonly buffer PhotonDensities { float densities[]; };
layout(scalar) buffer PhotonDensityMost { uint density_most; };

void photon_met(vec4 a, vec4 b, vec3 wi, float kernel) {}

void main() {
  uint pixel = push.first + global_index();
  if (global_index() >= push.count) return;
  LookupPlace seen = lookup_place(pixel, push.width, push.grid, seen_at(pixel, push.width, push.height));
  float value = 0.0;
  if (push.of == k_density_of_importance) {
    float radius = importance_radius(seen.position);
    value = float(importance_around(seen.position)) / (radius * radius);
  } else if (push.of == k_density_of_caustics) {
    uint x = pixel % push.width, y = pixel / push.width;
    value = 1.0 - delegated_share((vec2(x, y) + 0.5) / vec2(push.width, push.height));
  } else {
    Around around = photons_around(seen.position, seen.normal, seen.diffuse);
    value = push.of == k_density_of_photons ? around.density : push.of == k_photons_in_disc ? around.count : luminance(around.irradiance);
  }
  value = seen.diffuse ? value : k_density_none;
  densities[pixel] = value;
  if (value > 0.0) atomicMax(density_most, floatBitsToUint(value));
}
