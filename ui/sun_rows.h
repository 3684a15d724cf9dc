#pragma once
// Controls of the sun by date, time and place, and of skies by formula.
#include "controls.h"
#include "scene/scene.h"

namespace lucerna::ui {

/// Of a selected sun; `i`: its index.
void sun_details(Controls& controls, size_t i, const scene::Light& light);

/// Of the environment.
void sky_rows(Controls& controls);

}  // namespace lucerna::ui
