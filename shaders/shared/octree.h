// The octree of spheres: data of its kernels and its queries. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_OCTREE_H
#define LUCERNA_SHARED_OCTREE_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_octree_levels = 10u;            ///< the finest: 1024 leaves along the root's edge, codes of 30 bits
LUCERNA_CONST uint k_octree_no_leaf = 0xffffffffu;   ///< no code, no index
LUCERNA_CONST uint k_octree_split = 0x80000000u;     ///< sphere index: the leaf is split, details in the bits below
LUCERNA_CONST uint k_octree_split_levels = 7u;       ///< of these: levels of the split; the others: first code of its cells
LUCERNA_CONST uint k_octree_most_split = 4u;         ///< maximum levels of a split; leaves may be finer than k_octree_levels
LUCERNA_CONST uint k_octree_hash = 0x9e3779b1u;      ///< a code's hash is the upper bits of its product with this

/// The result of a build. Lengths in metres, in world space.
struct OctreeHeader {
  vec3 origin;          ///< lower corner of the root
  float leaf;           ///< edge of a leaf: a power of two, so that scaling by it is exact
  float inverse_leaf;   ///< 1 / leaf
  float edge;           ///< of the root, leaf * cells
  float mean_diameter;  ///< of the spheres; with a core, of those around it
  uint level;           ///< of the leaves, 0..k_octree_levels
  uint wanted_level;    ///< level for the spheres' mean size; `level` is lower if memory is short
  uint cells;           ///< leaves along the root's edge, 1 << level; 0: no sphere, every query is empty
  uint spheres;         ///< number of spheres in the tree: radius >= 0, all finite
  uint references;      ///< number of references written
  uint needed;          ///< maximum number of references for `wanted_level`; 2^32 - 1: or more
  uint capacity;        ///< number of references that fit into memory
  uint leaves;          ///< number of leaves that are not empty
  uint slots;           ///< used size of the hash table: a power of two above `leaves`
  uint slot_shift;      ///< right shift of a code's hash
  uint split;           ///< maximum levels by which leaves are split
  uint split_references;///< references including those of split leaves, and one for each split leaf
  uint split_cells;     ///< cells of all split leaves
  uint open;            ///< 1: spheres lie outside the root; its outermost cells hold them
  uint overflow;        ///< references missing because not even a single leaf could hold them
};

struct OctreePush {
  uint count;           ///< number of spheres, or its maximum
  uint count_at;        ///< word of SphereCount with their number; k_sort_count_here: it is `count`
  uint capacity;        ///< memory for references
  uint slot_capacity;   ///< slots of the hash table, a power of two
  uint level_capacity;  ///< maximum references of unsplit leaves, unless there is only one leaf
  uint most_split;      ///< maximum levels by which crowded leaves are split
  uint crowd;           ///< maximum spheres in a leaf before it is split
  float scale;          ///< maximum leaf edge over the mean diameter
  uint normal_stride;   ///< of discs: sphere i's normal is texel normal_stride * i + normal_at of disc_normals
  uint normal_at;
  float thickness;      ///< of discs: half of the slab's thickness over the radius
  vec3 core_low;        ///< box that limits the root; low > high: no limit, it holds all spheres
  vec3 core_high;
};

LUCERNA_SHARED_END
#endif
