#include "compare_panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "chart.h"
#include "compare_plot.h"
#include "panel_block.h"
#include "state.h"

namespace lucerna::ui {
namespace {

using commands::CompareView;
using commands::HeldResult;
using commands::HeldResults;

constexpr float k_card = 64, k_picture = 88, k_mark = 16;

float share_of_width(int parts) {
  return std::floor((ImGui::CalcItemWidth() - px(4) * static_cast<float>(parts - 1)) /
                    static_cast<float>(parts));
}

/// "12 s · 2.1 %"
std::string cost_text(const session::HeldPicture& p) {
  if (p.displayed) return "Display colours";
  if (p.is_foreign) return "Time and error unknown";
  const std::string error = held_error_text(p);
  if (p.seconds <= 0) return error;
  return error.empty() ? about_text(p.seconds) : about_text(p.seconds) + " \xC2\xB7 " + error;
}

/// What it shows besides its name.
std::string content_text(const HeldResult& held) {
  const session::HeldPicture& p = *held.picture;
  const std::string methods = session::methods_text(p.methods);
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " \xC2\xB7 ") + part; };
  if (p.samples > 0) add(fmt::format("{} sample{}", mean_text(p.samples), p.samples == 1 ? "" : "s"));
  if (!p.file.empty()) add(p.is_foreign ? "file of unknown origin" : "file");
  if (!p.shows.empty()) add(p.shows + " only");
  if (!methods.empty() && !held.name.starts_with(methods)) add(methods);
  if (!held.camera.empty()) add(held.camera);
  return text;
}

/// The mark of a result, in a small square.
void draw_mark(ImDrawList* list, const ImVec2& lo, const std::string& mark, bool on) {
  const ImVec2 hi(lo.x + px(k_mark), lo.y + px(k_mark));
  list->AddRectFilled(lo, hi, on ? colour::accent : colour::grey(84), px(2));
  draw_text(list, lo, hi, mark, on ? colour::grey(24) : colour::text, Align::centre, theme().fonts.small);
}

/// A held result as a row: picture, name, what it shows, what it took.
void result_row(Controls& controls, const HeldResults& results, size_t index, const CompareState& state) {
  const HeldResult& held = results.list()[index];
  const bool on = &held == results.compared();
  const float width = ImGui::CalcItemWidth(), height = px(k_card);
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + height);
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImGui::PushID(static_cast<int>(held.id));
  const bool pressed = ImGui::InvisibleButton("##held", {std::max(1.0f, width - px(26)), height});
  const bool hovered = ImGui::IsItemHovered();
  tooltip(fmt::format(
      "{}. {}", held_text(held),
      on ? "It is compared with the picture. Press to end that." : "Press to compare the picture with it."));
  if (on || hovered)
    list->AddRectFilled({lo.x - px(4), lo.y}, {hi.x + px(4), hi.y - px(2)},
                        on ? colour::field_active : colour::field, px(3));
  // The picture, as large as its frame allows.
  const Area frame{{lo.x, lo.y + px(4)}, {lo.x + px(k_picture), hi.y - px(6)}};
  list->AddRectFilled(frame.lo, frame.hi, colour::surround, px(2));
  const auto w = static_cast<float>(held.picture->width), h = static_cast<float>(held.picture->height);
  const float fit = std::min(frame.width() / w, frame.height() / h);
  const ImVec2 at(std::floor(0.5f * (frame.lo.x + frame.hi.x - fit * w)),
                  std::floor(0.5f * (frame.lo.y + frame.hi.y - fit * h)));
  if (const unsigned texture = state.pictures.thumbnail(held, static_cast<uint32_t>(2 * px(k_picture))))
    list->AddImage(reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(texture)), at,
                   {at.x + fit * w, at.y + fit * h});
  draw_mark(list, {frame.lo.x + px(3), frame.lo.y + px(3)}, held_mark(index), on);
  const float x = frame.hi.x + px(8), right = hi.x - px(2);
  ImFont* small = theme().fonts.small;
  const auto line = [&](float from, float to, const std::string& text, ImU32 ink, ImFont* font, float inset) {
    draw_text(list, {x, lo.y + px(from)}, {right, lo.y + px(to)}, elided(text, right - inset - x, font), ink,
              Align::left, font);
  };
  line(3, 22, held.name, colour::text, theme().fonts.regular, px(22));
  line(22, 40, content_text(held), colour::text_dim, small, 0);
  line(40, 58, cost_text(*held.picture), colour::text_dim, small, 0);
  ImGui::SetCursorScreenPos({hi.x - px(22), lo.y + px(2)});
  if (sign_button("##forget", Sign::close, false)) controls.act("compare.forget", held.name);
  tooltip("Forgets this result.");
  ImGui::PopID();
  ImGui::SetCursorScreenPos({lo.x, hi.y});
  if (pressed) controls.act("compare.with", on ? std::string() : held.name);
}

/// The name of the compared result, to be changed.
void name_field(Controls& controls, const HeldResult& held, CompareState& state) {
  // A typed name is applied when the field is left.
  if (state.named != held.name || !ImGui::IsAnyItemActive()) state.named = state.typed = held.name;
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth());
  ImGui::InputTextWithHint("##name", "Name", &state.typed);
  if (ImGui::IsItemDeactivatedAfterEdit() && state.typed != held.name && !state.typed.empty())
    controls.act("compare.rename", held.name, state.typed);
  tooltip("Name of the chosen result. Press to change it.");
}

/// A file that is being read: its share, and a button that ends it.
void reading_row(Controls& controls, const commands::Comparing::Reading& reading) {
  const float width = ImGui::CalcItemWidth(), button_width = px(22);
  const double done = reading.done;
  const std::string text =
      reading.cancelled ? "Ends reading\xE2\x80\xA6"
                        : fmt::format("Reads '{}': {:.0f} %",
                                      std::filesystem::path(reading.file).filename().string(), 100 * done);
  const ImVec2 lo = ImGui::GetCursorScreenPos();
  draw_text(ImGui::GetWindowDrawList(), lo, {lo.x + width - button_width, lo.y + px(22)},
            elided(text, width - button_width - px(6), theme().fonts.small), colour::text_dim, Align::left,
            theme().fonts.small);
  ImGui::SetCursorScreenPos({lo.x + width - button_width, lo.y});
  if (sign_button("##stop_reading", Sign::close, false)) controls.act("compare.cancel");
  tooltip("Ends reading; nothing is held.");
  stacked_bar({{static_cast<float>(done), colour::accent}}, px(3), width);
  gap(6);
}

void results_block(Controls& controls, const commands::Workspace& work, CompareState& state) {
  const HeldResults& results = work.compare.results;
  const bool full = results.list().size() >= HeldResults::k_most;
  ImGui::BeginDisabled(!work.open.scene || full);
  const auto& holding = work.compare.holding;
  const bool reads = holding && holding->reading;
  if (button("##hold", holding && !reads ? "Holding\xE2\x80\xA6" : "Hold picture", false, share_of_width(2)))
    controls.act("compare.hold");
  ImGui::EndDisabled();
  tooltip(full ? "All places are taken: forget a result first."
               : "Holds the shown picture, to compare later ones with it. Ctrl+H.");
  ImGui::SameLine(0, px(4));
  ImGui::BeginDisabled(full);
  if (button("##load", "Load\xE2\x80\xA6", false, share_of_width(2))) controls.act("dialog.held");
  ImGui::EndDisabled();
  tooltip("Holds the picture of an EXR, HDR or PNG file, such as a reference.");
  gap(6);
  if (reads) reading_row(controls, *holding->reading);
  if (results.list().empty())
    return paragraph(
        "Render with one choice of methods and hold the result. Then choose others, or change a setting, and "
        "compare. Held results follow exposure and tone curve.");
  for (size_t i = 0; i < results.list().size(); ++i) result_row(controls, results, i, state);
  if (const HeldResult* held = results.compared()) gap(4), name_field(controls, *held, state);
}

void comparison_block(Controls& controls, const commands::Workspace& work) {
  const HeldResults& results = work.compare.results;
  const HeldResult* held = results.compared();
  struct View {
    CompareView view;
    const char *id, *name, *help;
  };
  constexpr View k_views[] = {
      {CompareView::wipe, "##wipe", "Wipe",
       "The held result to the left of a line, the live picture to the right. Drag the line in the picture."},
      {CompareView::flip, "##flip", "Flip",
       "Shows the held result in place of the picture. Hold Y to do so for a moment."},
      {CompareView::difference, "##difference", "Difference",
       "Where the live picture is brighter (orange) or darker (blue) than the held result."}};
  ImGui::BeginDisabled(!held);
  for (const View& v : k_views) {
    if (v.view != CompareView::wipe) ImGui::SameLine(0, px(4));
    const bool on = results.view() == v.view;
    if (button(v.id, v.name, on, share_of_width(3)))
      controls.act("compare.view", on ? "off" : commands::k_compare_views[static_cast<size_t>(v.view)]);
    tooltip(v.help);
  }
  ImGui::EndDisabled();
  gap(4);
  if (!held) return paragraph("Choose a held result to compare the picture with it.", colour::text_faint);
  if (results.view() == CompareView::difference) {
    float times = results.difference_times;
    if (slider("##times", "Difference \xC3\x97", times,
               {.lo = 0.1f, .hi = 1000, .log = true, .decimals = 1, .typed_lo = 0.01f, .typed_hi = 1000}))
      controls.act("compare.times", times);
    tooltip("Factor of the difference. At 1, the full colours stand for what the exposure shows as white.");
    gap(4);
  }
  if (const std::string& problem = work.compare.live.problem(); !problem.empty())
    return paragraph("No comparison: " + problem + ".", colour::warning);
  const auto& figures = work.compare.live.figures();
  const bool light = figures && !held->picture->displayed;
  value_row("Relative squared error", light ? fmt::format("{:.3g}", figures->relative_squared) : k_dash,
            "Mean over the pixels of the squared difference over the held result's square.");
  value_row("Error as seen", light ? percent_text(figures->as_seen) : k_dash,
            "Root mean square difference of the pixels, each relative to the light around it. Light beyond "
            "white counts as white.");
  value_row("FLIP", figures ? fmt::format("{:.4f}", figures->flip) : k_dash,
            "How large the difference of the two pictures appears as they are shown, with this exposure and "
            "tone curve, when they alternate: 0 equal, 1 as different as can be.");
  gap(2);
  paragraph("Of the live picture against the held result; the noise of both is contained.",
            colour::text_faint);
}

}  // namespace

void draw_compare_panel(Controls& controls, const commands::Workspace& work, CompareState& state,
                        const Area& area) {
  begin_panel("##side_compare", area, colour::panel, true);
  const size_t count = work.compare.results.list().size();
  panel_block(controls, "Held results", true,
              count > 0 ? fmt::format("{} of {}", count, HeldResults::k_most) : "", 10,
              [&] { results_block(controls, work, state); });
  if (count > 0) {
    panel_block(controls, "Comparison", true, "", 10, [&] { comparison_block(controls, work); });
    panel_block(controls, "Accuracy in time", true, "", 10,
                [&] { draw_compare_plot(work, ImGui::CalcItemWidth()); });
  }
  hairline();
  ImGui::End();
}

void draw_compare_plot(const commands::Workspace& work, float width) {
  const std::vector<CompareLine> lines = compare_lines(work.compare.results, work.open.snapshot.get());
  if (lines.empty())
    return paragraph("Nothing to plot: no result has a known time and error.", colour::text_faint);
  const float height = px(168), inset = px(40), below = px(18);
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + height);
  ImGui::Dummy({width, height});
  const PlotRange range = compare_range(lines);
  const Area plot{{lo.x + inset, lo.y + px(6)}, {hi.x - px(8), hi.y - below}};
  const LogAxis x{range.t_lo, range.t_hi, plot.lo.x, plot.hi.x},
      y{range.e_lo, range.e_hi, plot.hi.y, plot.lo.y};
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImFont* font = theme().fonts.small;
  for (const Tick& t : ticks(x, Unit::seconds, px(44))) {
    const float at = std::floor(x.at(t.value));
    list->AddLine({at, plot.lo.y}, {at, plot.hi.y}, colour::grey(t.labelled ? 52 : 42));
    if (!t.labelled) continue;
    const std::string text = tick_text(t.value, Unit::seconds);
    const float half = 0.5f * text_width(text, font);
    const float middle = std::clamp(at, plot.lo.x + half, hi.x - half);
    draw_text(list, {middle - half - 1, plot.hi.y + px(2)}, {middle + half + px(2), hi.y}, text,
              colour::text_faint, Align::left, font);
  }
  for (const Tick& t : ticks(y, Unit::relative, px(18))) {
    const float at = std::floor(y.at(t.value));
    list->AddLine({plot.lo.x, at}, {plot.hi.x, at}, colour::grey(t.labelled ? 52 : 42));
    if (t.labelled)
      draw_text(list, {lo.x, at - px(8)}, {plot.lo.x - px(5), at + px(8)}, tick_text(t.value, Unit::relative),
                colour::text_faint, Align::right, font);
  }
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  std::string hovered;
  std::vector<std::function<void()>> marks;  // above all lines
  for (const CompareLine& line : lines) {
    const bool live = line.mark.empty();
    const ImU32 ink = live ? colour::text : line.compared ? colour::accent : colour::grey(140);
    std::vector<ImVec2> points;
    for (const auto& [seconds, error] : line.points) points.emplace_back(x.at(seconds), y.at(error));
    if (points.size() > 1)
      list->AddPolyline(points.data(), static_cast<int>(points.size()), ink, 0, px(live ? 2.0f : 1.5f));
    const ImVec2 end = points.back();
    for (size_t i = 0; i < points.size(); ++i)
      if (std::hypot(points[i].x - mouse.x, points[i].y - mouse.y) < px(8))
        hovered = fmt::format("{}: {} after {}", capitalised(line.name), percent_text(line.points[i].second),
                              about_text(line.points[i].first));
    if (live)
      list->AddCircleFilled(end, px(3), ink, 12);
    else
      marks.emplace_back([&, end] {
        draw_mark(list,
                  {std::clamp(end.x - px(0.5f * k_mark), plot.lo.x, plot.hi.x - px(k_mark)),
                   std::clamp(end.y - px(0.5f * k_mark), plot.lo.y, plot.hi.y - px(k_mark))},
                  line.mark, line.compared);
      });
  }
  for (const auto& mark : marks) mark();
  if (!hovered.empty()) tooltip(hovered);
  paragraph("Estimated error as seen over seconds of rendering. White: the live picture.",
            colour::text_faint);
}

}  // namespace lucerna::ui
