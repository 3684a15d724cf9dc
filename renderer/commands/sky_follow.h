#pragma once
// A sky that stays with the sun it was made for.
#include "commands/open_scene.h"

namespace lucerna::commands {

/// If the scene is lit by a sky whose sun is where this light came from, the sky's sun moves with the light.
/// Called while a command edits the light.
void follow_sun(OpenScene& open, const scene::Light& before, const scene::Light& after);

}  // namespace lucerna::commands
