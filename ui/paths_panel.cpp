#include "paths_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "overlay/path_lines.h"
#include "panel_block.h"
#include "state.h"

namespace lucerna::ui {
namespace {

constexpr size_t k_most_rows = 40, k_few_rows = 8, k_most_shares = 5;
constexpr float k_path_row = 18;

using recording::Event;
using recording::Recording;

/// A row that can be pressed, with texts at its left and right, a mark before them and a bar behind.
struct PathRow {
  std::string left, right, help;
  ImU32 mark = 0;
  float bar = 0;  ///< 0..1
  bool on = false, faint = false;
};
bool row(int id, const PathRow& r) {
  const float width = ImGui::CalcItemWidth(), height = px(k_path_row), indent = px(14);
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + height);
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImGui::PushID(id);
  const bool pressed = ImGui::InvisibleButton("##row", {std::max(1.0f, width), height});
  const bool hovered = ImGui::IsItemHovered();
  if (!r.help.empty()) tooltip(r.help);
  ImGui::PopID();
  if (r.on || hovered) list->AddRectFilled(lo, hi, r.on ? colour::accent_dim : colour::field, px(2));
  if (r.bar > 0)
    list->AddRectFilled({lo.x + indent, hi.y - px(3)},
                        {lo.x + indent + (width - indent) * std::min(r.bar, 1.0f), hi.y - px(1)},
                        colour::with_alpha(r.mark ? r.mark : colour::accent, 0.6f), px(1));
  const float middle = std::floor(0.5f * (lo.y + hi.y));
  if (r.mark) list->AddRectFilled({lo.x, middle - px(4)}, {lo.x + px(8), middle + px(4)}, r.mark, px(2));
  ImFont* font = theme().fonts.small;
  const float right = text_width(r.right, font) + px(6);
  draw_text(list, {lo.x + indent, lo.y}, {hi.x - right, hi.y}, elided(r.left, width - indent - right, font),
            r.faint ? colour::text_faint : colour::text, Align::left, font);
  draw_text(list, lo, hi, r.right, colour::text_dim, Align::right, font);
  ImGui::SetCursorScreenPos({lo.x, hi.y});
  return pressed;
}

float half_width() { return std::floor(0.5f * (ImGui::CalcItemWidth() - px(4))); }

void pick_buttons(Controls& controls, const commands::Workspace& work, const PathsView& view) {
  const bool picks = view.pick == PathsView::Pick::pixel;
  if (button("##pick", picks ? "Click a pixel" : "Trace a pixel", picks, half_width()))
    controls.act("paths.pick", picks ? "none" : "pixel");
  tooltip(
      "The next click in the picture traces the first paths of that pixel and draws them in the scene. I.");
  ImGui::SameLine(0, px(4));
  ImGui::BeginDisabled(!work.traced);
  if (button("##clear", "Clear", false, half_width())) controls.act("inspect.untrace");
  tooltip("Removes the traced paths from the picture.");
  ImGui::EndDisabled();
}

void trace_block(Controls& controls, const commands::Workspace& work, PathsView& view) {
  pick_buttons(controls, work, view);
  gap(4);
  auto count = float(view.count);
  if (slider("##count", "Paths", count, {.lo = 1, .hi = 4096, .log = true, .decimals = 0, .step = 1})) {
    view.count = int(std::lround(count));
  }
  tooltip("Number of paths to trace at the next click: the first samples of the pixel.");
  option_control(controls, "overlay.path_color", "Colour");
  if (!work.traced)
    return paragraph(
        "Traced paths stay while the camera moves, so that you can look at them from elsewhere.");
  if (!work.traced->problem.empty()) return paragraph(work.traced->problem, colour::warning);
  if (!work.traced->paths) return paragraph("Tracing\xE2\x80\xA6");
  const Recording& all = *work.traced->paths;
  const auto n = double(std::max<size_t>(all.paths.size(), 1));
  gap(4);
  if (!all.paths.empty())
    value_row("Pixel", fmt::format("{} {}", all.paths[0].pixel % all.width, all.paths[0].pixel / all.width),
              "Column and row, from the upper left.");
  value_row("Traced paths", count_text(double(all.paths.size())),
            "Paths in the picture and in the list; the slider is for the next pixel.");
  value_row("Mean light", fmt::format("{:.4g}", work.traced->mean_light), "Mean luminance of these paths.");
  value_row("Without light", share_text(double(work.traced->dark), n), "Paths that contribute no light.");
  if (const uint64_t lost = all.lost())
    value_row("Events without room", count_text(double(lost)), "Their light is missing in this list.",
              colour::warning);
}

ImU32 mark_of(uint8_t component) {
  return component < colour::component.size() ? colour::component[component] : colour::text_faint;
}

/// The paths, the brightest first.
void list_block(Controls& controls, const commands::PathInquiry& traced) {
  const Recording& all = *traced.paths;
  const double most =
      traced.order.empty() ? 0 : recording::luminance_of(all.events_of(all.paths[traced.order[0]]));
  // Down to the followed path, which is explained below.
  const size_t rows = traced.followed < 0 ? k_most_rows : std::max(k_few_rows, size_t(traced.followed) + 1);
  for (size_t i = 0; i < std::min(traced.order.size(), rows); ++i) {
    const auto events = all.events_of(all.paths[traced.order[i]]);
    const double light = recording::luminance_of(events);
    uint32_t brightest = 0;
    for (uint32_t e = 0; e < events.size(); ++e)
      if (recording::contributes_light(events[e]) &&
          (!recording::contributes_light(events[brightest]) ||
           luminance(events[e].contribution) > luminance(events[brightest].contribution)))
        brightest = e;
    const bool on = traced.followed == int(i);
    const std::string word = light > 0 ? recording::word_of(events, brightest) : "no light";
    if (row(int(i), {.left = word,
                     .right = light > 0 ? fmt::format("{:.3g}", light) : "",
                     .help = fmt::format("Sample {}, {} events. Click to follow it.",
                                         all.paths[traced.order[i]].sample, events.size()),
                     .mark = mark_of(recording::main_component(events)),
                     .bar = most > 0 ? float(light / most) : 0,
                     .on = on,
                     .faint = light <= 0}))
      controls.act("inspect.follow", on ? 0 : int(i) + 1);
  }
  if (traced.order.size() > rows)
    paragraph(fmt::format("and {} more", traced.order.size() - rows), colour::text_faint);
}

std::string triple(const vec3& v) { return fmt::format("{:.3g} {:.3g} {:.3g}", v.x, v.y, v.z); }

void event_values(const Recording& all, std::span<const Event> events, uint32_t i) {
  const Event& e = events[i];
  gap(4);
  value_row("Way", recording::word_of(events, i),
            "E, and a letter for each scattering: D diffuse, G glossy, S specular.");
  if (const std::string material = recording::material_name(all, e); !material.empty())
    value_row("Material", material);
  if (const std::string light = recording::light_name(all, e); !light.empty()) value_row("Light", light);
  value_row("Position", triple(e.position), "World space, metres.");
  if (e.pdf > 0)
    value_row("Density", fmt::format("{:.3g} / sr", e.pdf),
              "Of the direction to this event; of a light sample together with the selection of the light.");
  if (e.throughput != vec3(0))
    value_row("Throughput", triple(e.throughput), "On arrival, divided by all probabilities.");
  if (shared::is_component(recording::component_of(e)))
    value_row(recording::contributes_light(e) ? "Light" : "Blocked light", triple(e.contribution),
              recording::contributes_light(e) ? "What it adds to the sample of the pixel."
                                              : "What it would have added.");
}

/// The events of the followed path.
void follow_block(Controls& controls, const commands::PathInquiry& traced) {
  const Recording& all = *traced.paths;
  const auto events = all.events_of(all.paths[traced.order[size_t(traced.followed)]]);
  const auto count = int(events.size());
  const auto follow = [&](int event) { controls.act("inspect.follow", traced.followed + 1, event); };
  ImGui::BeginDisabled(traced.vertex <= 0);
  if (button("##before", "Previous", false, half_width())) follow(traced.vertex - 1);
  tooltip("The event before.");
  ImGui::EndDisabled();
  ImGui::SameLine(0, px(4));
  ImGui::BeginDisabled(traced.vertex + 1 >= count);
  if (button("##next", "Next", false, half_width())) follow(traced.vertex + 1);
  tooltip("The next event.");
  ImGui::EndDisabled();
  gap(4);
  for (int i = 0; i < std::min(count, int(k_most_rows)); ++i) {
    const Event& e = events[size_t(i)];
    const bool lit = shared::is_component(recording::component_of(e));
    if (row(i, {.left = recording::event_text(all, e),
                .right = lit ? fmt::format("{:.3g}", luminance(e.contribution)) : "",
                .help = "Click to mark it in the picture.",
                .mark = ink(overlay::event_ink(e)),
                .on = traced.vertex == i,
                .faint = lit && !recording::contributes_light(e)}))
      follow(i);
  }
  if (traced.vertex >= 0 && traced.vertex < count) event_values(all, events, uint32_t(traced.vertex));
}

void share_rows(const char* title, const std::vector<recording::NoiseShare>& shares) {
  gap(6);
  label(title, colour::text_dim, theme().fonts.small);
  ImGui::PushID(title);
  for (size_t i = 0; i < std::min(shares.size(), k_most_shares); ++i) {
    const recording::NoiseShare& s = shares[i];
    ImU32 mark = 0;
    for (const size_t c : k_components)
      if (s.name == paths::k_component_names[c]) mark = colour::component[c];
    row(int(i),
        {.left = s.name.empty() ? "directly visible" : s.name,
         .right = fmt::format("{:.0f} %", 100 * s.noise),
         .help = fmt::format("{:.1f} % of the noise, {:.1f} % of the light.", 100 * s.noise, 100 * s.light),
         .mark = mark,
         .bar = float(std::clamp(s.noise, 0.0, 1.0))});
  }
  ImGui::PopID();
}

void noise_block(Controls& controls, const commands::Workspace& work, const PathsView& view) {
  const bool picks = view.pick == PathsView::Pick::area;
  if (button("##whole", "Whole picture", false, half_width())) controls.act("inspect.noise");
  tooltip("Explains the noise of the whole picture, by a short trial of its paths.");
  ImGui::SameLine(0, px(4));
  if (button("##area", picks ? "Drag a rectangle" : "Rectangle", picks, half_width()))
    controls.act("paths.pick", picks ? "none" : "area");
  tooltip("The next drag in the picture selects a rectangle, whose noise is explained.");
  gap(4);
  if (!work.noise) return;
  if (!work.noise->problem.empty()) return paragraph(work.noise->problem, colour::warning);
  if (!work.noise->report) return paragraph("Tracing\xE2\x80\xA6");
  const recording::NoiseReport& report = *work.noise->report;
  if (report.sentence.empty()) return paragraph("No noise: the paths of each pixel have the same light.");
  paragraph(report.sentence, colour::text);
  gap(4);
  const bool in_use = std::all_of(report.cure.settings.begin(), report.cure.settings.end(),
                                  [&](const auto& s) { return controls.open.setting(s.first) == s.second; });
  if (!report.cure.settings.empty() && in_use) {
    paragraph(
        report.cure.label +
        ": in use now. What is said here is of the picture before; trace again for the noise that is left.");
  } else if (!report.cure.settings.empty()) {
    if (button("##cure", report.cure.label, false, ImGui::CalcItemWidth()))
      for (const auto& [key, value] : report.cure.settings) controls.act("set", key, value);
    std::string keys;
    for (const auto& [key, value] : report.cure.settings) keys += fmt::format("{} = {}. ", key, value);
    tooltip(keys + capitalised(report.cure.reason) + ".");
  } else {
    paragraph(report.cure.reason);
  }
  gap(4);
  value_row("Error of one sample", fmt::format("{:.0f} %", 100 * report.of_sample),
            "As seen: relative to the light around each pixel.");
  value_row("Trial", fmt::format("{} paths of {} pixels", report.paths, report.pixels),
            "Pixels shown as white do not count.");
  share_rows("Components", report.components);
  share_rows("Ways of light", report.words);
  share_rows("Lights", report.lights);
  share_rows("Last surface before the light", report.materials);
}

}  // namespace

void draw_paths_panel(Controls& controls, const commands::Workspace& work, PathsView& view,
                      const Area& area) {
  begin_panel("##side_paths", area, colour::panel, true);
  if (!controls.open.scene) {
    panel_block(controls, "Paths of a pixel", true, "", 10,
                [] { paragraph("No scene is open.", colour::text_faint); });
  } else {
    panel_block(controls, "Paths of a pixel", true, "", 10, [&] { trace_block(controls, work, view); });
    if (work.traced && work.traced->paths) {
      panel_block(controls, "Brightest paths", true, count_text(double(work.traced->order.size())), 10,
                  [&] { list_block(controls, *work.traced); });
      if (work.traced->followed >= 0)
        panel_block(controls, "Followed path", true, fmt::format("{}", work.traced->followed + 1), 10,
                    [&] { follow_block(controls, *work.traced); });
    }
    panel_block(controls, "Noise", true, "", 10, [&] { noise_block(controls, work, view); });
  }
  hairline();
  ImGui::End();
}

bool drag_noise_area(Actions& actions, PathsView& view, const Area& picture, bool active) {
  if (view.pick != PathsView::Pick::area) return false;
  const Marquee::State state = view.marquee.drag(picture, active);
  if (state == Marquee::State::idle || state == Marquee::State::dragging)
    return state != Marquee::State::idle;
  actions.act("paths.pick", "none");
  if (state == Marquee::State::chosen)
    actions.act("inspect.noise", view.marquee.lo().x, view.marquee.lo().y, view.marquee.size().x,
                view.marquee.size().y);
  return true;
}

void draw_paths_marks(const commands::Workspace& work, const Area& picture) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const auto at = [&](const vec2& place) {
    return ImVec2(picture.lo.x + place.x * picture.width(), picture.lo.y + place.y * picture.height());
  };
  if (work.noise && !work.noise->whole_picture())
    list->AddRect(at(work.noise->lo), at(work.noise->hi), colour::accent, 0, 0, px(1));
}

}  // namespace lucerna::ui
