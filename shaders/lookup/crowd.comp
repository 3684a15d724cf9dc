// Octree, splitting 1: number of levels by which each leaf is split. A leaf with many spheres is split until its cells are
// at most as wide as the mean diameter of its spheres: where small spheres lie among large ones, the common leaf size is too
// large.
#include "lib/octree_leaves.glsl"
layout(local_size_x = 64) in;
layout(scalar) writeonly buffer LeafSplits { uint leaf_splits[]; };   // levels
layout(scalar) writeonly buffer LeafCells { uint leaf_cells[]; };     // cells of each split leaf; 0: not split
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
