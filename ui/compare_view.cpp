#include "compare_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart.h"
#include "compare_plot.h"
#include "film/io/light_difference.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using commands::CompareView;
using commands::HeldResult;

constexpr float k_tag = 20, k_least_tag = 32, k_edge = 12, k_ramp = 248, k_grip = 6;

/// The view that is shown: with the key held, the other one of live picture and held result.
CompareView shown_view(const commands::HeldResults& results, bool flipped) {
  if (!flipped || !results.compared()) return results.view();
  return results.view() == CompareView::flip ? CompareView::off : CompareView::flip;
}

/// A small label in `room` pixels: `head` dim, `all` bright, cut if too long; its left or right end is at
/// `x`.
void tag(float x, float y, float room, bool ends_here, const std::string& head, const std::string& all) {
  ImFont* font = theme().fonts.small;
  const float between = px(6), pad = px(8), first = text_width(head, font);
  const float rest = room - first - between - 2 * pad;
  if (rest < px(k_least_tag)) return;
  const std::string text = elided(all, rest, font);
  const float width = first + between + text_width(text, font) + 2 * pad;
  const ImVec2 lo(std::floor(ends_here ? x - width : x), y), hi(lo.x + width, y + px(k_tag));
  ImDrawList* list = card(lo, hi, 0.9f);
  draw_text(list, {lo.x + pad, lo.y}, {lo.x + pad + first + 1, hi.y}, head, colour::text_dim, Align::left,
            font);
  draw_text(list, {lo.x + pad + first + between, lo.y}, {hi.x, hi.y}, text, colour::text, Align::left, font);
}

void image(unsigned texture, const Area& picture, float from, float to) {
  if (texture == 0) return;
  const float w = std::max(1.0f, picture.width());
  ImGui::GetWindowDrawList()->AddImage(reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(texture)),
                                       {from, picture.lo.y}, {to, picture.hi.y},
                                       {(from - picture.lo.x) / w, 0}, {(to - picture.lo.x) / w, 1});
}

float line_at(const commands::HeldResults& results, const Area& picture) {
  return std::floor(picture.lo.x + results.wipe_at * picture.width());
}

void draw_wipe(const commands::Workspace& work, const CompareState& state, const HeldResult& held,
               const Area& picture) {
  const float x = line_at(work.compare.results, picture), y = picture.lo.y + px(k_edge);
  image(state.pictures.held(held), picture, picture.lo.x, x);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(picture.lo, picture.hi, true);
  // Labels stay on their sides.
  const float left = x - picture.lo.x - 2 * px(k_edge), right = picture.hi.x - x - 2 * px(k_edge);
  tag(x - px(k_edge), y, left, true, "Held", held_text(held));
  tag(x + px(k_edge), y, right, false, "Now", live_text(*work.open.snapshot));
  const float middle = std::floor(0.5f * (picture.lo.y + picture.hi.y)), grip = px(k_grip);
  const ImU32 ink = state.dragging ? colour::accent : colour::text;
  list->AddRectFilled({x - px(2), picture.lo.y}, {x + px(2), picture.hi.y}, IM_COL32(0, 0, 0, 110));
  list->AddRectFilled({x - px(1), picture.lo.y}, {x + px(1), picture.hi.y}, ink);
  list->AddRectFilled({x - grip, middle - 2 * grip}, {x + grip, middle + 2 * grip}, colour::bar, px(3));
  list->AddRect({x - grip, middle - 2 * grip}, {x + grip, middle + 2 * grip}, ink, px(3));
  for (const float side : {-1.0f, 1.0f})
    list->AddTriangleFilled({x + side * px(4), middle}, {x + side * px(1), middle - px(3)},
                            {x + side * px(1), middle + px(3)}, ink);
  list->PopClipRect();
}

void draw_held(const CompareState& state, const HeldResult& held, const Area& picture) {
  image(state.pictures.held(held), picture, picture.lo.x, picture.hi.x);
  tag(picture.lo.x + px(k_edge), picture.lo.y + px(k_edge), picture.width() - 2 * px(k_edge), false, "Held",
      held_text(held));
}

/// What the colours of the difference mean, and its figures.
void difference_legend(const commands::Comparing& compare, const HeldResult& held,
                       const session::Snapshot& live, const Area& picture) {
  ImFont* font = theme().fonts.small;
  const float pad = px(10), line = px(16), bar = px(8), width = px(k_ramp) + 2 * pad;
  const auto& figures = compare.live.figures();
  std::vector<std::string> texts{"Now: " + live_text(live), "Held: " + held_text(held)};
  if (figures && std::isnan(figures->as_seen))
    texts.push_back(fmt::format("FLIP {:.3g}", figures->flip));
  else if (figures)
    for (const std::string& text :
         {fmt::format("Relative squared error {:.3g}", figures->relative_squared),
          fmt::format("Error as seen {}, FLIP {:.3g}", percent_text(figures->as_seen), figures->flip)})
      texts.push_back(text);
  const float height = 2 * px(6) + line * static_cast<float>(texts.size() + 3) + bar + px(10);
  if (height + 2 * px(k_edge) > picture.height() || width + 2 * px(k_edge) > picture.width()) return;
  const ImVec2 lo(picture.lo.x + px(k_edge), picture.lo.y + px(k_edge));
  ImDrawList* list = card(lo, {lo.x + width, lo.y + height}, 0.92f);
  ImVec2 at(lo.x + pad, lo.y + px(6));
  const auto write = [&](const std::string& text, ImU32 ink, Align align = Align::left) {
    draw_text(list, at, {at.x + px(k_ramp), at.y + line}, elided(text, px(k_ramp), font), ink, align, font);
  };
  const float times = compare.results.difference_times;
  write(fmt::format("Difference \xC3\x97 {:.3g}, in luminance", times), colour::text);
  at.y += line + px(4);
  constexpr int k_steps = 32;
  const auto shade = [](int i) {
    return ink(film::difference_color(2.0f * static_cast<float>(i) / k_steps - 1));
  };
  for (int i = 0; i < k_steps; ++i) {
    const float a = at.x + px(k_ramp) * static_cast<float>(i) / k_steps,
                b = at.x + px(k_ramp) * static_cast<float>(i + 1) / k_steps;
    list->AddRectFilledMultiColor({a, at.y}, {b, at.y + bar}, shade(i), shade(i + 1), shade(i + 1), shade(i));
  }
  at.y += bar + px(2);
  const std::string end = fmt::format("{:.3g}", 1 / times);
  write("\xE2\x88\x92" + end, colour::text);
  write("0", colour::text, Align::centre);
  write("+" + end + " of white", colour::text, Align::right);
  at.y += line;
  write("now darker", colour::text_dim);
  write("equal", colour::text_dim, Align::centre);
  write("now brighter", colour::text_dim, Align::right);
  at.y += line + px(4);
  for (const std::string& text : texts) write(text, colour::text_dim), at.y += line;
}

/// A sentence in place of the comparison.
void say(const std::string& sentence, const Area& picture) {
  const float w = std::min(text_width(sentence) + px(32), picture.width() - px(24));
  const std::vector<std::string> lines = wrapped(sentence, w - px(24));
  const float line = px(20);
  const ImVec2 lo(std::floor(0.5f * (picture.lo.x + picture.hi.x - w)), picture.lo.y + px(k_edge));
  ImDrawList* list = card(lo, {lo.x + w, lo.y + line * static_cast<float>(lines.size()) + px(12)});
  for (size_t i = 0; i < lines.size(); ++i) {
    const float y = lo.y + px(6) + line * static_cast<float>(i);
    draw_text(list, {lo.x, y}, {lo.x + w, y + line}, lines[i], colour::text, Align::centre);
  }
}

}  // namespace

void draw_comparison(const commands::Workspace& work, const CompareState& state, const Area& picture) {
  const commands::Comparing& compare = work.compare;
  const HeldResult* held = compare.results.compared();
  const CompareView view = shown_view(compare.results, state.flipped);
  if (!held || !work.open.snapshot || view == CompareView::off) return;
  if (const std::string& problem = compare.live.problem(); !problem.empty())
    return say("No comparison: " + problem + ".", picture);
  switch (view) {
    case CompareView::off:
      break;
    case CompareView::wipe:
      draw_wipe(work, state, *held, picture);
      break;
    case CompareView::flip:
      draw_held(state, *held, picture);
      break;
    case CompareView::difference:
      image(state.pictures.difference(compare, *held), picture, picture.lo.x, picture.hi.x);
      difference_legend(compare, *held, *work.open.snapshot, picture);
      break;
  }
}

bool drag_wipe(Actions& actions, const commands::Workspace& work, CompareState& state, const Area& picture,
               bool active) {
  const commands::HeldResults& results = work.compare.results;
  const ImGuiIO& io = ImGui::GetIO();
  const bool shown = shown_view(results, state.flipped) == CompareView::wipe && results.compared() &&
                     work.compare.live.problem().empty();
  if (!shown) return state.dragging = false;
  const auto near = [&](const ImVec2& at) {
    return std::abs(at.x - line_at(results, picture)) <= px(k_grip) && at.y >= picture.lo.y &&
           at.y <= picture.hi.y;
  };
  if (ImGui::IsItemHovered() && near(io.MousePos)) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActivated() && io.MouseDown[0] && near(io.MousePos)) state.dragging = true;
  if (!state.dragging) return false;
  if (active && io.MouseDown[0] && (io.MouseDelta.x != 0)) {
    const float at = (io.MousePos.x - picture.lo.x) / std::max(1.0f, picture.width());
    actions.act("compare.at", std::round(1e4f * std::clamp(at, 0.0f, 1.0f)) / 1e4f);
  }
  if (!io.MouseDown[0]) state.dragging = false;
  return true;
}

}  // namespace lucerna::ui
