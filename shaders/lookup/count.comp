// Octree, step 5: counts the references of every sphere.
#include "lib/octree_cells.glsl"
layout(local_size_x = 64) in;
layout(scalar) writeonly buffer SphereReferences { uint sphere_references[]; };

void main() {
  uint i = global_index();
  if (i >= sphere_count()) return;
  vec4 s = texelFetch(spheres, int(i));
  sphere_references[i] = usable(s) ? cell_count(sphere_cells(s, i)) : 0u;
}
