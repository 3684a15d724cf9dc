// Octree, splitting 2: the references that come of every reference: of a leaf that is split those of its cells that the
// sphere overlaps, and with the leaf's first one that says so.
#include "lib/octree_split.glsl"
layout(local_size_x = 64) in;
layout(scalar) writeonly buffer SplitReferences { uint split_references[]; };

void main() {
  uint i = global_index();
  if (i >= octree.references) return;
  uvec2 own = reference_pair(i);
  uvec4 leaf = octree_slot(own.x);
  uint found = 1u;
  if (leaf.w > 0u) {
    SphereCells c = sphere_cells(texelFetch(spheres, int(own.y)), own.y, own.x, leaf.w);
    uint rows = row_count(c);
    ivec2 row = c.first.yz;
    found = leaf.y == i ? 1u : 0u;
    for (uint k = 0u; k < rows; ++k) {
      ivec2 cells = row_cells(c, row);
      found += uint(max(cells.y - cells.x + 1, 0));
      row = next_row(c, row);
    }
  }
  split_references[i] = found;
}
