// Which leaves a sphere overlaps. Included by the kernels that count and write references, which must agree to the bit:
// hence `precise`.
//
// Conservative: for every x that a query finds within the sphere, the cell of x is visited. Let q(x) = x - origin in float,
// which is what octree_cell() scales (exactly, by a power of two) and floors. With u = 2^-24, |q(x) - (x - origin)| <=
// u * edge, likewise for the centre, and |x - c| <= r (1 + 4u). So q(x) lies within safe_radius(r) + 2u * edge of q(c), on
// every axis and in the distance. The differences below err by another u * edge each, the root by 4u of its value. A
// margin of 32u * edge covers all.
#ifndef LUCERNA_LIB_OCTREE_CELLS
#define LUCERNA_LIB_OCTREE_CELLS
#include "lib/octree_build.glsl"
#include "lib/octree.glsl"

struct SphereCells {
  ivec3 first, last;   // box of cells, both included
  vec3 centre;         // in leaves from the origin
  float square;        // of the radius, enlarged, in leaves
};

SphereCells sphere_cells(vec4 s) {
  precise vec3 offset = s.xyz - octree.origin, centre = offset * octree.inverse_leaf;
  precise float enlarged = safe_radius(s.w) + octree.edge * (32.0 / 16777216.0), radius = enlarged * octree.inverse_leaf;
  precise float square = radius * radius;
#if LUCERNA_OCTREE_SINGLE
  precise vec3 low = centre, high = centre;
#else
  precise vec3 low = centre - radius, high = centre + radius;
#endif
  ivec3 most = ivec3(int(octree.cells) - 1);
  return SphereCells(clamp(ivec3(floor(low)), ivec3(0), most), clamp(ivec3(floor(high)), ivec3(0), most), centre, square);
}

// Rows of the box along x.
uint row_count(SphereCells c) {
  uvec2 n = uvec2(c.last.yz - c.first.yz + 1);
  return n.x * n.y;
}
// (y, z) of the next row.
ivec2 next_row(SphereCells c, ivec2 row) {
  bool over = row.x == c.last.y;
  return ivec2(over ? c.first.y : row.x + 1, over ? row.y + 1 : row.y);
}
// First and last cell of a row that the sphere overlaps; none where the first is beyond the last.
ivec2 row_cells(SphereCells c, ivec2 row) {
#if LUCERNA_OCTREE_SINGLE
  return c.first.xx;
#else
  precise vec2 low = vec2(row) - c.centre.yz, high = c.centre.yz - vec2(row + 1);
  precise vec2 d = max(max(low, high), 0.0), dd = d * d;
  precise float left = c.square - dd.x, rest = left - dd.y, half_chord = sqrt(max(rest, 0.0));
  precise float from = c.centre.x - half_chord, to = c.centre.x + half_chord;
  return rest < 0.0 ? ivec2(1, 0) : ivec2(max(c.first.x, int(floor(from))), min(c.last.x, int(floor(to))));
#endif
}
#endif
