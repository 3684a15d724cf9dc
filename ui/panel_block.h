#pragma once
// A section of a panel with its content.
#include "controls.h"
#include "widgets.h"

namespace lucerna::ui {

/// Draws the heading and, if open, `draw()` inside the panel's margins. The title is part of the ids inside,
/// so sections may number rows alike. `after`: space below, design pixels.
template <class Draw>
void panel_block(Controls& controls, const char* title, bool fallback, const std::string& note, float after,
                 const Draw& draw) {
  if (!panel_section(controls, title, fallback, note)) return;
  begin_padded();
  ImGui::PushID(title);
  draw();
  ImGui::PopID();
  end_padded();
  gap(after);
}

}  // namespace lucerna::ui
