#pragma once
// The acceleration structure: input, layout for the device, and the interface of all tracers.
//
// Rays and hits are the wavefront's own structs (shaders/shared/ray.h), so that a host tracer can work in
// place on the mapped queue.
#include <memory>
#include <span>
#include <vector>

#include "base/math.h"
#include "shaders/shared/ray.h"

namespace lucerna::bvh {

/// World-space triangles, in primitive-id order. `non_opaque[i]` != 0: the triangle can transmit light
/// undeflected (alpha, smooth thin wall) and shadow rays must shade it. An empty `non_opaque`: all are
/// opaque. Vertices must be finite; degenerate triangles are allowed and never hit.
struct Triangles {
  std::span<const vec3> vertices;       ///< 3 a triangle, unindexed
  std::span<const uint8_t> non_opaque;  ///< one a triangle, or empty
  size_t count() const { return vertices.size() / 3; }
  bool opaque(size_t prim) const { return non_opaque.empty() || non_opaque[prim] == 0; }
};

/// Kind of query. The numbers are the LUCERNA_QUERY of shaders/trace.comp.
enum class Query {
  closest = 0,             ///< nearest hit over all triangles; at equal distance the lower primitive id
  any_opaque = 1,          ///< any opaque triangle within (0, tmax): hit.prim is k_no_hit if there is none,
                           ///< otherwise another value (not every tracer determines the triangle)
  closest_non_opaque = 2,  ///< nearest hit among non-opaque triangles only; ties as for closest
};

/// Maximum depth of a binary tree, in inner nodes.
inline constexpr uint32_t k_max_depth = 32;
/// Entries of the device's traversal stack: three for each pair of levels of the binary tree.
inline constexpr uint32_t k_stack = k_max_depth / 2 * 3;
/// Maximum triangles in a leaf.
inline constexpr uint32_t k_max_leaf = 4;

}  // namespace lucerna::bvh
