#pragma once
// Where the parts of the window go: pure arithmetic, window pixels.
#include <imgui.h>

#include <optional>

namespace lucerna::ui {

enum class Panel { left, right, bottom };

/// What the person has chosen, or what a frame shows of it; sizes in design pixels.
struct Layout {
  float left = 280, right = 296, bottom = 224;
  float log_share = 0.3f, passes_share = 0.3f;  ///< of the bottom strip's width
  bool panels = true;                           ///< Tab
  bool left_open = true, right_open = true, bottom_open = true;
  /// The panel opened last; it is shown where there is no room for all. None: left before right before
  /// bottom.
  std::optional<Panel> opened_last;
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
  Layout shown;  ///< sizes and folds as the parts have them
};

inline constexpr float k_bar_height = 32, k_toolbar_height = 36, k_folded = 24, k_folded_bottom = 28;
inline constexpr float k_least_picture_width = 360, k_least_picture_height = 240;
inline constexpr float k_least_side = 232, k_least_bottom = 96;
/// Below this height the strip says little: it is folded rather than shown.
inline constexpr float k_useful_bottom = 140;

/// Arranges the parts. Where the window leaves no usable picture beside the panels as chosen, they are shown
/// narrower, and folded where even that does not do; the choice itself stays for a larger window. `scale` is
/// window pixels per design pixel.
Areas arrange(const Layout& layout, const ImVec2& window, float scale);

}  // namespace lucerna::ui
