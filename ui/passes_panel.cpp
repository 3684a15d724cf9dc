// The Passes panel: the time of each stage, as a stacked bar per pass, and in total.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "chart.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using session::PassStatus;
using session::Snapshot;
using session::StageStatus;

/// Greys of different lightness that separate neighbours in a bar; host stages are bluish.
ImU32 stage_colour(size_t index, bool host) {
  static constexpr int steps[] = {178, 126, 152, 104, 190, 138, 116, 164};
  const int v = steps[index % 8];
  return host ? IM_COL32(v * 2 / 3, v * 5 / 6, v, 255) : colour::grey(v);
}

double total_of(const PassStatus& pass) {
  double sum = 0;
  for (const float ms : pass.stage_ms) sum += double{ms};
  return sum;
}

std::string machine_text(const Snapshot& s) {
  return fmt::format(
      "{}\nTracer: {}\nPicture: {} \xC3\x97 {} pixels\nMemory: {} on the device, {} of this program\n"
      "{} rays since the picture started{}",
      s.device, s.tracer, s.width, s.height, megabytes_text(s.device_mb), megabytes_text(s.host_mb),
      count_text(static_cast<double>(s.rays)),
      s.dropped == 0 ? "" : fmt::format("\n{} non-finite contributions were dropped", s.dropped));
}

void pass_tooltip(const Snapshot& s, const PassStatus& pass) {
  std::string text = fmt::format("{} in total, {} paths, up to {} samples per pixel", ms_text(total_of(pass)),
                                 count_text(static_cast<double>(pass.paths)), pass.samples);
  for (size_t i = 0; i < pass.stage_ms.size() && i < s.stages.size(); ++i)
    text += fmt::format("\n{}: {}{}", s.stages[i].name, ms_text(double{pass.stage_ms[i]}),
                        s.stages[i].host ? " on the host" : "");
  tooltip(text);
}

/// The latest passes, the newest on the right.
void pass_bars(const Snapshot& s, const Area& area) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddLine({area.lo.x, area.hi.y}, {area.hi.x, area.hi.y}, colour::hairline);
  const auto& passes = s.accuracy->passes;
  const float pitch = px(7), bar = px(6);
  const size_t fitting = std::min(passes.size(), static_cast<size_t>(std::max(1.0f, area.width() / pitch)));
  if (fitting == 0) return;
  const size_t first = passes.size() - fitting;
  double most = 0;
  for (size_t i = first; i < passes.size(); ++i) most = std::max(most, total_of(passes[i]));
  if (most <= 0) return;
  const double top = nice_above(most);
  draw_text(list, {area.lo.x, area.lo.y - px(2)}, {area.hi.x, area.lo.y + px(12)},
            tick_text(top, Unit::milliseconds), colour::text_faint, Align::left, theme().fonts.small);
  const float floor_y = area.hi.y, room = area.height() - px(14);
  list->AddLine({area.lo.x, std::floor(floor_y - room)}, {area.hi.x, std::floor(floor_y - room)},
                colour::grey(44));
  for (size_t i = first; i < passes.size(); ++i) {
    const float x = area.hi.x - pitch * static_cast<float>(passes.size() - i);
    float y = floor_y;
    double sum = 0;
    for (size_t k = 0; k < passes[i].stage_ms.size(); ++k) {
      sum += double{passes[i].stage_ms[k]};
      const float next = std::floor(floor_y - room * static_cast<float>(sum / top));
      if (next < y)
        list->AddRectFilled({x, next}, {x + bar, y},
                            stage_colour(k, k < s.stages.size() && s.stages[k].host));
      y = std::min(y, next);
    }
    ImGui::SetCursorScreenPos({x, floor_y - room});
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##pass", {pitch, room});
    if (ImGui::IsItemHovered()) list->AddRect({x - 1, y - 1}, {x + bar + 1, floor_y + 1}, colour::text_dim);
    pass_tooltip(s, passes[i]);
    ImGui::PopID();
  }
}

/// A row of the legend: a stage, or several that have no rows of their own.
struct Row {
  std::string name;
  double ms = 0;
  std::optional<size_t> stage;  ///< its index; nullopt: several
  std::string help;
};

/// Rows for at most `most` rows: all stages, or those that take longest, in order, and one row for the rest.
std::vector<Row> rows_of(const std::vector<StageStatus>& stages, size_t most) {
  std::vector<size_t> longest(stages.size());
  std::iota(longest.begin(), longest.end(), size_t{0});
  if (stages.size() > most) {
    std::stable_sort(longest.begin(), longest.end(),
                     [&](size_t a, size_t b) { return stages[a].ms > stages[b].ms; });
    longest.resize(most > 0 ? most - 1 : 0);
    std::sort(longest.begin(), longest.end());
  }
  std::vector<Row> rows;
  Row others;
  for (size_t i = 0, at = 0; i < stages.size(); ++i) {
    const StageStatus& stage = stages[i];
    const std::string help = fmt::format("{}: {} {}since the picture started.", stage.name, ms_text(stage.ms),
                                         stage.host ? "of wall time on the host " : "on the device ");
    if (at < longest.size() && longest[at] == i) {
      rows.push_back({stage.name, stage.ms, i, help});
      ++at;
    } else {
      others.ms += stage.ms;
      others.help += (others.help.empty() ? "" : "\n") + help;
    }
  }
  if (const size_t left = stages.size() - longest.size(); left > 0 && most > 0) {
    others.name = fmt::format("{} others", left);
    rows.push_back(others);
  }
  return rows;
}

/// Name, time and share of the stages; the bars' legend.
void stage_rows(const std::vector<StageStatus>& stages, const ImVec2& at, float width, float height) {
  double total = 0;
  for (const auto& stage : stages) total += stage.ms;
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImFont* font = theme().fonts.small;
  const float least = std::ceil(font->FontSize) + px(1);
  const std::vector<Row> rows = rows_of(stages, static_cast<size_t>(std::max(0.0f, height / least)));
  const float row =
      std::clamp(std::floor(height / static_cast<float>(std::max<size_t>(1, rows.size()))), least, px(19));
  const float gap = px(6), time = text_width("00000 ms", font) + gap;
  const float share = width > px(170) ? text_width("100.0 %", font) + gap : 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    const ImVec2 lo(at.x, at.y + row * static_cast<float>(i)), hi(at.x + width, lo.y + row);
    const float middle = std::floor(0.5f * (lo.y + hi.y));
    if (const auto stage = rows[i].stage)
      list->AddRectFilled({lo.x, middle - px(4)}, {lo.x + px(8), middle + px(4)},
                          stage_colour(*stage, stages[*stage].host), px(2));
    const float names = hi.x - share - time;
    draw_text(list, {lo.x + px(14), lo.y}, {names, hi.y}, elided(rows[i].name, names - lo.x - px(14), font),
              colour::text_dim, Align::left, font);
    draw_text(list, {names, lo.y}, {hi.x - share, hi.y}, ms_text(rows[i].ms), colour::text, Align::right,
              font);
    if (share > 0)
      draw_text(list, {hi.x - share, lo.y}, hi,
                fmt::format("{:.1f} %", total > 0 ? 100 * rows[i].ms / total : 0), colour::text_dim,
                Align::right, font);
    ImGui::SetCursorScreenPos(lo);
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##stage", {width, row});
    ImGui::PopID();
    tooltip(rows[i].help);
  }
}

}  // namespace

void draw_passes(const commands::OpenScene& open, bool expanded, const Area& area) {
  begin_panel("##passes", area, colour::panel, false);
  const float left = panel_heading("PASSES", area);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const Snapshot* s = open.snapshot.get();
  if (s && open.scene && s->mrays_per_second > 0) {
    const ImVec2 lo(left + px(8), area.lo.y), hi(area.hi.x - px(16), area.lo.y + px(k_folded_bottom));
    if (hi.x > lo.x) {
      draw_text(list, lo, hi,
                elided(fmt::format("{:.2f} Mray/s", s->mrays_per_second), hi.x - lo.x, theme().fonts.small),
                colour::text_dim, Align::right, theme().fonts.small);
      ImGui::SetCursorScreenPos(lo);
      ImGui::InvisibleButton("##machine", {hi.x - lo.x, hi.y - lo.y});
      tooltip(machine_text(*s));
    }
  }
  if (expanded) {
    const Area inside{{area.lo.x + px(12), area.lo.y + px(k_folded_bottom) + px(4)},
                      {area.hi.x - px(16), area.hi.y - px(12)}};
    if (s && s->accuracy && !s->stages.empty()) {
      const float rows = std::min(px(236), std::floor(0.58f * inside.width()));
      const float chart = inside.hi.x - rows - px(16);
      // The bar of all passes is below those of each pass.
      pass_bars(*s, {inside.lo, {chart, inside.hi.y - px(14)}});
      double total = 0;
      for (const StageStatus& stage : s->stages) total += stage.ms;
      std::vector<Part> parts;
      for (size_t i = 0; total > 0 && i < s->stages.size(); ++i)
        parts.push_back({static_cast<float>(s->stages[i].ms / total), stage_colour(i, s->stages[i].host)});
      ImGui::SetCursorScreenPos({inside.lo.x, inside.hi.y - px(8)});
      stacked_bar(parts, 8, chart - inside.lo.x);
      tooltip(fmt::format("All passes since the picture started, {}, in the order of the rows on the right.",
                          ms_text(total)));
      stage_rows(s->stages, {chart + px(16), inside.lo.y}, rows, inside.height());
    } else {
      draw_text(list, inside.lo, {inside.hi.x, inside.lo.y + px(20)}, "No stage has run yet",
                colour::text_faint);
    }
  }
  ImGui::End();
}

}  // namespace lucerna::ui
