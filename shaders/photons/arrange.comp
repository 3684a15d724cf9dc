// Puts the photons into the order of their entries, and tells each entry where its photons lie.
#include "shaders/shared/photons/photons.h"
#include "shaders/shared/sort.h"
#include "lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonListPush push; };
layout(scalar) readonly buffer PhotonSorted { SortPair photon_sorted[]; };
uniform samplerBuffer photon_list_texels;
layout(scalar) writeonly buffer PhotonMap { vec4 photon_map[]; };
layout(scalar) writeonly buffer PhotonTable { uint photon_table_words[]; };  // two an entry: first, behind the last

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  SortPair own = photon_sorted[i];
  uint before = photon_sorted[max(i, 1u) - 1u].key, behind = photon_sorted[min(i + 1u, push.count - 1u)].key;
  for (uint t = 0u; t < k_photon_texels; ++t)
    photon_map[k_photon_texels * i + t] = texelFetch(photon_list_texels, int(k_photon_texels * own.value + t));
  if (i == 0u || before != own.key) photon_table_words[2u * own.key] = i;
  if (i + 1u == push.count || behind != own.key) photon_table_words[2u * own.key + 1u] = i + 1u;
}
