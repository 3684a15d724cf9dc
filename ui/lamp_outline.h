#pragma once
// Outline of a lamp in the scene, and its size by a handle on it: pure functions.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace lucerna::ui {

/// Lines of a lamp's shape, of a spot's cones, or of the web of a measured distribution in two planes.
/// `reach`: length of a cone, and of the web's largest intensity [m]. None for a point or a sun.
std::vector<std::vector<vec3>> lamp_outline(const scene::Light& light, float reach);

/// Where the handle for its size lies: a rectangle's corner, the rim of a disk or sphere, a tube's end, the
/// rim of a spot's cone at `reach`. `eye`: of the view.
std::optional<vec3> size_handle(const scene::Light& light, float reach, const vec3& eye);

/// Parameters of light.set that put that handle where a ray (direction unit) passes it; empty if it passes no
/// such place.
std::vector<std::pair<std::string, float>> size_by_ray(const scene::Light& light, const vec3& eye,
                                                       const vec3& origin, const vec3& direction);

}  // namespace lucerna::ui
