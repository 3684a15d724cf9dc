// Contribution of each pilot photon to the picture, in map order: flux times the importance around it.
#include "shaders/shared/photons/photons.h"
#include "shaders/shared/sort.h"
#include "lib/invocation.glsl"
#include "lib/frame.glsl"
#include "lib/emission.glsl"
#include "photons/importance.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonContributionPush push; };
uniform samplerBuffer photon_texels;
uniform usamplerBuffer photon_sorted;  // SortEntry64: its lower word is the photon's number
layout(scalar) readonly buffer PhotonRadiances { float photon_radiances[]; };
layout(scalar) writeonly buffer PhotonContributions { PhotonContribution photon_contributions[]; };

void main() {
  uint to = global_index(), i = push.first + to;
  if (to >= push.count) return;
  vec4 a = texelFetch(photon_texels, int(k_photon_texels * i)), b = texelFetch(photon_texels, int(k_photon_texels * i + 1u));
  uvec4 entry = texelFetch(photon_sorted, int(i));  // number, entry of the table, place in the list
  uint id = entry.x, part = floatBitsToUint(b.w) >> k_photon_part_shift & 3u;
  float radius = importance_radius(a.xyz), importance = float(importance_around(a.xyz)) / (radius * radius);
  uint stratum = 0u, light = 0u;
  float own = 1.0;
#if LUCERNA_LIGHTS
  // An unaimed path counts only with the light that no aimed path could contribute.
  Emission e = sample_emission(make_light_sampler(id >> k_photon_id_events, photons.round, frame.seed), push.step);
  stratum = e.stratum;
  light = e.light;
  own = stratum == 0u ? e.unaimed : 1.0;
#endif
  bool contributes = part > 0u || is_component(photons.component[0] & 15u);
  float contribution = contributes ? own * luminance(b.rgb) * importance : 0.0;
  bool stored = photons.stores_radiance != 0u && part == k_photon_caustic_part;
  vec3 front = facet_unpack(floatBitsToUint(b.w) & k_photon_facet);
  bool lit_front = dot(photon_direction(floatBitsToUint(a.w)), front) > 0.0;
  photon_contributions[to] = PhotonContribution(stratum, light, id, contribution, a.xyz, importance, stored ? luminance(b.rgb) : 0.0,
                                  stored ? photon_radiances[entry.z] : 0.0, facet_pack(lit_front ? front : -front),
                                  (floatBitsToUint(b.w) & k_photon_unreachable) != 0u ? 1u : 0u);
}
