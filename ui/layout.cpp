#include "layout.h"

#include <algorithm>
#include <cmath>

namespace lucerna::ui {

namespace {

float held(float value, float least, float most) { return std::clamp(value, least, std::max(least, most)); }

/// Folds panels that a window of that size, in design pixels, has no room for, and limits the others so that
/// the picture stays usable.
Layout fitted(Layout layout, float width, float height) {
  const float side_room = width - k_least_picture_width;
  const auto both_fit = [&] {
    return (layout.left_open ? k_least_side : k_folded) + (layout.right_open ? k_least_side : k_folded) <=
           side_room;
  };
  if (!both_fit()) (layout.opened_last == Panel::right ? layout.left_open : layout.right_open) = false;
  // If not even one fits, the panel opened last is shown at the picture's cost.
  if (!both_fit() && layout.opened_last != Panel::left && layout.opened_last != Panel::right)
    layout.left_open = layout.right_open = false;
  // Each side may take what the other leaves beyond the picture.
  layout.left = held(layout.left, k_least_side,
                     std::min(480.0f, side_room - (layout.right_open ? k_least_side : k_folded)));
  layout.right = held(layout.right, k_least_side,
                      std::min(520.0f, side_room - (layout.left_open ? layout.left : k_folded)));
  const float below = height - k_bar_height - k_toolbar_height - k_least_picture_height;
  if (below < k_useful_bottom && layout.opened_last != Panel::bottom) layout.bottom_open = false;
  layout.bottom = held(layout.bottom, k_least_bottom, below);
  layout.log_share = std::clamp(layout.log_share, 0.15f, 0.6f);
  layout.passes_share = std::clamp(layout.passes_share, 0.1f, 0.75f - layout.log_share);
  return layout;
}

}  // namespace

Areas arrange(const Layout& chosen, const ImVec2& window, float scale) {
  Areas areas;
  areas.shown = fitted(chosen, window.x / scale, window.y / scale);
  const Layout& layout = areas.shown;
  const auto snap = [&](float design) { return std::floor(design * scale + 0.5f); };
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
