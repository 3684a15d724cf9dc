#pragma once
// Figures of lamps that follow from what the scene says of them.
#include "scene/scene.h"

namespace lucerna::scene {

/// Steradians that a point or spot lamp shines through, each direction weighted with its intensity over that
/// on the axis: its radiant power over its intensity. 0 for a directional light.
double solid_angle(const Light& lamp);

}  // namespace lucerna::scene
