#pragma once
// A binary tree over references to triangles, as builders make it: what comes before the layout for the
// device.
//
// A reference is a triangle's id with the box of that part of it that the leaf must answer for (smaller than
// the triangle's own box where a builder has split it), with the margin of the triangle's test around it. The
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
  std::vector<Node> nodes;  ///< children come after their parent; nodes[0] is the root; empty: no triangle
  std::vector<Reference> references;
};

/// How far beside a triangle, in metres along each axis, its test may accept a ray: 16 roundings of the
/// largest side of its box. The test (embree/packed_triangles.h) rounds the vertices' places as the ray sees
/// them by a few units in the last place of their distances from the ray's origin. What of that is in
/// proportion to the distance of the hit is, along every axis, a relative error of the distance at which the
/// ray meets the faces of a box, and traversals allow for it there; what is left is in proportion to the size
/// of the triangle alone, wherever it lies and however large the scene is. Along the ray the test's distance
/// may be wrong by far more; it is held to where the ray is within half this margin around the triangle.
float margin_of(const vec3* vertices);

/// `box` grown by `margin` on all sides, rounded outwards.
Box grown(const Box& box, float margin);

/// One reference for every triangle that can be hit: those of no area (equal or collinear vertices) are left
/// out, for they have no normal to shade with. Boxes are grown by margin_of() the triangle: a ray is within
/// its box where the test accepts it. Throws Error naming the first triangle with a vertex that is not
/// finite.
std::vector<Reference> references_of(const Triangles& triangles);

/// Levels of inner nodes that `count` references need at least: ceil(log2(ceil(count / k_max_leaf))).
uint32_t least_depth(uint32_t count);

/// A tree of least depth: split at the median of the widest axis of the boxes' centres. Needs no Embree; its
/// rays cost about twice as much as a surface-area heuristic's.
Tree build_median(std::vector<Reference> references);

/// For every node, the levels of inner nodes on the deepest path down from it; 0 for leaves.
std::vector<uint32_t> heights(const Tree& tree);

/// Levels of inner nodes on the deepest path.
uint32_t depth(const Tree& tree);

/// Returns the tree with no path deeper than `max_depth` inner nodes and no leaf of more than k_max_leaf
/// references. A node is kept as it is while both children can still be finished by median splits within the
/// levels that remain; otherwise its whole subtree is rebuilt by median splits. By induction the bound always
/// holds, whatever the builder did: it costs nothing for usual trees and bounds pathological ones. Needs
/// least_depth(all) <= max_depth.
Tree limit_depth(const Tree& tree, uint32_t max_depth);

}  // namespace lucerna::bvh
