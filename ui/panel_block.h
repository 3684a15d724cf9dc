#pragma once
// A section of a panel with what it holds.
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {

/// Draws the section's heading and, where it is open, `draw()` inside the panel's margins. The title is part
/// of the ids inside, so that two sections may number their rows alike. `after`: room below, design pixels.
template <class Draw>
void panel_block(Ui& ui, const char* title, bool fallback, const std::string& note, float after,
                 const Draw& draw) {
  if (!panel_section(ui, title, fallback, note)) return;
  begin_padded();
  ImGui::PushID(title);
  draw();
  ImGui::PopID();
  end_padded();
  gap(after);
}

}  // namespace lucerna::ui
