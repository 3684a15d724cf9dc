// Sorts the photons by table entry and writes each entry's range.
#include "shaders/shared/photons/photons.h"
#include "shaders/shared/sort.h"
#include "lib/invocation.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PhotonListPush push; };
uniform usamplerBuffer photon_sorted;  // SortEntry64
uniform samplerBuffer photon_list_texels;
layout(scalar) writeonly buffer PhotonMap { vec4 photon_map[]; };
layout(scalar) writeonly buffer PhotonTable { uint photon_table_words[]; };  // two for each entry: first photon, one past the last

void main() {
  uint i = global_index();
  if (i >= push.count) return;
  uint own = texelFetch(photon_sorted, int(i)).y, value = texelFetch(photon_sorted, int(i)).z;
  uint before = texelFetch(photon_sorted, int(max(i, 1u) - 1u)).y, behind = texelFetch(photon_sorted, int(min(i + 1u, push.count - 1u))).y;
  for (uint t = 0u; t < k_photon_texels; ++t)
    photon_map[k_photon_texels * i + t] = texelFetch(photon_list_texels, int(k_photon_texels * value + t));
  if (i == 0u || before != own) photon_table_words[2u * own] = i;
  if (i + 1u == push.count || behind != own) photon_table_words[2u * own + 1u] = i + 1u;
}
