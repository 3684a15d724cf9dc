// Copies the entries of the chosen candidates, in order.
#include "irradiance_cache/placement.glsl"
layout(scalar) readonly buffer Heads { uint heads[]; };
layout(scalar) readonly buffer HeadsBefore { uint heads_before[]; };
layout(scalar) writeonly buffer Kept { SortEntry64 kept[]; };

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  uvec4 entry = texelFetch(entry_texels, int(index));
  if (heads[index] != 0u) kept[heads_before[index]] = SortEntry64(entry.x, entry.y, entry.z, 0u);
}
