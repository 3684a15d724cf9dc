#pragma once
// What an edit of lamps or environment is known to do to all light.
#include <optional>

#include "scene/scene.h"

namespace lucerna::scene {

/// What the light everywhere is multiplied by, channel by channel: of two scenes with the same surfaces and
/// one emitter, which is the same but for its strength and colour. Nothing where that cannot be said.
std::optional<vec3> light_factor(const Scene& before, const Scene& after);

}  // namespace lucerna::scene
