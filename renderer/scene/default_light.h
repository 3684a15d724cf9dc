#pragma once
// Default light for scenes without lights, so that they are not black.
#include "scene/scene.h"

namespace lucerna::scene {

/// True if the scene has a lamp that is on, an environment, or a used emissive material without an emission
/// texture. (Textured emission is mostly a display or a glowing seam of a model lit from outside.)
bool has_light(const Scene& scene);

/// Adds a studio environment (a dim room with a key light, a fill and a rim light) and a warning to a scene
/// that has no light, names no environment and is not entirely unlit. Returns whether it did.
bool add_default_light(Scene& scene);

}  // namespace lucerna::scene
