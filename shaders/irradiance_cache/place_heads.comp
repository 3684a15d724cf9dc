// Marks where clusters begin among the sorted candidates: where two neighbours do not share a cell of about four times the
// smaller reach, and where a cluster is full.
#include "irradiance_cache/placement.glsl"
layout(scalar) writeonly buffer Heads { uint heads[]; };

// Bits of the Morton code below the cell of a candidate's cluster.
int cell_bits(float reach) {
  return 3 * clamp(exponent_of(4.0 * reach) - grid.exponent, 0, int(k_morton_bits));
}

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uvec4 entry = texelFetch(entry_texels, int(index)), before = texelFetch(entry_texels, int(max(index, 1u) - 1u));
  float reach = texelFetch(place_texels, int(entry.z)).w, reach_before = texelFetch(place_texels, int(before.z)).w;
  int bits = min(cell_bits(reach), cell_bits(reach_before));
  uint low = entry.x ^ before.x, high = entry.y ^ before.y;
  bool apart = bits < 32 ? high != 0u || (low >> bits) != 0u : (high >> (bits - 32)) != 0u;
  heads[index] = index % k_cluster_most == 0u || apart ? 1u : 0u;
}
