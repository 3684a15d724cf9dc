// Octree, step 9: clears the hash table, sized for the leaves.
#include "lib/octree_leaves.glsl"
layout(local_size_x = LUCERNA_OCTREE_GROUP) in;
layout(scalar) writeonly buffer SlotLeaves { uint slot_leaves[]; };

void main() {
  if (global_index() >= LUCERNA_OCTREE_RUNS) return;
  uint bits = table_bits(octree.leaves);
  if (global_index() == 0u) {
    octree.slots = 1u << bits;
    octree.slot_shift = 32u - bits;
  }
  Run run = own_run(global_index(), 1u << bits);
  for (uint at = run.first; at < run.end; ++at) slot_leaves[at] = k_octree_no_leaf;
}
