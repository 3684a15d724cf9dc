#pragma once
// The objects of the scene, in the scene panel.
#include "commands/navigation.h"
#include "controls.h"
#include "scene_view.h"

namespace lucerna::ui {

/// The selected object with its place in numbers, then all of them. `reveal`: the selection was made
/// elsewhere and is scrolled into view.
void draw_object_rows(Controls& controls, const commands::Navigation& camera, SceneView& view, bool reveal);

}  // namespace lucerna::ui
