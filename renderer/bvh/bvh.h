#pragma once
// The acceleration structure: input, layout for the device, and the interface that every tracer answers.
//
// Rays and hits are the wavefront's own structs (shaders/shared/ray.h), so that a host tracer can work in place on the
// mapped queue.
#include <memory>
#include <span>
#include <vector>

#include "base/math.h"
#include "shaders/shared/ray.h"

namespace lucerna::bvh {

/// World-space triangles, in primitive-id order. `non_opaque[i]` != 0: the triangle can let light pass straight through
/// (alpha, smooth thin wall) and shadow rays must look at it.
struct Triangles {
  std::span<const vec3> vertices;      ///< 3 a triangle, unindexed
  std::span<const uint8_t> non_opaque; ///< one a triangle
  size_t count() const { return vertices.size() / 3; }
};

/// What a query looks for.
enum class Query {
  closest,             ///< nearest hit over all triangles; at equal distance the lower primitive id
  any_opaque,          ///< is there an opaque triangle within (0, tmax)? hit.prim is k_no_hit or any blocker
  closest_non_opaque,  ///< nearest hit among the non-opaque triangles alone
};

/// Deepest path of a tree, in inner nodes; the traversal stack in shared memory holds as many entries.
inline constexpr uint32_t k_max_depth = 32;

}  // namespace lucerna::bvh
