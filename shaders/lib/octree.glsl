// Spheres that may contain a point: one lookup, then one loop.
//
//   OctreeRange range = octree_find(x);
//   for (uint i = range.first; i < range.last; ++i) {
//     uint sphere = octree_sphere(i);
//     ...                                             // test the distance here
//   }
//
// A texel holds two references, so that two a step are faster:
//
//   for (uint i = range.first & ~1u; i < range.last; i += 2u) {
//     uvec2 two = octree_two_spheres(i);               // two.x if i >= range.first, two.y if i + 1 < range.last
//
// If the octree was built with copies, octree_copy(i) is the sphere itself, (centre, radius): twice as fast as fetching it
// by its index, because copies are stored in the order of reading.
//
// On lavapipe all loops of an invocation together end, silently, after 65535 iterations.
//
// Contract: every sphere (c, r) with dot(x - c, x - c) <= r * r, in float as written here or exactly, is in the range,
// once; others may be. The order is that of the spheres' indices. Points outside a root that is not open have an empty
// range. A leaf that is split has one reference of its own, to no sphere: it is in no range, but may share a texel with the
// end of one.
//
// The host binds these by Octree::bind().
#ifndef LUCERNA_LIB_OCTREE
#define LUCERNA_LIB_OCTREE
#include "shaders/shared/octree.h"

layout(scalar) readonly buffer OctreeHeaders { OctreeHeader octree; };
uniform usamplerBuffer octree_slots;        // code, first, last, kind of split (then without references); 0: not split
uniform usamplerBuffer octree_references;   // (code, sphere) pairs, two a texel
uniform samplerBuffer octree_copies;        // centre, radius; in the order of the references

struct OctreeRange { uint first, last; };

// Moves the lowest ten bits to every third position.
uint octree_spread(uint x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}
// The inverse of octree_spread().
uint octree_compact(uint x) {
  x &= 0x09249249u;
  x = (x | x >> 2) & 0x030c30c3u;
  x = (x | x >> 4) & 0x0300f00fu;
  x = (x | x >> 8) & 0x030000ffu;
  return (x | x >> 16) & 0x3ffu;
}
uvec3 octree_decode(uint code) {
  return uvec3(octree_compact(code), octree_compact(code >> 1), octree_compact(code >> 2));
}
uint octree_code(uvec3 cell) {
  return octree_spread(cell.x) | octree_spread(cell.y) << 1 | octree_spread(cell.z) << 2;
}
// Split leaf: the levels, and the first code of its cells, a multiple of 8; without k_octree_split.
uint octree_split_levels(uint split) { return split & k_octree_split_levels; }
uint octree_split_first(uint split) { return split & ~(k_octree_split | k_octree_split_levels); }
// Code of a cell in a split leaf: above those of all whole leaves, and counted within the leaf, so that the bits of a
// code do not limit the number of levels.
uint octree_split_code(uvec3 cell, uint split) {
  uvec3 within = cell & ((1u << octree_split_levels(split)) - 1u);
  return (1u << 3u * octree.level) + octree_split_first(split) + octree_code(within);
}

// Slot of a leaf: code, first reference, end of its references, kind of split.
uvec4 octree_slot(uint code) {
  uint slot = (code * k_octree_hash) >> octree.slot_shift;
  uvec4 found = texelFetch(octree_slots, int(slot));
  // Terminates at a free slot, because the table has more slots than leaves.
  while (found.x != code && found.x != k_octree_no_leaf) {
    slot = (slot + 1u) & (octree.slots - 1u);
    found = texelFetch(octree_slots, int(slot));
  }
  return found;
}
// The references of a leaf that is not split.
OctreeRange octree_leaf(uint code) {
  uvec4 found = octree_slot(code);
  return OctreeRange(found.y, found.z);
}

// The outermost of `cells` along every axis hold what lies beyond an open root.
vec3 octree_held(vec3 cell, uint cells) {
  return octree.open != 0u ? clamp(cell, vec3(0.0), vec3(float(cells) - 1.0)) : cell;
}
// Cell of a point along every axis; monotone in x, so that a point between two others lies in a cell between theirs.
// Outside a root that is not open it is negative or at least octree.cells.
vec3 octree_cell(vec3 x) {
  precise vec3 offset = x - octree.origin;
  return octree_held(floor(offset * octree.inverse_leaf), octree.cells);
}
// ... of leaves `split` levels finer, of which 2^split lie in each of those.
vec3 octree_cell(vec3 x, uint split) {
  precise vec3 offset = x - octree.origin;
  return octree_held(floor(offset * ldexp(octree.inverse_leaf, int(split))), octree.cells << split);
}

OctreeRange octree_find(vec3 x) {
  vec3 cell = octree_cell(x);
  bool inside = all(greaterThanEqual(cell, vec3(0.0))) && all(lessThan(cell, vec3(float(octree.cells))));
  uvec4 found = octree_slot(octree_code(uvec3(inside ? cell : vec3(0.0))));
  if (inside && found.w > 0u)
    found = octree_slot(octree_split_code(uvec3(octree_cell(x, octree_split_levels(found.w))), found.w));
  return OctreeRange(found.y, inside ? found.z : found.y);
}

uvec2 octree_two_spheres(uint even_reference) { return texelFetch(octree_references, int(even_reference >> 1)).yw; }
vec4 octree_copy(uint reference) { return texelFetch(octree_copies, int(reference)); }
uint octree_sphere(uint reference) {
  uvec4 two = texelFetch(octree_references, int(reference >> 1));
  return (reference & 1u) != 0u ? two.w : two.y;
}
#endif
