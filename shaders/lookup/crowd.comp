// Octree, splitting 1: by how many levels every leaf is to be split, one invocation each: so that its cells are no larger
// than the mean diameter of the spheres that it lists, if it lists many. Where small spheres crowd among large ones, the leaves
// that all of them together call for are too large.
#include "lib/octree_leaves.glsl"
layout(local_size_x = 64) in;
layout(scalar) writeonly buffer LeafSplits { uint leaf_splits[]; };   // levels
layout(scalar) writeonly buffer LeafCells { uint leaf_cells[]; };     // that each is split into; 0: it is not
const uint k_sampled = 64u;

void main() {
  uint leaf = global_index();
  if (leaf >= octree.leaves) return;
  uint first = leaf_pair(leaf).y, last = leaf_end(leaf);
  uint n = last - first, sampled = min(n, k_sampled);
  float sum = 0.0;
  for (uint k = 0u; k < sampled; ++k)
    sum += 2.0 * texelFetch(spheres, int(reference_sphere(first + k * n / sampled))).w;
  float mean = sum / float(sampled);
  uint levels = 0u;
  for (float cell = octree.leaf; levels < push.most_split && cell > push.scale * mean; cell *= 0.5) levels++;
  levels = n > push.crowd ? levels : 0u;
  leaf_splits[leaf] = levels;
  leaf_cells[leaf] = levels > 0u ? 1u << 3u * levels : 0u;
}
