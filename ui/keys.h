#pragma once
// Keys pressed since the last frame.
#include <utility>
#include <vector>

namespace lucerna::ui {

struct Keys {
  std::vector<std::pair<int, int>> list;  ///< GLFW keys with their modifiers

  /// True for a key with exactly these modifiers; Shift is not looked at.
  bool pressed(int key, int mods = 0) const;
};

}  // namespace lucerna::ui
