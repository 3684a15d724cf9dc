// The octree of spheres: what its kernels and its queries share. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_OCTREE_H
#define LUCERNA_SHARED_OCTREE_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_octree_levels = 10u;            ///< the finest: 1024 leaves along the root's edge, codes of 30 bits
LUCERNA_CONST uint k_octree_no_leaf = 0xffffffffu;   ///< no code, no index
LUCERNA_CONST uint k_octree_split = 0x80000000u;     ///< for a sphere: the leaf is split, as the bits below say
LUCERNA_CONST uint k_octree_split_levels = 7u;       ///< of these: by so many levels; the others: its cells' first code
LUCERNA_CONST uint k_octree_most_split = 4u;         ///< levels; leaves may so come to be finer than k_octree_levels
LUCERNA_CONST uint k_octree_hash = 0x9e3779b1u;      ///< a code's hash is the upper bits of its product with this

/// The result of a build. Lengths in metres, in world space.
struct OctreeHeader {
  vec3 origin;          ///< lower corner of the root
  float leaf;           ///< edge of a leaf: a power of two, so that scaling by it is exact
  float inverse_leaf;   ///< 1 / leaf
  float edge;           ///< of the root, leaf * cells
  float mean_diameter;  ///< of the spheres, of those about the core where there is one
  uint level;           ///< of the leaves, 0..k_octree_levels
  uint wanted_level;    ///< what the spheres' mean size called for; `level` is less where memory does not suffice
  uint cells;           ///< leaves along the root's edge, 1 << level; 0: no sphere, every query is empty
  uint spheres;         ///< that are in it: radius >= 0, all finite
  uint references;      ///< that were written
  uint needed;          ///< references that `wanted_level` takes at most (2^32 - 1: or more)
  uint capacity;        ///< references that there is memory for
  uint leaves;          ///< that are not empty
  uint slots;           ///< of the hash table in use: a power of two, more than `leaves`
  uint slot_shift;      ///< a code's hash is shifted right by this
  uint split;           ///< levels by which leaves are split at most
  uint split_references;///< that are written with those of split leaves, and one for each of these
  uint split_cells;     ///< that all split leaves have together
  uint open;            ///< 1: spheres lie beyond the root, and its outermost cells hold whatever lies beyond them
  uint overflow;        ///< references that not even a single leaf could hold: that many are missing
};

struct OctreePush {
  uint count;           ///< spheres, or the most that there may be
  uint count_at;        ///< word of SphereCount that holds their number; k_sort_count_here: `count` does
  uint capacity;        ///< references
  uint slot_capacity;   ///< slots of the hash table, a power of two
  uint level_capacity;  ///< references of unsplit leaves, unless there is but one leaf
  uint most_split;      ///< levels by which crowded leaves are split at most
  uint crowd;           ///< spheres that a leaf lists before it is split
  float scale;          ///< leaves are no larger than this times the mean diameter
  uint normal_stride;   ///< of discs: sphere i's normal is texel normal_stride * i + normal_at of disc_normals
  uint normal_at;
  float thickness;      ///< of discs: half of the slab's, of the radius
  vec3 core_low;        ///< box that the root is held to; low > high: it holds all spheres
  vec3 core_high;
};

LUCERNA_SHARED_END
#endif
