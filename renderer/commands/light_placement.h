#pragma once
// Where new lights appear, and how strong they are: pure functions of what the view shows.
#include "commands/interior.h"
#include "scene/scene.h"

namespace lucerna::commands {

struct Room {
  Viewpoint view;
  Look look;     ///< its obstacles; may be empty
  Box core;      ///< of the scene; may be empty
  float ev = 0;  ///< exposure
};

/// The surface in the middle of the picture; without one, the point that the view turns about, as a surface
/// across the view.
struct LookedAt {
  vec3 point{0}, normal{0, 0, 1};  ///< the normal is unit, towards the eye
};
LookedAt looked_at(const Room& room);

/// A point in front of that surface: off by a quarter of its distance from the eye, but at most by half of
/// the free way.
vec3 off_surface(const Room& room);
/// A way to the right of the view, a tenth of the scene's radius long.
vec3 beside(const Room& room);

/// Gives a new light of its kind a place, a direction, cones of 20 and 35 degrees, and a white intensity. A
/// lamp stands off_surface(), or beside() that where one of the `others` is near and no wall between; a spot
/// is aimed at the surface; a sun comes from 45 degrees above, 135 degrees on the compass. The intensity is
/// that by which a diffuse surface of reflectance 0.5 that faces the light is shown at half of white: a
/// quarter of the scene's radius away from a lamp. Shapes are a tenth of that radius large, a tube a third
/// long, level, and face the surface like a spot.
void place_new(const Room& room, const std::vector<scene::Light>& others, scene::Light& light);

}  // namespace lucerna::commands
