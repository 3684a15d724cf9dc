// The first candidate of every cluster, from the prefix sum of the heads.
#include "irradiance_cache/placement.glsl"
layout(scalar) readonly buffer Heads { uint heads[]; };
layout(scalar) readonly buffer HeadsBefore { uint heads_before[]; };
layout(scalar) writeonly buffer Starts { uint starts[]; };

void main() {
  uint index = global_index();
  if (index >= push.count) return;
  if (heads[index] != 0u) starts[heads_before[index]] = index;
}
