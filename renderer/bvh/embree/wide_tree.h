#pragma once
// The tree as the host tracer walks it: eight children a node, whose boxes one vector instruction meets, and
// leaves of up to eight triangles.
//
// Boxes are floats, those of the builder's tree (bvh/tree.h), and so hold the margin of their triangles'
// test. The faces of a box are met at (face - origin) * (1 / direction): the difference is rounded in
// proportion to itself, so that the error of the distance is in proportion to the distance, wherever scene
// and ray lie. WideRay allows for that.
#include <functional>
#include <vector>

#include "bvh/embree/packed_triangles.h"
#include "bvh/tree.h"

namespace lucerna::bvh {

struct alignas(64) WideNode {
  Floats face[6];           ///< [2 * axis + side] of every child, side 0: the lower
  uint32_t child[k_lanes];  ///< k_wide_leaf | index of a leaf, or index of a node
  uint32_t children = 0;    ///< the first so many are there; the boxes of others are empty
};
inline constexpr uint32_t k_wide_leaf = 1u << 31;

struct WideTree {
  std::vector<WideNode> nodes;  ///< nodes[0] is the root, children behind their parent; none: no triangle
  std::vector<PackedTriangles> leaves;
  uint32_t stack = 0;  ///< entries that a walk holds at most, where each node's children are all pushed
  uint64_t bytes() const {
    return nodes.capacity() * sizeof(WideNode) + leaves.capacity() * sizeof(PackedTriangles);
  }
};

/// Of the triangles that are wanted. Its leaves are chosen here: `tree` best has one reference a leaf, and
/// holds k_lanes in a leaf at most.
WideTree make_wide_tree(const Tree& tree, const Triangles& triangles,
                        const std::function<bool(uint32_t prim)>& wanted);

/// A ray as the boxes meet it. It runs along the line that the triangles' test follows, its largest component
/// of length 1.
struct WideRay {
  float origin[3];
  float near[3], far[3];  ///< 1 / direction, less and more by 32 roundings of 2^-24
  int entry[3];           ///< the face of each axis by which it enters; entry ^ 1 is the other

  explicit WideRay(const shared::Ray& ray, const ShearedRay& sheared) {
    // Eight roundings are those of the distances that are compared, three more the shear's; the walk's own
    // are four.
    constexpr float k_slack = 0x1p-19f;
    const vec3 direction = sheared.direction();
    for (int axis = 0; axis < 3; ++axis) {
      const float inverse = ShearedRay::inverse_of(direction[axis]);
      origin[axis] = ray.origin[axis];
      near[axis] = (1.0f - k_slack) * inverse, far[axis] = (1.0f + k_slack) * inverse;
      entry[axis] = 2 * axis + (inverse < 0 ? 1 : 0);
    }
  }
};

}  // namespace lucerna::bvh
