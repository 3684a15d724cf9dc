#pragma once
// What a person says of a lamp, in the numbers that a scene keeps: pure functions.
#include "base/math.h"
#include "scene/scene.h"

namespace lucerna::commands {

/// From where light comes. Azimuth as a compass seen from above: 0 from -Z, 90 from +X, clockwise; elevation
/// above the horizon. Degrees.
struct Bearing {
  float azimuth = 0, elevation = 0;
};
/// That of light which travels along `direction` (unit); an azimuth of 0 straight above and below.
Bearing bearing_of(const vec3& direction);
/// The direction, unit, in which light from there travels.
vec3 direction_from(const Bearing& bearing);

/// Where a lamp is that was at `from` when a drag began which has come by `pixels` (y down), in a picture
/// `picture_height` pixels high: it stays under the pointer, as far from the camera's plane as it was.
/// `upright`: it moves straight up or down, as far as the drag has gone that way.
vec3 dragged(const scene::Camera& camera, const vec3& from, const vec2& pixels, float picture_height,
             bool upright);

}  // namespace lucerna::commands
