#pragma once
// What of a scene belongs together: without a sky dome, a terrain or a wall on the horizon.
#include <optional>
#include <span>

#include "scene/scene.h"

namespace lucerna::scene {

/// The box of those triangles that lie together; nothing: all do. Triangles are taken by the distance of
/// their farthest corner from the median of their centres, half of them at least, and on until the next one
/// reaches more than 16 times as far as the last: that one and all others stand far away, or are far larger.
/// `positions`: three a triangle.
std::optional<Box> core_of(std::span<const vec3> positions);

/// The same of all instances, in world space; where all lie together, bounds().
Box core_bounds(const Scene& scene);

}  // namespace lucerna::scene
