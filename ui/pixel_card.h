#pragma once
// The pixel inspector: hold the left button on the picture, and a card reports the pixel until it is
// released.
#include "viewport.h"

namespace lucerna::ui {

/// Starts and ends the report of the pressed pixel. `active`: the picture is pressed. Returns true on the
/// frame of a release that ends a report, which is no click.
bool inspect_while_held(Viewport& view, const Area& picture, bool active);

/// Draws the report of the inspected pixel in a card that does not cover it.
void draw_pixel_card(const commands::Workspace& work, const Area& picture);

}  // namespace lucerna::ui
