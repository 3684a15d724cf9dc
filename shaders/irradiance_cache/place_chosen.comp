// Marks the chosen candidates in sorted order.
#include "irradiance_cache/placement.glsl"
layout(scalar) readonly buffer Ranks { uint ranks[]; };
layout(scalar) writeonly buffer Heads { uint heads[]; };

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  heads[index] = ranks[index] != 0u ? 1u : 0u;
}
