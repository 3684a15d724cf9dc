// What the photons of the pilot bring to the picture, in the order of the map: flux, times what hangs on the lookups around.
#include "shaders/shared/photons/photons.h"
#include "shaders/shared/sort.h"
#include "lib/invocation.glsl"
#include "lib/frame.glsl"
#include "lib/emission.glsl"
#include "photons/photon.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonWorthPush push; };
uniform samplerBuffer photon_texels;
uniform usamplerBuffer photon_sorted;  // SortEntry64: its lower word is the photon's number
layout(scalar) readonly buffer PhotonImportance { uint photon_importance[]; };
layout(scalar) writeonly buffer PhotonWorths { PhotonWorth photon_worths[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  vec4 a = texelFetch(photon_texels, int(k_photon_texels * i)), b = texelFetch(photon_texels, int(k_photon_texels * i + 1u));
  uint path = texelFetch(photon_sorted, int(i)).x >> k_photon_id_events;
  float radius = photon_radius(a.xyz);
  int level = photon_level(radius);
  ivec3 cell = ivec3(floor(a.xyz * photon_inverse_cell(level) - 0.5));
  uint hangs = 0u;
  for (uint k = 0u; k < k_photon_near_cells; ++k)
    hangs += photon_importance[photon_entry_of(cell + (ivec3(k) >> ivec3(0, 1, 2) & 1), level, k_photon_importance_entries - 1u)];
  uint stratum = 0u;
  float own = 1.0;
#if LUCERNA_LIGHTS
  // What is not aimed has brought by itself only what no aimed path would have brought as well.
  Emission e = sample_emission(make_light_sampler(path, photons.round, frame.seed), push.step);
  stratum = e.stratum;
  own = stratum == 0u ? e.unaimed : 1.0;
#endif
  photon_worths[i] = PhotonWorth(stratum, own * luminance(b.rgb) * float(hangs) / (radius * radius));
}
