// Cards over the picture: progress, errors, first steps.
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "base/figures.h"
#include "shown_lines.h"
#include "shown_text.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// A notice at the bottom that disappears by itself; beside or above the legend, above other cards there if
/// `beside`.
void draw_note(const std::string& note, bool beside, const Area& area, const Area& legend) {
  const float w = std::min(text_width(note) + px(32), area.width() - px(24));
  const std::vector<std::string> lines = wrapped(note, w - px(24));
  const float line = px(20), h = line * static_cast<float>(lines.size()) + px(12);
  ImVec2 lo(std::floor(0.5f * (area.lo.x + area.hi.x - w)), area.hi.y - h - px(beside ? 76.0f : 16.0f));
  if (const float edge = px(12); legend.hi.x + edge > lo.x && legend.hi.y > lo.y && legend.lo.y < lo.y + h) {
    if (legend.hi.x + w + 2 * edge <= area.hi.x)
      lo.x = legend.hi.x + edge;
    else
      lo.y = std::max(area.lo.y + edge, legend.lo.y - h - px(8));
  }
  const ImVec2 hi(lo.x + w, lo.y + h);
  ImDrawList* list = card(lo, hi);
  float y = lo.y + px(6);
  for (const std::string& text : lines) {
    draw_text(list, {lo.x, y}, {hi.x, y + line}, text, colour::text, Align::centre);
    y += line;
  }
}

/// The first steps: three sentences in the middle of the picture until they are closed.
void welcome_card(CardsView& view, const Area& area) {
  static const char* sentences[] = {
      "Drop a glTF scene on the window or press Ctrl+O. Drag with the left button to orbit around the point "
      "under the pointer, with the right button to look around; turn the wheel to move closer.",
      "W A S D fly, H walks along the floor, F frames the selected object, Space pauses, Ctrl+Z undoes the "
      "last change.",
      "The left panel selects how each component of light is computed, the right panel edits lamps, "
      "environment and materials. F1 shows all keys."};
  ImFont* font = theme().fonts.regular;
  const float w = std::min(px(520), area.width() - px(32)), pad = px(20), room = w - 2 * pad;
  float h = pad + px(28) + px(40) + pad;
  for (const char* text : sentences) h += font->CalcTextSizeA(font->FontSize, 1e9f, room, text).y + px(10);
  h = std::min(h, area.height() - px(16));
  const ImVec2 lo(std::floor(0.5f * (area.lo.x + area.hi.x - w)),
                  std::floor(0.5f * (area.lo.y + area.hi.y - h)));
  ImGui::SetCursorScreenPos(lo);
  ImGui::BeginChild("##welcome", {w, h}, false, ImGuiWindowFlags_NoScrollbar);
  ImDrawList* list = card(lo, {lo.x + w, lo.y + h}, 0.97f);
  float y = lo.y + pad;
  draw_text(list, {lo.x + pad, y}, {lo.x + w - pad, y + px(20)}, "First steps", colour::text, Align::left,
            theme().fonts.strong);
  y += px(28);
  for (const char* text : sentences) {
    ShownLines::instance().note(text);
    list->AddText(font, font->FontSize, {lo.x + pad, y}, colour::text, text, nullptr, room);
    y += font->CalcTextSizeA(font->FontSize, 1e9f, room, text).y + px(10);
  }
  ImGui::SetCursorScreenPos({lo.x + w - pad - px(96), lo.y + h - pad - px(24)});
  if (button("##begin", "Begin", true, px(96))) view.welcome = false;
  tooltip("Closes the first steps; Help > First steps shows them again. Esc.");
  ImGui::EndChild();
}

/// The command that has kept the renderer busy for more than half a second, with its duration, at the lower
/// right.
void busy_card(const CardsView& view, double seconds, const Area& area) {
  const float w = std::min(px(320), area.width() - px(24)), h = px(44);
  // On the right: legends are on the left.
  const ImVec2 lo(area.hi.x - w - px(12), area.hi.y - h - px(12)), hi(lo.x + w, lo.y + h);
  ImDrawList* list = card(lo, hi);
  const std::string time = seconds_text(seconds);
  draw_text(list, {lo.x + px(12), lo.y}, {hi.x - px(12), lo.y + px(34)}, time, colour::text_dim,
            Align::right);
  draw_text(list, {lo.x + px(12), lo.y}, {hi.x - px(12), lo.y + px(34)},
            elided(view.busy.done           ? "Drawing the picture"
                   : view.busy.text.empty() ? "Working"
                                            : "Working: " + view.busy.text,
                   w - px(36) - text_width(time)),
            colour::text);
  // The progress is unknown; the bar shows activity.
  const float lo_x = lo.x + px(12), room = hi.x - px(12) - lo_x, part = 0.25f;
  const float at = static_cast<float>(0.5 - 0.5 * std::cos(2 * seconds)) * (1 - part);
  list->AddRectFilled({lo_x, hi.y - px(9)}, {lo_x + room, hi.y - px(6)}, colour::field, px(1));
  list->AddRectFilled({lo_x + at * room, hi.y - px(9)}, {lo_x + (at + part) * room, hi.y - px(6)},
                      colour::accent, px(1));
}

/// Says at the lower right that rendering is paused, while the picture has no light of the present state.
void paused_card(const std::string& text, const Area& area) {
  const float w = std::min(text_width(text) + px(24), area.width() - px(24)), h = px(32);
  const ImVec2 hi(area.hi.x - px(12), area.hi.y - px(12)), lo(hi.x - w, hi.y - h);
  draw_text(card(lo, hi), lo, hi, elided(text, w - px(24)), colour::text, Align::centre);
}

/// The current activity, at the lower left, with a Cancel button if a load or a measurement is in progress.
void activity_card(Actions& actions, const session::Snapshot& picture, bool loads, bool moves,
                   const Area& area) {
  const bool cancels = loads || moves || picture.measures_effects;
  const float w = std::min(px(360), area.width() - px(24)), h = px(cancels ? 60.0f : 36.0f);
  const bool empty = picture.rgba.empty();
  const ImVec2 lo(empty ? std::floor(0.5f * (area.lo.x + area.hi.x - w)) : area.lo.x + px(12),
                  empty ? std::floor(area.lo.y + 0.42f * area.height()) : area.hi.y - h - px(12));
  const ImVec2 hi(lo.x + w, lo.y + h);
  ImDrawList* list = card(lo, hi);
  const float text_right = hi.x - px(cancels ? 96.0f : 12.0f);
  draw_text(list, {lo.x + px(12), lo.y}, {text_right, lo.y + px(cancels ? 44.0f : 36.0f)},
            elided(picture.activity, text_right - lo.x - px(12)), colour::text);
  if (!cancels) return;
  ImGui::SetCursorScreenPos({hi.x - px(84), lo.y + px(10)});
  if (button("##cancel", "Cancel", false, px(72)))
    actions.act(loads || moves ? "scene.cancel" : "effects.stop");
  tooltip(loads   ? "Cancels the load; the present scene stays. Esc."
          : moves ? "Leaves the objects where they were. Esc."
                  : "Ends the measurement of effects without a result. Rendering continues.");
  const float track_lo = lo.x + px(12), track_hi = hi.x - px(12), y = hi.y - px(14);
  list->AddRectFilled({track_lo, y}, {track_hi, y + px(3)}, colour::field, px(1));
  list->AddRectFilled(
      {track_lo, y}, {track_lo + (track_hi - track_lo) * std::clamp(picture.progress, 0.0f, 1.0f), y + px(3)},
      colour::accent, px(1));
}

/// The newest error, over the upper edge of the picture until it is closed.
void error_strip(Actions& actions, const std::vector<std::string>& errors, const Area& area) {
  const std::string message = errors.back();
  ImFont* font = theme().fonts.regular;
  const float pad = px(12), count_width = errors.size() > 1 ? px(44) : 0;
  const float room = std::max(px(80), area.width() - 3 * pad - px(28) - count_width);
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9f, room, message.c_str());
  const float height = std::min(size.y + px(16), area.height() * 0.6f);
  const ImVec2 lo = area.lo, hi(area.hi.x, area.lo.y + height);
  ImGui::SetCursorScreenPos(lo);
  ImGui::BeginChild("##errors", {hi.x - lo.x, hi.y - lo.y}, false, ImGuiWindowFlags_NoScrollbar);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(lo, hi, colour::error_field);
  list->AddRectFilled(lo, {lo.x + px(3), hi.y}, colour::error);
  ShownLines::instance().note(message);
  list->AddText(font, font->FontSize, {lo.x + pad, lo.y + px(8)}, colour::text, message.c_str(), nullptr,
                room);
  if (errors.size() > 1)
    draw_text(list, {hi.x - px(36) - count_width, lo.y}, {hi.x - px(40), lo.y + px(34)},
              fmt::format("1 of {}", errors.size()), colour::text_dim, Align::right, theme().fonts.small);
  ImGui::SetCursorScreenPos({hi.x - px(32), lo.y + px(6)});
  if (sign_button("##dismiss", Sign::close, true, colour::text)) actions.act("dismiss");
  tooltip("Closes the message; it stays in the log. Esc.");
  ImGui::EndChild();
}

}  // namespace

void draw_empty_state(Actions& actions, const commands::OpenScene& open,
                      const std::vector<std::string>& recent, const Area& area) {
  if (open.snapshot && !open.snapshot->activity.empty()) return;
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float x = 0.5f * (area.lo.x + area.hi.x), y = std::floor(area.lo.y + 0.42f * area.height());
  draw_text(list, {area.lo.x, y - px(16)}, {area.hi.x, y + px(16)}, "Drop a scene here", colour::text,
            Align::centre, theme().fonts.large);
  draw_text(list, {area.lo.x, y + px(20)}, {area.hi.x, y + px(40)}, "glTF 2.0, as .gltf or .glb",
            colour::text_dim, Align::centre);
  const float w = px(104);
  ImGui::SetCursorScreenPos({std::floor(x - 0.5f * w), y + px(56)});
  if (button("##open", "Open\xE2\x80\xA6", false, w)) actions.act("dialog.open");
  tooltip("Opens a scene by its path. Ctrl+O.");
  if (recent.empty()) return;
  float line = y + px(112);
  const float width = std::min(px(420), area.width() - px(48));
  draw_text(list, {area.lo.x, line - px(20)}, {area.hi.x, line}, "Recent", colour::text_faint, Align::centre,
            theme().fonts.small);
  const std::vector<std::string> files(
      recent.begin(),
      recent.begin() + std::min<std::ptrdiff_t>(5, static_cast<std::ptrdiff_t>(recent.size())));
  for (size_t i = 0; i < files.size() && line + px(24) < area.hi.y; ++i, line += px(24)) {
    ImGui::PushID(static_cast<int>(i));
    const ImVec2 lo(std::floor(x - 0.5f * width), line), hi(lo.x + width, line + px(24));
    ImGui::SetCursorScreenPos(lo);
    if (ImGui::InvisibleButton("##recent", {width, px(24)})) actions.act("window.open", files[i]);
    if (ImGui::IsItemHovered()) list->AddRectFilled(lo, hi, colour::field, px(3));
    draw_text(list, lo, hi, elided(files[i], width - px(16), nullptr, true),
              ImGui::IsItemHovered() ? colour::text : colour::text_dim, Align::centre);
    ImGui::PopID();
  }
}

void draw_cards(Actions& actions, const commands::OpenScene& open, CardsView& view, double now,
                const Area& area, const Area& legend) {
  const session::Snapshot* picture = open.snapshot.get();
  const double busy = view.busy_seconds(now);
  if (picture && !picture->activity.empty())
    activity_card(actions, *picture, open.loading(), open.moving_objects(), area);
  else if (busy > 0)
    busy_card(view, busy, area);
  const std::string paused = picture ? paused_text(*picture) : "";
  if (!paused.empty() && busy <= 0) paused_card(paused, area);
  const bool beside = (picture && !picture->activity.empty()) || !paused.empty() || busy > 0;
  if (!view.note.text.empty()) draw_note(view.note.text, beside, area, legend);
  if (!view.errors.empty()) error_strip(actions, view.errors, area);
  if (view.welcome) welcome_card(view, area);
}

}  // namespace lucerna::ui
