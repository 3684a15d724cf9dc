// Octree, splitting 3: writes these references.
#include "lib/octree_cells.glsl"
layout(local_size_x = 64) in;
uniform usamplerBuffer split_places;   // prefix sum of the counts of splitting 2
layout(scalar) writeonly buffer References { SortPair references[]; };

void main() {
  uint i = global_index();
  if (i >= octree.references) return;
  uvec2 own = pair_of(texelFetch(octree_references, int(i >> 1)), i);
  uvec4 leaf = octree_slot(own.x);
  uint place = word_of(texelFetch(split_places, int(i >> 2)), i);
  if (leaf.w == 0u) {
    references[place] = SortPair(own.x, own.y);
    return;
  }
  if (leaf.y == i) {
    references[place] = SortPair(own.x, k_octree_split | leaf.w);
    place++;
  }
  SphereCells c = sphere_cells(texelFetch(spheres, int(own.y)), own.y, own.x, octree_split_levels(leaf.w));
  for (CellWalk w = first_cell(c); w.rows > 0u; next_cell(c, w)) {
    if (at_cell(w)) {
      references[place] = SortPair(octree_split_code(cell_of(w), leaf.w), own.y);
      place++;
    }
  }
}
