#pragma once
// Quantities derived from lamps.
#include "scene/scene.h"

namespace lucerna::scene {

/// Radiant power of a point or spot lamp over its intensity on the axis [sr]: the solid angle weighted by
/// relative intensity. 0 for a directional light.
double solid_angle(const Light& lamp);

}  // namespace lucerna::scene
