// Octree, step 6: the references themselves, each sphere's from its place on.
#include "lib/octree_cells.glsl"
layout(local_size_x = 64) in;
uniform usamplerBuffer sphere_places;   // prefix sum of the spheres' references
layout(scalar) writeonly buffer References { SortPair references[]; };

void main() {
  uint i = global_index();
  if (i >= sphere_count()) return;
  vec4 s = texelFetch(spheres, int(i));
  SphereCells c = sphere_cells(s, i);
  uvec4 four = texelFetch(sphere_places, int(i >> 2));
  uvec2 two = (i & 2u) != 0u ? four.zw : four.xy;
  uint place = (i & 1u) != 0u ? two.y : two.x;
  uint rows = usable(s) ? row_count(c) : 0u;
  ivec2 row = c.first.yz, cells = row_cells(c, row);
  // One loop over the cells of all rows: in two, lanes would wait for the longest of every row.
  for (uint k = 0u; k < rows;) {
    if (cells.x <= cells.y && place < push.capacity) {
      references[place] = SortPair(octree_code(uvec3(cells.x, row)), i);
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
