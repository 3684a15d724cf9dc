// What the kernels share that split crowded leaves: what a reference of the octree before that is, two a texel.
#ifndef LUCERNA_LIB_OCTREE_SPLIT
#define LUCERNA_LIB_OCTREE_SPLIT
#include "lib/octree_cells.glsl"

uvec2 reference_pair(uint index) {
  uvec4 two = texelFetch(octree_references, int(index >> 1));
  return (index & 1u) != 0u ? two.zw : two.xy;
}
#endif
