#include "marquee.h"

#include <algorithm>

#include "widgets.h"

namespace lucerna::ui {

Marquee::State Marquee::drag(const Area& picture, bool active) {
  const ImGuiIO& io = ImGui::GetIO();
  const auto inside = [&](const ImVec2& at) {
    return ImVec2(std::clamp(at.x, picture.lo.x, picture.hi.x), std::clamp(at.y, picture.lo.y, picture.hi.y));
  };
  if (active && io.MouseDown[0] && !from_) from_ = inside(io.MouseClickedPos[0]);
  if (!from_) return State::idle;
  const ImVec2 to = inside(io.MousePos);
  const ImVec2 lo(std::min(from_->x, to.x), std::min(from_->y, to.y)),
      hi(std::max(from_->x, to.x), std::max(from_->y, to.y));
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(lo, hi, colour::accent_dim);
  list->AddRect(lo, hi, colour::accent, 0, 0, px(1));
  if (io.MouseDown[0]) return State::dragging;
  from_.reset();
  const vec2 whole(std::max(1.0f, picture.width()), std::max(1.0f, picture.height()));
  lo_ = vec2(lo.x - picture.lo.x, lo.y - picture.lo.y) / whole;
  size_ = vec2(hi.x - lo.x, hi.y - lo.y) / whole;
  return hi.x - lo.x >= px(2) && hi.y - lo.y >= px(2) ? State::chosen : State::ended;
}

}  // namespace lucerna::ui
