#include "frame_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "widgets.h"

namespace lucerna::ui {
namespace {

constexpr float k_guide_tag = 20, k_guide_pad = 6;

/// "16:9" for known ratios, otherwise "2.39:1".
std::string aspect_text(float aspect) {
  for (const auto& [w, h] :
       {std::pair{16, 9}, {9, 16}, {4, 3}, {3, 4}, {3, 2}, {2, 3}, {1, 1}, {5, 4}, {4, 5}})
    if (std::abs(aspect * static_cast<float>(h) / static_cast<float>(w) - 1) < 1e-3f)
      return fmt::format("{}:{}", w, h);
  return fmt::format("{:.3g}:1", aspect);
}

}  // namespace

std::optional<Area> guide_area(const Area& picture, float aspect) {
  const float width = std::round(aspect * picture.height());
  if (!(width > 0) || width > picture.width() + 1) return std::nullopt;
  const float left = std::round(picture.lo.x + 0.5f * (picture.width() - width));
  return Area{{left, picture.lo.y}, {left + width, picture.hi.y}};
}

void draw_frame_guide(const FrameGuide& guide, const scene::Camera& camera, const Area& picture) {
  if (!guide.on) return;
  const float aspect = guide.aspect > 0 ? guide.aspect : camera.aspect;
  const std::optional<Area> frame = guide_area(picture, aspect);
  std::string text = aspect > 0 ? "Frame " + aspect_text(aspect) : "The camera states no aspect ratio";
  if (aspect > 0 && !frame) text += " is wider than the picture";
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (frame) {
    // Dark beside light, so that it is seen on any picture.
    list->AddRect(frame->lo, frame->hi, IM_COL32(0, 0, 0, 150), 0, 0, px(3));
    list->AddRect(frame->lo, frame->hi, colour::text, 0, 0, px(1));
  }
  ImFont* font = theme().fonts.small;
  const Area& in = frame ? *frame : picture;
  const float width = std::min(in.width(), text_width(text, font) + 2 * px(k_guide_pad));
  if (width < px(24)) return;
  const ImVec2 lo(std::floor(0.5f * (in.lo.x + in.hi.x - width)), in.hi.y - px(k_guide_tag)),
      hi(lo.x + width, in.hi.y);
  list->AddRectFilled(lo, hi, colour::with_alpha(colour::bar, 0.9f));
  draw_text(list, lo, hi, elided(text, width - px(4), font), colour::text, Align::centre, font);
}

}  // namespace lucerna::ui
