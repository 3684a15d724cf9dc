#include "layout.h"

#include <algorithm>
#include <cmath>

namespace lucerna::ui {

namespace {

float held(float value, float least, float most) { return std::clamp(value, least, std::max(least, most)); }

bool small(float width, float height) { return width < k_roomy_width || height < k_roomy_height; }

/// Panels that a small window folds, the bottom strip first, so that the picture has its share: of the
/// window's size alone, so that folding or opening one panel moves no other.
Layout folded_for_picture(float width, float height) {
  Layout layout;
  const auto enough = [&] {
    const float sides =
        (layout.left_open ? k_least_side : k_folded) + (layout.right_open ? k_least_side : k_folded);
    const float strip = layout.bottom_open ? layout.bottom : k_folded_bottom;
    return (width - sides) * (height - k_bar_height - k_toolbar_height - strip) >=
           k_least_picture_share * width * height;
  };
  for (bool* open : {&layout.bottom_open, &layout.right_open, &layout.left_open})
    if (!enough()) *open = false;
  return layout;
}

/// Folds and narrows the panels of a small window that the user has not arranged.
void make_room_for_picture(Layout& layout, float width, float height) {
  if (!small(width, height)) return;
  const auto arranged = [&](Panel panel, bool by_user) { return by_user || layout.opened_last == panel; };
  const bool keep_left = arranged(Panel::left, layout.left_arranged);
  const bool keep_right = arranged(Panel::right, layout.right_arranged);
  const Layout folded = folded_for_picture(width, height);
  if (!keep_left) layout.left_open = layout.left_open && folded.left_open;
  if (!keep_right) layout.right_open = layout.right_open && folded.right_open;
  if (!arranged(Panel::bottom, layout.bottom_arranged))
    layout.bottom_open = layout.bottom_open && folded.bottom_open;
  // Sides take what is left, at least k_least_side.
  const float strip = layout.bottom_open ? layout.bottom : k_folded_bottom;
  const float picture_height = height - k_bar_height - k_toolbar_height - strip;
  float excess = (layout.left_open ? layout.left : k_folded) + (layout.right_open ? layout.right : k_folded) +
                 k_least_picture_share * width * height / std::max(picture_height, 1.0f) - width;
  const auto narrow = [&](bool open, bool kept, float& size, float share) {
    if (!open || kept || size <= k_least_side || excess <= 0) return;
    const float less = std::min(share * excess, size - k_least_side);
    size -= less, excess -= less;
  };
  narrow(layout.right_open, keep_right, layout.right, layout.left_open && !keep_left ? 0.5f : 1);
  narrow(layout.left_open, keep_left, layout.left, 1);
  narrow(layout.right_open, keep_right, layout.right, 1);
}

/// Folds what a window of that size, in design pixels, has no room for, and holds the rest to what leaves a
/// usable picture.
Layout fitted(Layout layout, float width, float height) {
  make_room_for_picture(layout, width, height);
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
