#pragma once
// Traces single rays against meshes and their instances, without flattening them: for interaction (picking,
// collisions), not for light.
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/math.h"

namespace lucerna::bvh {

class InstancedTracer {
 public:
  /// Triangles in the mesh's own space.
  struct Part {
    std::span<const vec3> positions;
    std::span<const uvec3> triangles;
  };
  using Mesh = std::vector<Part>;
  struct Instance {
    uint32_t mesh;
    mat4 to_world;
  };
  struct Hit {
    float distance;  ///< in lengths of the ray's direction
    vec3 normal;     ///< of the triangle in the world, unit, towards the ray's origin
    uint32_t instance, part, triangle;
    float u, v;  ///< barycentric coordinates of the second and third vertex
  };

  /// Copies what it needs. `threads`: for building. Throws Error: memory. An instance of a missing or empty
  /// mesh is never hit.
  InstancedTracer(const std::vector<Mesh>& meshes, const std::vector<Instance>& instances, int threads);
  /// Other instances of the same meshes, which are shared.
  InstancedTracer(const InstancedTracer& meshes, const std::vector<Instance>& instances);
  ~InstancedTracer();
  InstancedTracer(InstancedTracer&&) noexcept;
  InstancedTracer& operator=(InstancedTracer&&) noexcept;

  /// The nearest hit nearer than `limit` that `accepts` (its normal is not known to it); without one all are.
  /// Any thread.
  using Accepts = std::function<bool(const Hit&)>;
  std::optional<Hit> nearest(const vec3& origin, const vec3& direction, float limit,
                             const Accepts& accepts = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lucerna::bvh
