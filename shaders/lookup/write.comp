// Octree, step 6: writes the references of every sphere.
#include "lib/octree_cells.glsl"
layout(local_size_x = 64) in;
uniform usamplerBuffer sphere_places;   // prefix sum of the spheres' reference counts
layout(scalar) writeonly buffer References { SortPair references[]; };

void main() {
  uint i = global_index();
  if (i >= sphere_count()) return;
  vec4 s = texelFetch(spheres, int(i));
  if (!usable(s)) return;
  uint place = word_of(texelFetch(sphere_places, int(i >> 2)), i);
  SphereCells c = sphere_cells(s, i);
  for (CellWalk w = first_cell(c); w.rows > 0u; next_cell(c, w)) {
    if (at_cell(w) && place < push.capacity) {
      references[place] = SortPair(octree_code(cell_of(w)), i);
      place++;
    }
  }
}
