// Octree, step 4, one workgroup: chooses the finest level, at most the requested one, whose references fit into memory.
#include "lib/octree_build.glsl"
layout(local_size_x = 256) in;   // 16 invocations a level
layout(scalar) readonly buffer RunNeeds { uint run_needs[]; };
layout(scalar) buffer OctreeHeaders { OctreeHeader octree; };
shared uint needs[256];

uint saturating_sum(uint a, uint b) { return a + b < a ? 0xffffffffu : a + b; }

void main() {
  uint lane = gl_LocalInvocationIndex, k = lane / 16u, need = 0u;
  if (k <= k_octree_levels)
    for (uint i = lane % 16u; i < LUCERNA_OCTREE_RUNS; i += 16u)
      need = saturating_sum(need, run_needs[i * (k_octree_levels + 1u) + k]);
  needs[lane] = need;
  barrier();
  if (lane != 0u) return;
  uint level = octree.wanted_level, chosen = 0u;
  for (uint coarser = 0u; coarser <= level; ++coarser) {
    need = 0u;
    for (uint i = 0u; i < 16u; ++i) need = saturating_sum(need, needs[coarser * 16u + i]);
    if (coarser == 0u) octree.needed = need;
    chosen = coarser;
    if (need <= push.level_capacity) break;
  }
  octree.overflow = need > octree.capacity ? need - octree.capacity : 0u;
  octree.level = level - chosen;
  octree.cells = octree.cells >> chosen;
  octree.leaf = ldexp(octree.leaf, int(chosen));
  octree.inverse_leaf = ldexp(octree.inverse_leaf, -int(chosen));
}
