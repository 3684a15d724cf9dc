// Octree, step 10: inserts the leaves into the hash table. Linear probing in which lower indices displace higher ones: the
// table does not depend on the order of insertion (Shun and Blelloch 2014, Phase-concurrent hash tables for determinism).
#include "lib/octree_leaves.glsl"
layout(local_size_x = LUCERNA_OCTREE_GROUP) in;
layout(scalar) buffer SlotLeaves { uint slot_leaves[]; };

void main() {
  if (global_index() >= LUCERNA_OCTREE_RUNS) return;
  // Shorter runs than in other steps: each leaf takes a few iterations.
  uint length = run_length(octree.leaves, k_least_run, LUCERNA_OCTREE_RUNS);
  Run run = run_of(global_index(), run_count(octree.leaves, length), length, octree.leaves);
  for (uint at = run.first; at < run.end; ++at) {
    uint leaf = at, slot = (leaf_pair(at).x * k_octree_hash) >> octree.slot_shift;
    while (leaf != k_octree_no_leaf) {
      uint there = atomicMin(slot_leaves[slot], leaf);
      leaf = there == k_octree_no_leaf ? there : max(leaf, there);
      slot = (slot + 1u) & (octree.slots - 1u);
    }
  }
}
