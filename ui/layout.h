#pragma once
// Layout of the window's parts: a pure function, in window pixels.
#include <imgui.h>

#include <algorithm>
#include <optional>

#include "base/math.h"

namespace lucerna::ui {

enum class Panel { left, right, bottom };

/// Chosen layout, or the layout of a frame; sizes in design pixels.
struct Layout {
  float left = 280, right = 296, bottom = 224;
  float log_share = 0.3f, passes_share = 0.3f;  ///< of the bottom strip's width
  bool panels = true;                           ///< Tab
  bool left_open = true, right_open = true, bottom_open = true;
  /// The panel opened last. It is shown if there is no room for all. None: left, then right, then bottom.
  std::optional<Panel> opened_last;
  /// The user has folded, opened or resized the panel: a small window does not fold it for the picture's
  /// sake.
  bool left_arranged = false, right_arranged = false, bottom_arranged = false;
};

struct Area {
  ImVec2 lo, hi;
  float width() const { return hi.x - lo.x; }
  float height() const { return hi.y - lo.y; }
  /// Where a point of the window is in it: 0..1 to the right and down; beyond that outside.
  vec2 place_of(const ImVec2& at) const {
    return {(at.x - lo.x) / std::max(1.0f, width()), (at.y - lo.y) / std::max(1.0f, height())};
  }
  bool contains(const ImVec2& at) const {
    const vec2 place = place_of(at);
    return place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1;
  }
};

/// Areas of the parts; hidden parts have none. They tile the window: bar on top; left, (toolbar over
/// picture), right; bottom strip split into accuracy, passes and log.
struct Areas {
  Area bar, left, toolbar, picture, right, accuracy, passes, log;
  Layout shown;  ///< sizes and folds as the parts have them
};

inline constexpr float k_bar_height = 32, k_toolbar_height = 36, k_folded = 24, k_folded_bottom = 28;
inline constexpr float k_least_picture_width = 360, k_least_picture_height = 240;
inline constexpr float k_least_side = 232, k_least_bottom = 96;
/// Below this height the strip is folded.
inline constexpr float k_useful_bottom = 140;

/// A window below either size [design pixels] is small.
inline constexpr float k_roomy_width = 1280, k_roomy_height = 800;
/// Share of a small window that the picture has, at least, unless the user has arranged panels.
inline constexpr float k_least_picture_share = 0.5f;

/// Arranges the parts. On a small window the panels that the user has not arranged are narrowed and folded,
/// the bottom strip first, until the picture has k_least_picture_share of it. If the window leaves no usable
/// picture beside the chosen panels, they are shown narrower, then folded; the choice stays for a larger
/// window. `scale` is window pixels per design pixel.
Areas arrange(const Layout& layout, const ImVec2& window, float scale);

}  // namespace lucerna::ui
