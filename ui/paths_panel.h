#pragma once
// The panel of recorded paths, on the right in the scene's place: paths of a pixel, brightest first; the
// events of one of them; and what the noise comes from.
#include <optional>

#include "controls.h"
#include "layout.h"
#include "marquee.h"

namespace lucerna::ui {

/// Its name among the right panel's contents.
inline constexpr const char* k_paths_side = "paths";

/// What the next press in the picture does for this panel.
struct PathsView {
  enum class Pick { none, pixel, area } pick = Pick::none;
  int count = 64;   ///< paths to trace
  Marquee marquee;  ///< of an area
};

void draw_paths_panel(Controls& controls, const commands::Workspace& work, PathsView& view, const Area& area);

/// Draws the dragged area over the picture; when the button is released, explains its noise. `active`: the
/// picture is pressed. Returns true if the press belongs to it.
bool drag_noise_area(Actions& actions, PathsView& view, const Area& picture, bool active);

/// Marks the traced pixel and the explained area in the picture.
void draw_paths_marks(const commands::Workspace& work, const Area& picture);

}  // namespace lucerna::ui
