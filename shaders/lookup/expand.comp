// Octree, step 11: fills every slot of the hash table with what lookups read: code, first, last, and the split of the leaf.
// For leaves about to be split, LeafSplits and LeafCells provide it; for split ones, their only reference.
#include "lib/octree_leaves.glsl"
layout(local_size_x = LUCERNA_OCTREE_GROUP) in;
uniform usamplerBuffer slot_leaf_texels;
layout(scalar) readonly buffer LeafSplits { uint leaf_splits[]; };
layout(scalar) readonly buffer LeafCells { uint leaf_cells[]; };   // prefix sum
layout(scalar) writeonly buffer Slots { uvec4 slots[]; };

void main() {
  if (global_index() >= LUCERNA_OCTREE_RUNS) return;
  Run run = own_run(global_index(), octree.slots);
  for (uint at = run.first; at < run.end; ++at) {
    uvec4 four = texelFetch(slot_leaf_texels, int(at >> 2));
    uvec2 two = (at & 2u) != 0u ? four.zw : four.xy;
    uint leaf = (at & 1u) != 0u ? two.y : two.x;
    bool there = leaf != k_octree_no_leaf;
    uvec2 own = leaf_pair(there ? leaf : 0u);
    uint sphere = reference_sphere(own.y);
    bool split = there && (sphere & k_octree_split) != 0u;
    uint levels = there && !split && push.most_split > 0u ? leaf_splits[leaf] : 0u;
    uint how = split ? sphere & ~k_octree_split : levels > 0u ? leaf_cells[leaf] | levels : 0u;
    slots[at] = there ? uvec4(own, split ? own.y : leaf_end(leaf), how) : uvec4(k_octree_no_leaf, 0u, 0u, 0u);
  }
}
