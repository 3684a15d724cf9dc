#pragma once
// A binary tree over references to triangles: the result of builders, and input of the layout for the device.
//
// A reference is a triangle's id with the box of the part of it in that leaf (smaller than the triangle's own
// box if a builder has split it), including the margin of the triangle's test. The
// references under a node, inner or leaf, are contiguous.
#include <vector>

#include "bvh/bvh.h"

namespace lucerna::bvh {

struct Reference {
  Box box;
  uint32_t prim = 0;
};

struct Tree {
  static constexpr uint32_t k_leaf = ~0u;
  struct Node {
    Box box;
    uint32_t child[2] = {k_leaf, k_leaf};  ///< indices into nodes; both k_leaf in a leaf
    uint32_t first = 0, count = 0;         ///< the references below
    bool leaf() const { return child[0] == k_leaf; }
  };
  std::vector<Node> nodes;  ///< children follow their parent; nodes[0] is the root; empty: no triangle
  std::vector<Reference> references;
};

/// Maximum distance beside a triangle, in metres along each axis, at which its test may accept a ray: 16
/// roundings of the largest side of its box. The test (embree/packed_triangles.h) rounds the vertices'
/// positions relative to the ray by a few units in the last place of their distances from the ray's origin.
/// The part proportional to the distance of the hit is, along every axis, a relative error of the distance at
/// which the ray hits the faces of a box, and traversals include it there; the rest is proportional to the
/// size of the triangle, independent of its position and of the scene's size. Along the ray the test's
/// distance may have a far larger error; it is clamped to the part of the ray within half this margin around
/// the triangle.
float margin_of(const vec3* vertices);

/// `box` grown by `margin` on all sides, rounded outwards.
Box grown(const Box& box, float margin);

/// One reference for every triangle that can be hit; those without area (equal or collinear vertices) are
/// omitted, because they have no normal. Boxes are enlarged by margin_of() the triangle, so that every
/// accepted hit is inside. Throws Error naming the first triangle with a vertex that is not finite.
std::vector<Reference> references_of(const Triangles& triangles);

/// Minimum levels of inner nodes for `count` references: ceil(log2(ceil(count / k_max_leaf))).
uint32_t least_depth(uint32_t count);

/// A tree of minimum depth: split at the median of the widest axis of the boxes' centres. Needs no Embree;
/// its rays cost about twice as much as with the surface area heuristic.
Tree build_median(std::vector<Reference> references);

/// For every node, the levels of inner nodes on the deepest path down from it; 0 for leaves.
std::vector<uint32_t> heights(const Tree& tree);

/// Levels of inner nodes on the deepest path.
uint32_t depth(const Tree& tree);

/// Returns the tree with no path deeper than `max_depth` inner nodes and no leaf of more than k_max_leaf
/// references. A node is unchanged if both children can still be completed by median splits within the
/// remaining levels; otherwise its whole subtree is rebuilt by median splits. By induction the bound always
/// holds, for any builder: usual trees are unchanged, and pathological ones bounded. Requires
/// least_depth(all) <= max_depth.
Tree limit_depth(const Tree& tree, uint32_t max_depth);

}  // namespace lucerna::bvh
