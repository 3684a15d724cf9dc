#pragma once
// The list of materials in the scene panel, with their properties, textures and swatches.
#include "commands/navigation.h"
#include "controls.h"
#include "scene_view.h"

namespace lucerna::ui {

/// All rows. `reveal`: the selected row is scrolled into view.
void draw_material_rows(Controls& controls, const commands::Selection& selection, SceneView& view,
                        bool reveal);

}  // namespace lucerna::ui
