// Octree, step 5: the references of every sphere.
#include "lib/octree_cells.glsl"
layout(local_size_x = 64) in;
layout(scalar) writeonly buffer SphereReferences { uint sphere_references[]; };

void main() {
  uint i = global_index();
  if (i >= sphere_count()) return;
  vec4 s = texelFetch(spheres, int(i));
  SphereCells c = sphere_cells(s);
  uint count = usable(s) ? cell_count(c) : 0u, found = 0u;
  ivec3 cell = c.first;
  for (uint k = 0u; k < count; ++k) {
    found += overlaps(c, cell) ? 1u : 0u;
    cell = next_cell(c, cell);
  }
  sphere_references[i] = found;
}
