// Leaves that a sphere overlaps. Included by the kernels that count and write references, which must agree bit by bit:
// hence `precise`.
//
// Conservative: for every x that a query finds within the sphere, the cell of x is visited. Let q(x) = x - origin in float,
// which is what octree_cell() scales (exactly, by a power of two) and floors. With u = 2^-24, |q(x) - (x - origin)| <=
// u * edge, likewise for the centre, and |x - c| <= r (1 + 4u). So q(x) lies within safe_radius(r) + 2u * edge of q(c), on
// every axis and in the distance. The differences below err by another u * edge each, the root by 4u of its value. A
// margin of 32u * edge covers all. For centres beyond an open root their distance from its origin replaces the edge.
//
// The outermost cells of an open root have no outer faces: there, the position within a row's square or a cell is unknown,
// except that it is within the sphere's box.
//
// LUCERNA_OCTREE_DISCS: 1: spheres are looked up only near the plane through their centre, within `disc_thickness` of their
// radius on either side; only cells that this slab intersects are visited, a part of each row.
#ifndef LUCERNA_LIB_OCTREE_CELLS
#define LUCERNA_LIB_OCTREE_CELLS
#include "lib/variants.glsl"
#include "lib/octree_build.glsl"
#include "lib/octree.glsl"

#if LUCERNA_OCTREE_DISCS
uniform samplerBuffer disc_normals;
// A hundredth of a leaf exceeds the rounding errors of coordinates in leaves from the centre by far.
const float k_slab_margin = 0.01;
// Below this, a row is parallel to the slab.
const float k_steep = 0.05;
#endif

struct SphereCells {
  ivec3 first, last;   // box of cells, both included
  int most;            // the last cell of the root along each axis
  vec3 centre;         // in leaves from the origin
  float square;        // of the radius, enlarged, in leaves
#if LUCERNA_OCTREE_DISCS
  vec3 normal;         // unit
  float half_;         // of the slab's thickness, enlarged, in leaves
#endif
};

// Cells from `lowest` to `highest`, both included, on a grid `split` levels finer than the leaves; lengths are in such
// cells.
SphereCells sphere_cells(vec4 s, uint index, uint split, ivec3 lowest, ivec3 highest) {
  uint cells = octree.cells << split;
  float inverse_leaf = ldexp(octree.inverse_leaf, int(split));
  precise vec3 offset = s.xyz - octree.origin, centre = offset * inverse_leaf;
  vec3 away = abs(offset);
  float edge = octree.open != 0u ? max(octree.edge, max(max(away.x, away.y), away.z)) : octree.edge;
  precise float enlarged = safe_radius(s.w) + edge * (32.0 / 16777216.0), radius = enlarged * inverse_leaf;
  precise float square = radius * radius;
#if LUCERNA_OCTREE_SINGLE
  precise vec3 low = centre, high = centre;
#else
  precise vec3 low = centre - radius, high = centre + radius;
#endif
  SphereCells c;
  c.first = clamp(ivec3(octree_held(floor(low), cells)), lowest, highest);
  c.last = clamp(ivec3(octree_held(floor(high), cells)), lowest, highest);
  c.most = int(cells) - 1;
  c.centre = centre;
  c.square = square;
#if LUCERNA_OCTREE_DISCS
  c.normal = texelFetch(disc_normals, int(push.normal_stride * index + push.normal_at)).xyz;
  // Outside an open root, rounding errors of positions are larger.
  c.half_ = push.thickness * radius + k_slab_margin + (octree.open != 0u ? edge * inverse_leaf * (32.0 / 16777216.0) : 0.0);
#endif
  return c;
}
SphereCells sphere_cells(vec4 s, uint index) {
  return sphere_cells(s, index, 0u, ivec3(0), ivec3(int(octree.cells) - 1));
}
// The cells of a leaf that is split by `levels`.
SphereCells sphere_cells(vec4 s, uint index, uint code, uint levels) {
  ivec3 low = ivec3(octree_decode(code) << levels);
  return sphere_cells(s, index, levels, low, low + int(1u << levels) - 1);
}

bool outermost(ivec2 cell, int most) {
  return octree.open != 0u && (any(equal(cell, ivec2(0))) || any(equal(cell, ivec2(most))));
}

// Maximum number of cells of 2^k leaves width that a sphere overlaps.
uint most_cells(SphereCells c, uint k) {
  uvec3 n = uvec3((c.last >> k) - (c.first >> k) + 1);
#if LUCERNA_OCTREE_DISCS
  if (octree.open != 0u && (any(equal(c.first, ivec3(0))) || any(equal(c.last, ivec3(c.most))))) return n.x * n.y * n.z;
  // The slab, along the axis that it crosses most steeply, in every column of the two others.
  vec3 a = abs(c.normal);
  float most = max(max(a.x, a.y), a.z);
  uint across = uint(min((ldexp(2.0 * c.half_, -int(k)) + a.x + a.y + a.z - most) / most, 65536.0)) + 2u;
  if (a.x == most) n.x = min(n.x, across);
  else if (a.y == most) n.y = min(n.y, across);
  else n.z = min(n.z, across);
#endif
  return n.x * n.y * n.z;
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
// First and last cell of a row that the sphere overlaps; none if first > last.
ivec2 row_cells(SphereCells c, ivec2 row) {
#if LUCERNA_OCTREE_SINGLE
  return c.first.xx;
#else
  precise vec2 low = vec2(row) - c.centre.yz, high = c.centre.yz - vec2(row + 1);
  if (octree.open != 0u) {
    low = mix(low, vec2(0.0), equal(row, ivec2(0)));
    high = mix(high, vec2(0.0), equal(row, ivec2(c.most)));
  }
  precise vec2 d = max(max(low, high), 0.0), dd = d * d;
  precise float left = c.square - dd.x, rest = left - dd.y, half_chord = sqrt(max(rest, 0.0));
  precise float from = c.centre.x - half_chord, to = c.centre.x + half_chord;
#if LUCERNA_OCTREE_DISCS
  // The slab: |n.x x + v| <= half, where v covers the range of the other axes in the row's square.
  precise vec2 middle = vec2(row) + 0.5 - c.centre.yz, parts = c.normal.yz * middle, spreads = abs(c.normal.yz);
  precise float v = parts.x + parts.y, slack = c.half_ + 0.5 * (spreads.x + spreads.y);
  if (outermost(row, c.most)) {
    // The row's square is unbounded.
  } else if (abs(c.normal.x) >= k_steep) {
    precise float one = (-slack - v) / c.normal.x, other = (slack - v) / c.normal.x;
    from = max(from, c.centre.x + min(one, other));
    to = min(to, c.centre.x + max(one, other));
  } else if (abs(v) > slack + abs(c.normal.x) * half_chord) {
    rest = -1.0;
  }
#endif
  if (rest < 0.0 || to < from) return ivec2(1, 0);
  vec2 ends = floor(vec2(from, to));
  if (octree.open != 0u) ends = clamp(ends, 0.0, float(c.most));
  return ivec2(max(c.first.x, int(ends.x)), min(c.last.x, int(ends.y)));
#endif
}

// Number of cells that a sphere overlaps.
uint cell_count(SphereCells c) {
  uint rows = row_count(c), found = 0u;
  ivec2 row = c.first.yz;
  for (uint k = 0u; k < rows; ++k) {
    ivec2 cells = row_cells(c, row);
    found += uint(max(cells.y - cells.x + 1, 0));
    row = next_row(c, row);
  }
  return found;
}

// Iterates over the cells of all rows: with a loop per row, lanes would wait for the longest row each time.
struct CellWalk {
  uint rows;          // remaining rows, including this one
  ivec2 row, cells;   // (y, z); this cell and the row's last, none if first > last
};
CellWalk first_cell(SphereCells c) { return CellWalk(row_count(c), c.first.yz, row_cells(c, c.first.yz)); }
bool at_cell(CellWalk w) { return w.cells.x <= w.cells.y; }
uvec3 cell_of(CellWalk w) { return uvec3(w.cells.x, w.row); }
void next_cell(SphereCells c, inout CellWalk w) {
  w.cells.x++;
  if (w.cells.x > w.cells.y) {
    w.rows--;
    w.row = next_row(c, w.row);
    w.cells = row_cells(c, w.row);
  }
}
#endif
