#pragma once
// Places marks on the screen so that none covers another: a pure function, in window pixels.
#include <cstdint>
#include <span>
#include <vector>

#include "layout.h"

namespace lucerna::ui {

struct Mark {
  ImVec2 anchor;      ///< of what is marked
  int64_t group = 0;  ///< marks of one group mean the same; < 0: a mark without a group
};

struct PlacedMark {
  size_t mark = 0;  ///< index of the Mark
  ImVec2 at;        ///< its middle; the anchor, or the nearest free place around it
};

/// Places marks in their order, at least `apart` from each other and with their middles inside `within`. Left
/// out are marks whose anchors lie outside, those that would cover one of their group, and those that find no
/// free place within twice `apart`: longer lines to their anchors would hide the picture.
std::vector<PlacedMark> place_marks(std::span<const Mark> marks, float apart, const Area& within);

}  // namespace lucerna::ui
