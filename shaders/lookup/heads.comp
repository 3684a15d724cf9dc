// Octree, step 7: counts the leaves that begin in every run of the sorted references.
#include "lib/octree_leaves.glsl"
layout(local_size_x = LUCERNA_OCTREE_GROUP) in;
layout(scalar) writeonly buffer RunLeaves { uint run_leaves[]; };

void main() {
  if (global_index() >= LUCERNA_OCTREE_RUNS) return;
  Run run = own_run(global_index(), reference_count());
  uint leaves = 0u, previous = run.first > 0u ? reference_code(run.first - 1u) : k_octree_no_leaf;
  for (uint at = run.first; at < run.end; at += 2u) {
    uvec4 two = texelFetch(octree_references, int(at >> 1));
    leaves += two.x != previous ? 1u : 0u;
    leaves += at + 1u < run.end && two.z != two.x ? 1u : 0u;
    previous = two.z;
  }
  run_leaves[global_index()] = leaves;
}
