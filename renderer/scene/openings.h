#pragma once
// Finds the openings of rooms through which the sky shines, from rays in the rooms.
#include <span>
#include <vector>

#include "scene/scene.h"

namespace lucerna::scene {

/// A ray from a point of a room. `escapes`: it leaves the scene.
struct RoomRay {
  vec3 origin{0}, direction{0, 0, 1};  ///< unit
  bool escapes = false;
};

struct Opening {
  Portal portal;     ///< without a name
  double share = 0;  ///< of the escaping rays, those that pass through it and no earlier one
};

/// Rectangles in planes along walls with these outward unit normals, the most frequent first, that contain
/// many escaping rays and few others: an opening's own plane is where its rays are least spread. They are
/// slightly widened and light towards the rooms. At most k_max_portals, the largest share first, until they
/// contain 95 % of the escaping rays; none has less than a fifth of the largest share, and rays through one
/// come from several points. None if half of all rays escape: that is open air. Rays of one point are
/// consecutive.
std::vector<Opening> find_openings(std::span<const RoomRay> rays, std::span<const vec3> walls);

}  // namespace lucerna::scene
