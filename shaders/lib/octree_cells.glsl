// Which leaves a sphere overlaps. Included by the kernels that count and write references, which must agree.
//
// Conservative: for every x that a query finds within the sphere, the cell of x is visited. Let q(x) = x - origin in float,
// which is what octree_cell() scales (exactly, by a power of two) and floors. With u = 2^-24, |q(x) - (x - origin)| <=
// u * edge, likewise for the centre, and |x - c| <= r (1 + 4u) on every axis. So q(x) lies within safe_radius(r) + 2u *
// edge of q(c); the sums below err by a few more u * edge. A margin of 16u * edge covers all. The distance of a box
// from q(c) is held against the same sum.
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
  precise vec3 offset = s.xyz - octree.origin;
  vec3 centre = offset * octree.inverse_leaf;
  float radius = (safe_radius(s.w) + octree.edge * (16.0 / 16777216.0)) * octree.inverse_leaf;
  SphereCells c;
#if LUCERNA_OCTREE_SINGLE
  c.first = c.last = clamp(ivec3(floor(centre)), ivec3(0), ivec3(int(octree.cells) - 1));
#else
  c.first = clamp(ivec3(floor(centre - radius)), ivec3(0), ivec3(int(octree.cells) - 1));
  c.last = clamp(ivec3(floor(centre + radius)), ivec3(0), ivec3(int(octree.cells) - 1));
#endif
  c.centre = centre;
  c.square = radius * radius * (1.0 + 4.0 / 16777216.0);
  return c;
}

bool overlaps(SphereCells c, ivec3 cell) {
#if LUCERNA_OCTREE_SINGLE
  return true;
#else
  vec3 low = vec3(cell), d = max(max(low - c.centre, c.centre - (low + 1.0)), 0.0);
  return dot(d, d) <= c.square;
#endif
}

// The next cell of the box, x fastest.
ivec3 next_cell(SphereCells c, ivec3 cell) {
  cell.x++;
  if (cell.x > c.last.x) cell = ivec3(c.first.x, cell.y + 1, cell.z);
  if (cell.y > c.last.y) cell = ivec3(cell.x, c.first.y, cell.z + 1);
  return cell;
}
uint cell_count(SphereCells c) {
  uvec3 n = uvec3(c.last - c.first + 1);
  return n.x * n.y * n.z;
}
#endif
