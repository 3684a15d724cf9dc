#pragma once
// The region that alone gets samples (sampling.region), over the picture.
#include "actions.h"
#include "commands/open_scene.h"
#include "layout.h"
#include "marquee.h"

namespace lucerna::ui {

struct RegionView {
  bool picks = false;  ///< the next drag in the picture chooses the region
  Marquee marquee;
};

/// Draws its frame with its samples and a mark that closes it; nothing without a region.
void draw_region(const commands::OpenScene& open, const Area& picture);
/// True if that point of the window is on the mark.
bool closes_region(const commands::OpenScene& open, const Area& picture, const ImVec2& at);
/// Follows the drag that chooses a region. Returns true if the press in the picture belongs to it. `active`:
/// the picture is pressed.
bool drag_region(Actions& actions, RegionView& view, const Area& picture, bool active);

}  // namespace lucerna::ui
