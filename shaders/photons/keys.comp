// Sort key of each photon: its table entry, then its number, which orders the photons of one entry.
#include "photons/photon.glsl"
#include "shaders/shared/sort.h"
#include "lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonListPush push; };
uniform samplerBuffer photon_list_texels;
layout(scalar) readonly buffer PhotonIds { uint photon_ids[]; };
layout(scalar) writeonly buffer PhotonKeys { SortEntry64 photon_keys[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  vec3 x = texelFetch(photon_list_texels, int(k_photon_texels * i)).xyz;
  int level = photon_level(photon_radius(x));
  photon_keys[i] = SortEntry64(photon_ids[i], photon_entry(ivec3(floor(x * photon_inverse_cell(level))), level), i, 0u);
}
