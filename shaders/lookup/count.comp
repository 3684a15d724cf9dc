// Octree, step 5: the references of every sphere.
#include "lib/octree_cells.glsl"
layout(local_size_x = 64) in;
layout(scalar) writeonly buffer SphereReferences { uint sphere_references[]; };

void main() {
  uint i = global_index();
  if (i >= sphere_count()) return;
  vec4 s = texelFetch(spheres, int(i));
  SphereCells c = sphere_cells(s, i);
  uint rows = usable(s) ? row_count(c) : 0u, found = 0u;
  ivec2 row = c.first.yz;
  for (uint k = 0u; k < rows; ++k) {
    ivec2 cells = row_cells(c, row);
    found += uint(max(cells.y - cells.x + 1, 0));
    row = next_row(c, row);
  }
  sphere_references[i] = found;
}
