#include "region_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "schedule/region.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

constexpr float k_region_tag = 20, k_region_mark = 20;

/// The frame in the window; nothing without a region.
std::optional<Area> region_area(const commands::OpenScene& open, const Area& picture) {
  const session::Snapshot* s = open.snapshot.get();
  if (!s || s->width == 0 || s->height == 0) return std::nullopt;
  std::optional<schedule::Region> region;
  try {
    region = schedule::parse_region(open.setting("sampling.region"), "");
  } catch (const Error&) {
  }  // refused by the session
  if (!region) return std::nullopt;
  const schedule::Rectangle pixels = schedule::pixels_of(*region, s->width, s->height);
  const auto at = [&](uint32_t x, uint32_t y) {
    return ImVec2(
        std::round(picture.lo.x + picture.width() * static_cast<float>(x) / static_cast<float>(s->width)),
        std::round(picture.lo.y + picture.height() * static_cast<float>(y) / static_cast<float>(s->height)));
  };
  return Area{at(pixels.left, pixels.top), at(pixels.right, pixels.bottom)};
}

/// Where the mark is: above the frame's right end, or inside where there is no room.
Area region_mark(const Area& frame, const Area& picture) {
  const float size = px(k_region_mark),
              y = frame.lo.y - size >= picture.lo.y ? frame.lo.y - size : frame.lo.y;
  return {{frame.hi.x - size, y}, {frame.hi.x, y + size}};
}

/// What it says of the region, in the room that there is.
std::string region_text(const session::Snapshot& s, float room, ImFont* font) {
  if (s.accuracy && s.accuracy->adaptive) return "Region: gets all samples";
  const std::string samples = fmt::format("{} / {} samples", s.samples, s.max_samples);
  for (const std::string& text : {"Region: " + samples + ", the rest waits", "Region: " + samples})
    if (text_width(text, font) <= room) return text;
  return samples;
}

}  // namespace

void draw_region(const commands::OpenScene& open, const Area& picture) {
  const std::optional<Area> frame = region_area(open, picture);
  if (!frame) return;
  const session::Snapshot& s = *open.snapshot;
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRect({frame->lo.x - 1, frame->lo.y - 1}, {frame->hi.x + 1, frame->hi.y + 1},
                IM_COL32(0, 0, 0, 120), 0, 0, px(3));
  list->AddRect(frame->lo, frame->hi, colour::accent, 0, 0, std::max(1.0f, px(1)));
  const Area mark = region_mark(*frame, picture);
  const bool hot = closes_region(open, picture, ImGui::GetIO().MousePos);
  ImFont* font = theme().fonts.small;
  const float room = mark.lo.x - frame->lo.x, pad = 2 * px(6);
  const std::string text = region_text(s, room - pad, font);
  const float width = std::min(room, text_width(text, font) + pad);
  if (width > px(24)) {
    list->AddRectFilled({frame->lo.x, mark.lo.y}, {frame->lo.x + width, mark.lo.y + px(k_region_tag)},
                        colour::with_alpha(colour::bar, 0.9f));
    draw_text(list, {frame->lo.x + px(6), mark.lo.y}, {frame->lo.x + width, mark.lo.y + px(k_region_tag)},
              elided(text, width - px(8), font), colour::text, Align::left, font);
  }
  list->AddRectFilled(mark.lo, mark.hi, colour::with_alpha(hot ? colour::field_hover : colour::bar, 0.9f));
  draw_sign(list, {0.5f * (mark.lo.x + mark.hi.x), 0.5f * (mark.lo.y + mark.hi.y)}, px(9), Sign::close, true,
            hot ? colour::text : colour::text_dim);
  if (hot) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
}

bool closes_region(const commands::OpenScene& open, const Area& picture, const ImVec2& at) {
  const std::optional<Area> frame = region_area(open, picture);
  if (!frame) return false;
  const Area mark = region_mark(*frame, picture);
  return at.x >= mark.lo.x && at.x < mark.hi.x && at.y >= mark.lo.y && at.y < mark.hi.y;
}

bool drag_region(Actions& actions, RegionView& view, const Area& picture, bool active) {
  if (!view.picks) return false;
  const Marquee::State state = view.marquee.drag(picture, active);
  if (state == Marquee::State::idle || state == Marquee::State::dragging)
    return state != Marquee::State::idle;
  actions.act("region.pick", false);
  if (state == Marquee::State::chosen)
    actions.act("region.set", view.marquee.lo().x, view.marquee.lo().y, view.marquee.size().x,
                view.marquee.size().y);
  return true;
}

}  // namespace lucerna::ui
