#pragma once
// A rectangle that is dragged over the picture.
#include <optional>

#include "base/math.h"
#include "layout.h"

namespace lucerna::ui {

class Marquee {
 public:
  enum class State {
    idle,      ///< nothing is dragged
    dragging,  ///< the press in the picture belongs to it
    ended,     ///< released, too small for a rectangle
    chosen     ///< released: lo() and size() are the rectangle
  };
  /// Follows the left button and draws the rectangle; once per frame. `active`: the picture is pressed.
  State drag(const Area& picture, bool active);
  void reset() { from_.reset(); }

  // Of the latest rectangle, in picture widths and heights.
  const vec2& lo() const { return lo_; }
  const vec2& size() const { return size_; }

 private:
  std::optional<ImVec2> from_;  ///< first corner
  vec2 lo_{0}, size_{0};
};

}  // namespace lucerna::ui
