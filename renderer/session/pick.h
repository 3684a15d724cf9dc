#pragma once
// Finds the surface at a point of the picture, or in the way of the camera, in the scene itself, without the
// renderer.
#include <functional>
#include <memory>
#include <optional>

#include "bvh/embree/instanced_tracer.h"
#include "scene/scene.h"

namespace lucerna::session {

struct Picked {
  uint32_t instance = 0;                 ///< index into Scene::instances
  uint32_t material = 0;                 ///< index into Scene::materials
  float distance = 0;                    ///< from the origin of the ray, metres
  vec3 position{0};                      ///< in the world, metres
  vec3 normal{0};                        ///< of the surface, unit, towards the eye
  uint32_t primitive = 0, triangle = 0;  ///< of the instance's mesh, and in the primitive
  vec2 barycentric{0};                   ///< weights of the triangle's second and third vertex
};

/// Texture coordinates there, of the first set; nullopt: the primitive has none.
std::optional<vec2> picked_uv(const scene::Scene& scene, const Picked& picked);

struct PickRay {
  vec3 origin, direction;  ///< unit
};
/// The ray through a point of the picture, from the section plane where that cuts the view; with direction 0
/// if it never passes the plane: `x` to the right and `y` down, 0..1; `aspect` its width / height.
PickRay pick_ray(const scene::Camera& camera, float x, float y, float aspect);

/// Tests one ray against all triangles: a few milliseconds for 300 000 triangles; for clicks. `x` to the
/// right and `y` down, 0..1 across the picture; `aspect` its width / height. Passes through surfaces with
/// alpha below the cutoff (masked) or 0.5 (blended); glass is a surface. nullopt if the ray leaves the scene.
std::optional<Picked> pick(const scene::Scene& scene, const scene::Camera& camera, float x, float y,
                           float aspect);

/// Likewise, for many rays, with a tree over the scene's meshes. Shares ownership of the scene.
class Probe {
 public:
  /// Takes about 0.3 s per million triangles. Throws Error: memory.
  explicit Probe(std::shared_ptr<const scene::Scene> scene);
  /// Faster, if both scenes share their meshes.
  Probe(std::shared_ptr<const scene::Scene> scene, const Probe& before);
  /// The first hit nearer than `limit` [m]; passes through surfaces for which `wanted` is false.
  std::optional<Picked> nearest(const vec3& origin, const vec3& direction, float limit = k_infinity,
                                const std::function<bool(const Picked&)>& wanted = {}) const;
  const scene::Scene& scene() const { return *scene_; }

 private:
  std::shared_ptr<const scene::Scene> scene_;
  bvh::InstancedTracer tracer_;
};

}  // namespace lucerna::session
