#pragma once
// The pop-up with materials to choose from.
#include "controls.h"
#include "scene_view.h"

namespace lucerna::ui {

/// The id by which it is opened.
inline constexpr const char* k_swatches = "##swatch_popup";
/// Draws it while it is open: the program's swatches and the user's own. A press gives material `index` the
/// swatch.
void swatch_popup(Controls& controls, SceneView& view, uint32_t index);

}  // namespace lucerna::ui
