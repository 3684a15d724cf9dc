// Octree, splitting 2: counts the new references of every reference: for a split leaf, the cells that the sphere overlaps;
// the leaf's first reference also adds the mark of the split.
#include "lib/octree_cells.glsl"
layout(local_size_x = 64) in;
layout(scalar) writeonly buffer SplitReferences { uint split_references[]; };

void main() {
  uint i = global_index();
  if (i >= octree.references) return;
  uvec2 own = pair_of(texelFetch(octree_references, int(i >> 1)), i);
  uvec4 leaf = octree_slot(own.x);
  uint found = 1u;
  if (leaf.w > 0u)
    found = cell_count(sphere_cells(texelFetch(spheres, int(own.y)), own.y, own.x, octree_split_levels(leaf.w))) + (leaf.y == i ? 1u : 0u);
  split_references[i] = found;
}
