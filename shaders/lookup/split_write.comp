// Octree, splitting 3: these references, from the place on that those of each have.
#include "lib/octree_split.glsl"
layout(local_size_x = 64) in;
uniform usamplerBuffer split_places;   // prefix sum of what splitting 2 counted
layout(scalar) writeonly buffer References { SortPair references[]; };

void main() {
  uint i = global_index();
  if (i >= octree.references) return;
  uvec2 own = reference_pair(i);
  uvec4 leaf = octree_slot(own.x), four = texelFetch(split_places, int(i >> 2));
  uvec2 two = (i & 2u) != 0u ? four.zw : four.xy;
  uint place = (i & 1u) != 0u ? two.y : two.x;
  if (leaf.w == 0u) {
    references[place] = SortPair(own.x, own.y);
    return;
  }
  if (leaf.y == i) {
    references[place] = SortPair(own.x, k_octree_split | leaf.w);
    place++;
  }
  SphereCells c = sphere_cells(texelFetch(spheres, int(own.y)), own.y, own.x, leaf.w);
  uint rows = row_count(c);
  ivec2 row = c.first.yz, cells = row_cells(c, row);
  for (uint k = 0u; k < rows;) {
    if (cells.x <= cells.y) {
      references[place] = SortPair(octree_split_code(uvec3(cells.x, row), leaf.w), own.y);
      place++;
    }
    cells.x++;
    if (cells.x > cells.y) {
      k++;
      row = next_row(c, row);
      cells = row_cells(c, row);
    }
  }
}
