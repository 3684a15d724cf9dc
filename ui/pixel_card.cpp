#include "pixel_card.h"

#include <algorithm>
#include <cmath>

#include "widgets.h"

namespace lucerna::ui {
namespace {

constexpr double k_hold = 0.5;  // seconds
constexpr float k_still = 4;    // design pixels that the pointer may move
constexpr float k_line = 16, k_pad = 10, k_edge = 12;

}  // namespace

bool inspect_while_held(Viewport& view, const Area& picture, bool active) {
  const ImGuiIO& io = ImGui::GetIO();
  HeldPixel& held = view.held_pixel;
  const bool pressed =
      active && io.MouseDown[0] && !view.click_taken() && !view.drag.lamp && !view.drag.object;
  if (!pressed) {
    held.since.reset();
    if (!std::exchange(held.reported, false)) return false;
    view.controls.act("inspect.none");
    return true;
  }
  if (!held.since) held.since = view.work.now;
  const bool still = io.MouseDragMaxDistanceSqr[0] < px(k_still) * px(k_still);
  if (held.reported || !still || view.work.open.loading() || !view.has_picture()) return false;
  view.controls.actions.wake(2);
  if (view.work.now - *held.since < k_hold) return false;
  if (!picture.contains(io.MousePos)) return false;
  const vec2 place = picture.place_of(io.MousePos);
  held.reported = true;
  view.controls.act("inspect.pixel", place.x, place.y);
  return false;
}

void draw_pixel_card(const commands::Workspace& work, const Area& picture) {
  if (!work.pixel || work.pixel->lines.empty()) return;
  const std::vector<std::string>& lines = work.pixel->lines;
  ImFont* font = theme().fonts.small;
  float width = 0;
  for (const std::string& line : lines) width = std::max(width, text_width(line, font));
  width = std::min(width + 2 * px(k_pad), picture.width() - 2 * px(k_edge));
  const float height = std::min(px(k_line) * static_cast<float>(lines.size() + 1) + 2 * px(k_pad),
                                picture.height() - 2 * px(k_edge));
  if (width < px(80) || height < px(40)) return;
  // On the side of the picture that the pixel is not on.
  const bool right = work.pixel->at.x < 0.5f;
  const ImVec2 lo(std::floor(right ? picture.hi.x - width - px(k_edge) : picture.lo.x + px(k_edge)),
                  std::floor(picture.lo.y + px(k_edge)));
  ImDrawList* list = card(lo, {lo.x + width, lo.y + height});
  const ImVec2 at(picture.lo.x + work.pixel->at.x * picture.width(),
                  picture.lo.y + work.pixel->at.y * picture.height());
  list->AddCircle(at, px(5), colour::accent, 0, px(1));
  float y = lo.y + px(k_pad);
  for (const std::string& line : lines) {
    if (y + px(k_line) > lo.y + height) break;
    draw_text(list, {lo.x + px(k_pad), y}, {lo.x + width - px(k_pad), y + px(k_line)},
              elided(line, width - 2 * px(k_pad), font), colour::text, Align::left, font);
    y += px(k_line);
  }
  if (y + px(k_line) <= lo.y + height)
    draw_text(list, {lo.x + px(k_pad), y}, {lo.x + width - px(k_pad), y + px(k_line)}, "I: trace its paths",
              colour::text_faint, Align::left, font);
}

}  // namespace lucerna::ui
