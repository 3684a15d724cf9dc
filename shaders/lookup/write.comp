// Octree, step 6: the references themselves, each sphere's from its place on.
#include "lib/octree_cells.glsl"
layout(local_size_x = 64) in;
uniform usamplerBuffer sphere_places;   // prefix sum of the spheres' references
layout(scalar) writeonly buffer References { SortPair references[]; };

void main() {
  uint i = global_index();
  if (i >= sphere_count()) return;
  vec4 s = texelFetch(spheres, int(i));
  SphereCells c = sphere_cells(s);
  uint count = usable(s) ? cell_count(c) : 0u;
  uvec4 four = texelFetch(sphere_places, int(i >> 2));
  uvec2 two = (i & 2u) != 0u ? four.zw : four.xy;
  uint place = (i & 1u) != 0u ? two.y : two.x;
  ivec3 cell = c.first;
  for (uint k = 0u; k < count; ++k) {
    if (overlaps(c, cell) && place < push.capacity) {
      references[place] = SortPair(octree_code(uvec3(cell)), i);
      place++;
    }
    cell = next_cell(c, cell);
  }
}
