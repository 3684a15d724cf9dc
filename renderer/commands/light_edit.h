#pragma once
// What a person says of a lamp, in the numbers that a scene keeps: pure functions.
#include <string>

#include "scene/scene.h"

namespace lucerna::commands {

/// Steradians that a point or spot lamp shines through, a spot's fading between its cones counted in: its
/// radiant power over its intensity. 0 for a sun.
float solid_angle(const scene::Light& lamp);

/// From where light comes. Azimuth as a compass seen from above: 0 from -Z, 90 from +X, clockwise; elevation
/// above the horizon. Degrees.
struct Bearing {
  float azimuth = 0, elevation = 0;
};
/// That of light which travels along `direction` (unit); an azimuth of 0 straight above and below.
Bearing bearing_of(const vec3& direction);
/// The direction, unit, in which light from there travels.
vec3 direction_from(const Bearing& bearing);

/// The strongest channel, and the colour when that is 1; white where there is none.
float strength_of(const vec3& color);
vec3 tint_of(const vec3& color);

}  // namespace lucerna::commands
