#include "layout.h"

#include <algorithm>
#include <cmath>

namespace lucerna::ui {

Areas arrange(Layout& layout, const ImVec2& window, float scale) {
  const float width = window.x / scale, height = window.y / scale;
  const auto hold = [](float value, float least, float most) {
    return std::clamp(value, least, std::max(least, most));
  };
  // Each side may take what the other leaves beyond the picture.
  const float side_room = width - k_least_picture_width;
  layout.left =
      hold(layout.left, 232, std::min(480.0f, side_room - (layout.right_open ? layout.right : k_folded)));
  layout.right =
      hold(layout.right, 232, std::min(520.0f, side_room - (layout.left_open ? layout.left : k_folded)));
  layout.bottom = hold(layout.bottom, 96, height - k_bar_height - k_toolbar_height - k_least_picture_height);
  layout.log_share = std::clamp(layout.log_share, 0.15f, 0.6f);
  layout.passes_share = std::clamp(layout.passes_share, 0.1f, 0.75f - layout.log_share);

  const auto snap = [&](float design) { return std::floor(design * scale + 0.5f); };
  Areas areas;
  if (!layout.panels) {
    areas.picture = {{0, 0}, window};
    return areas;
  }
  const float bar = snap(k_bar_height);
  const float bottom = window.y - snap(layout.bottom_open ? layout.bottom : k_folded_bottom);
  const float left = snap(layout.left_open ? layout.left : k_folded);
  const float right = window.x - snap(layout.right_open ? layout.right : k_folded);
  const float toolbar = bar + snap(k_toolbar_height);
  const float log = std::floor(window.x * (1 - layout.log_share));
  const float passes = std::floor(window.x * (1 - layout.log_share - layout.passes_share));
  areas.bar = {{0, 0}, {window.x, bar}};
  areas.left = {{0, bar}, {left, bottom}};
  areas.toolbar = {{left, bar}, {right, toolbar}};
  areas.picture = {{left, toolbar}, {right, bottom}};
  areas.right = {{right, bar}, {window.x, bottom}};
  areas.accuracy = {{0, bottom}, {passes, window.y}};
  areas.passes = {{passes, bottom}, {log, window.y}};
  areas.log = {{log, bottom}, window};
  return areas;
}

}  // namespace lucerna::ui
