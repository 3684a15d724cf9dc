// Octree, step 8: writes the leaves in the order of their codes: code and first reference. A leaf ends where the next
// begins.
#include "lib/octree_leaves.glsl"
layout(local_size_x = LUCERNA_OCTREE_GROUP) in;
layout(scalar) readonly buffer RunLeaves { uint run_leaves[]; };   // prefix sum
layout(scalar) writeonly buffer Leaves { SortPair leaves[]; };

void main() {
  if (global_index() >= LUCERNA_OCTREE_RUNS) return;
  Run run = own_run(global_index(), reference_count());
  uint leaf = run_leaves[global_index()];
  uint previous = run.first > 0u ? reference_code(run.first - 1u) : k_octree_no_leaf;
  for (uint at = run.first; at < run.end; at += 2u) {
    uvec4 two = texelFetch(octree_references, int(at >> 1));
    if (two.x != previous) {
      leaves[leaf] = SortPair(two.x, at);
      leaf++;
    }
    if (at + 1u < run.end && two.z != two.x) {
      leaves[leaf] = SortPair(two.z, at + 1u);
      leaf++;
    }
    previous = two.z;
  }
}
