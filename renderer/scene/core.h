#pragma once
// The core of a scene: without a sky dome, a terrain or a wall on the horizon.
#include <optional>
#include <span>

#include "scene/scene.h"

namespace lucerna::scene {

/// The box of the triangles that lie together; nothing if all do. Triangles are sorted by the distance of
/// their farthest corner from the median of their centres. At least half of them belong to the core; it ends
/// where the next one reaches more than 16 times as far as the last. `positions`: three per triangle.
std::optional<Box> core_of(std::span<const vec3> positions);

/// The core of all shown instances, in world space; bounds() if all lie together.
Box core_bounds(const Scene& scene);

}  // namespace lucerna::scene
