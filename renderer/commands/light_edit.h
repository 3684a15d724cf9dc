#pragma once
// Converts a lamp's user-facing parameters to those of the scene: pure functions.
#include "base/math.h"
#include "scene/scene.h"

namespace lucerna::commands {

/// From where light comes. Azimuth as a compass seen from above: 0 from -Z, 90 from +X, clockwise; elevation
/// above the horizon. Degrees.
struct Bearing {
  float azimuth = 0, elevation = 0;
};
/// Bearing of light that travels along `direction` (unit); the azimuth of vertical light is 0.
Bearing bearing_of(const vec3& direction);
/// The direction, unit, in which light from there travels.
vec3 direction_from(const Bearing& bearing);

/// New place of a lamp that was at `from` when a drag began, after `pixels` (y down), in a picture
/// `picture_height` pixels high: it stays under the pointer, at constant depth. `upright`: it moves
/// vertically by the vertical part of the drag.
vec3 dragged(const scene::Camera& camera, const vec3& from, const vec2& pixels, float picture_height,
             bool upright);

}  // namespace lucerna::commands
