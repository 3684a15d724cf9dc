#pragma once
// Light for scenes that bring none, so that a model opened for a look is seen and not a black picture.
#include "scene/scene.h"

namespace lucerna::scene {

/// Whether the scene is lit: by a lamp that is on, an environment, or an emissive material without a texture
/// that is in use. (Textured emission is mostly a small display or a glowing seam of a model that means to be
/// lit from outside.)
bool has_light(const Scene& scene);

/// Gives a scene that has no light, names no environment and is not all unlit a studio: a dim room with a
/// large key light, a fill and a rim light, as an environment map. Adds a warning that says so. Whether it
/// did.
bool add_default_light(Scene& scene);

}  // namespace lucerna::scene
