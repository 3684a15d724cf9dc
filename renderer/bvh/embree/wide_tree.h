#pragma once
// The tree of the host tracer: eight children a node, whose boxes are tested by one vector instruction, and
// leaves of up to eight triangles.
//
// Boxes are the floats of the builder's tree (bvh/tree.h), and so include the margin of their triangles'
// test. The ray hits the faces of a box at (face - origin) * (1 / direction): rounding of the difference is
// proportional to the difference, so the error of the distance is proportional to the distance, wherever
// scene and ray are. WideRay includes that error.
#include <functional>
#include <vector>

#include "bvh/embree/packed_triangles.h"
#include "bvh/tree.h"

namespace lucerna::bvh {

struct alignas(64) WideNode {
  Floats face[6];           ///< [2 * axis + side] of every child, side 0: the lower
  uint32_t child[k_lanes];  ///< k_wide_leaf | index of a leaf, or index of a node
  uint32_t children = 0;    ///< number of children; the boxes of the others are empty
};
inline constexpr uint32_t k_wide_leaf = 1u << 31;

struct WideTree {
  std::vector<WideNode> nodes;  ///< nodes[0] is the root, children follow their parent; empty: no triangle
  std::vector<PackedTriangles> leaves;
  uint32_t stack = 0;  ///< maximum entries of a traversal that pushes all children of each node
  uint64_t bytes() const {
    return nodes.capacity() * sizeof(WideNode) + leaves.capacity() * sizeof(PackedTriangles);
  }
};

/// Tree of the `wanted` triangles. Leaves are formed here: `tree` should have one reference a leaf, and may
/// have at most k_lanes.
WideTree make_wide_tree(const Tree& tree, const Triangles& triangles,
                        const std::function<bool(uint32_t prim)>& wanted);

/// A ray for box tests, on the same line as in the triangle test, with largest component 1.
struct WideRay {
  float origin[3];
  float near[3], far[3];  ///< 1 / direction, less and more by 32 roundings of 2^-24
  int entry[3];           ///< the face of each axis by which it enters; entry ^ 1 is the other

  explicit WideRay(const shared::Ray& ray, const ShearedRay& sheared) {
    // Eight roundings are of the compared distances, three of the shear, and four of the traversal.
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
