#pragma once
// Rows of the scene panel's lists.
#include <string>

#include "actions.h"
#include "scene_view.h"
#include "widgets.h"

namespace lucerna::ui {

/// A selectable row: mark, name (elided), a dim note at the right end. Returns true if it was pressed.
bool list_row(const char* id, bool chosen, const std::string& name, const std::string& note, ImU32 mark,
              float inset_right, float height = 24);
/// A press on a row selects, or clears the selection.
void choose(Actions& actions, SceneView& view, bool chosen, const char* kind, size_t index);
/// A line of dim text.
void quiet_line(const std::string& text);
/// A sign at the right end of the row that begins at `row` and was just drawn. Returns true if it was
/// pressed.
bool row_sign(const ImVec2& row, const char* id, Sign sign, bool on, const char* help);
/// Scrolls so that the row at `y` (window pixels) is visible.
void show_row(float y);

}  // namespace lucerna::ui
