#pragma once
// What a person says of a lamp, in the numbers that a scene keeps: pure functions.
#include "base/math.h"

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

}  // namespace lucerna::commands
