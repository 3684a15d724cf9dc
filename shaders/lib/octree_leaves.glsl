// Common to the kernels that make leaves of the sorted references.
#ifndef LUCERNA_LIB_OCTREE_LEAVES
#define LUCERNA_LIB_OCTREE_LEAVES
#include "lib/octree_build.glsl"

layout(scalar) buffer OctreeHeaders { OctreeHeader octree; };
uniform usamplerBuffer octree_references;   // sorted (code, sphere) pairs, two a texel
uniform usamplerBuffer leaf_texels;         // (code, first reference) pairs

uint reference_count() { return min(octree.references, push.capacity); }

uvec2 reference_pair(uint index) { return pair_of(texelFetch(octree_references, int(index >> 1)), index); }
uint reference_code(uint index) { return reference_pair(index).x; }
uint reference_sphere(uint index) { return reference_pair(index).y; }
uvec2 leaf_pair(uint index) { return pair_of(texelFetch(leaf_texels, int(index >> 1)), index); }
// End of a leaf's references.
uint leaf_end(uint leaf) { return leaf + 1u < octree.leaves ? leaf_pair(leaf + 1u).y : reference_count(); }

// Size of the hash table for that many leaves, as a power of two: half full at most, if there is memory; never full.
uint table_bits(uint leaves) {
  uint bits = uint(findMSB(max(2u * leaves, 2u) - 1u) + 1);
  return min(bits, uint(findMSB(push.slot_capacity)));
}
#endif
