#pragma once
// What lies under a point of the picture, found in the plain scene without asking the renderer: one ray
// against all triangles. A few milliseconds for a scene of 300 000 triangles; meant for clicks.
#include <optional>

#include "scene/scene.h"

namespace lucerna::session {

struct Picked {
  uint32_t instance = 0;  ///< index into Scene::instances
  uint32_t material = 0;  ///< index into Scene::materials
  float distance = 0;     ///< from the eye (orthographic: from the camera's plane), metres
  vec3 position{0};       ///< in the world, metres
};

/// `x` to the right and `y` down, 0..1 across the picture; `aspect` its width / height. Surfaces are passed
/// through where their alpha is below the cutoff (masked) or a half (blended); glass is a surface. Nothing
/// when the ray leaves the scene.
std::optional<Picked> pick(const scene::Scene& scene, const scene::Camera& camera, float x, float y,
                           float aspect);

}  // namespace lucerna::session
