// Each photon's entry of the table.
#include "photons/photon.glsl"
#include "shaders/shared/sort.h"
#include "lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonListPush push; };
uniform samplerBuffer photon_list_texels;
layout(scalar) writeonly buffer PhotonPairs { SortPair photon_pairs[]; };

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  vec3 x = texelFetch(photon_list_texels, int(k_photon_texels * i)).xyz;
  int level = photon_level(photon_radius(x));
  photon_pairs[i] = SortPair(photon_entry(ivec3(floor(x * photon_inverse_cell(level))), level), i);
}
