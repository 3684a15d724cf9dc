#pragma once
// Where the parts of the window go: pure arithmetic, window pixels.
#include <imgui.h>

namespace lucerna::ui {

/// What the person has chosen; sizes in design pixels.
struct Layout {
  float left = 280, right = 296, bottom = 224;
  float log_share = 0.3f, passes_share = 0.3f;  ///< of the bottom strip's width
  bool panels = true;                           ///< Tab
  bool left_open = true, right_open = true, bottom_open = true;
};

struct Area {
  ImVec2 lo, hi;
  float width() const { return hi.x - lo.x; }
  float height() const { return hi.y - lo.y; }
};

/// The parts; those that are not shown have no area. They tile the window: bar on top; left, (toolbar over
/// picture), right; bottom strip split into accuracy, passes and log.
struct Areas {
  Area bar, left, toolbar, picture, right, accuracy, passes, log;
};

inline constexpr float k_bar_height = 32, k_toolbar_height = 36, k_folded = 24, k_folded_bottom = 28;
inline constexpr float k_least_picture_width = 360, k_least_picture_height = 240;

/// Holds the sizes to what leaves a usable picture (changing `layout`), and arranges. `scale` is window
/// pixels per design pixel.
Areas arrange(Layout& layout, const ImVec2& window, float scale);

}  // namespace lucerna::ui
