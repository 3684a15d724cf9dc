#pragma once
// The section Effects: what the scene calls for, by which objects, and what is left out.
#include "controls.h"

namespace lucerna::ui {

/// Inside a panel's section. Requires a scene.
void draw_effects(Controls& controls);

}  // namespace lucerna::ui
