// Morton code of every candidate's cell.
#include "irradiance_cache/placement.glsl"
layout(scalar) writeonly buffer Entries { SortEntry64 entries[]; };

// Inserts two zero bits after each of 10 or 11.
uint spread(uint x) {
  x &= 0x3ffu;
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  precise vec3 offset = texelFetch(place_texels, int(index)).xyz - grid.origin, scaled = offset * grid.scale;
  uvec3 cell = min(uvec3(scaled), uvec3((1u << k_morton_bits) - 1u));
  // Bits 0-9 of each axis become bits 0-29 of the code; bits 10-19 become bits 30-59.
  uint low = spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2;
  uvec3 upper = cell >> 10;
  uint high = spread(upper.x) | spread(upper.y) << 1 | spread(upper.z) << 2;
  uvec3 top = upper >> 10;  // bit 20 of the cell: bits 60-62
  uint tops = top.x | top.y << 1 | top.z << 2;
  entries[index] = SortEntry64(low | high << 30, high >> 2 | tops << 28, index, 0u);
}
