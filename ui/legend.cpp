// The legend over the picture, at its lower left: the ramp of a heat map, marks of solvers (solvers::Legend),
// the states of tiles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart.h"
#include "film/tile_scale.h"
#include "shaders/shared/ramp.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

constexpr float k_ramp_width = 248, k_ramp_height = 8;

ImU32 ramp_ink(uint32_t ramp, float t) { return ink(shared::ramp_color(ramp, t)); }

/// The ramp from left to right, with labels under the given positions (0..1).
void ramp_bar(ImDrawList* list, const ImVec2& at, uint32_t ramp,
              const std::vector<std::pair<float, std::string>>& labels) {
  constexpr int k_steps = 32;
  const float w = px(k_ramp_width), h = px(k_ramp_height);
  for (int i = 0; i < k_steps; ++i) {
    const float a = static_cast<float>(i) / k_steps, b = static_cast<float>(i + 1) / k_steps;
    const ImU32 from = ramp_ink(ramp, a), to = ramp_ink(ramp, b);
    list->AddRectFilledMultiColor({at.x + a * w, at.y}, {at.x + b * w, at.y + h}, from, to, to, from);
  }
  ImFont* font = theme().fonts.small;
  float taken = at.x - px(8);  // end of the labels so far
  for (const auto& [place, text] : labels) {
    const float x = std::floor(at.x + place * w);
    list->AddLine({x, at.y + h}, {x, at.y + h + px(3)}, colour::text_dim);
    if (text.empty()) continue;
    const float half = 0.5f * text_width(text, font);
    const float middle = std::clamp(x, at.x + half - px(2), at.x + w - half + px(2));
    if (middle - half < taken + px(4)) continue;
    taken = middle + half;
    draw_text(list, {middle - half - 1, at.y + h + px(3)}, {middle + half + px(2), at.y + h + px(18)}, text,
              colour::text, Align::left, font);
  }
}

const char* title_of(uint32_t layer) {
  if (layer == shared::k_layer_samples) return "Samples per pixel";
  if (layer == shared::k_layer_error) return "Relative error, estimated, of 8 \xC3\x97 8 pixels";
  return "Device time per pixel";
}

std::vector<std::pair<float, std::string>> heat_labels(const session::Legend& legend) {
  const Unit unit = legend.layer == shared::k_layer_samples ? Unit::count
                    : legend.layer == shared::k_layer_error ? Unit::relative
                                                            : Unit::milliseconds;
  std::vector<std::pair<float, std::string>> labels;
  if (!legend.logarithmic) {
    for (int i = 0; i <= 4; ++i) {
      const float value = legend.lo + 0.25f * static_cast<float>(i) * (legend.hi - legend.lo);
      labels.emplace_back(0.25f * static_cast<float>(i), tick_text(double{value}, unit));
    }
    return labels;
  }
  const LogAxis axis{legend.lo, legend.hi, 0, px(k_ramp_width)};
  for (const Tick& tick : ticks(axis, unit, px(unit == Unit::milliseconds ? 46 : 34)))
    labels.emplace_back(shared::ramp_position(static_cast<float>(tick.value), legend.lo, legend.hi, 1u),
                        tick.labelled ? tick_text(tick.value, unit) : "");
  return labels;
}

/// A sample of how a state is drawn.
void tile_sample(ImDrawList* list, const ImVec2& lo, uint32_t state) {
  const ImVec2 hi(lo.x + px(12), lo.y + px(12));
  const ImU32 far = ramp_ink(shared::k_ramp_tiles, 0), near = ramp_ink(shared::k_ramp_tiles, 1);
  switch (state) {
    case shared::k_tile_waiting:
      list->AddRect(lo, hi, colour::grey(120));
      break;
    case shared::k_tile_active:
      list->AddRectFilledMultiColor(lo, hi, colour::with_alpha(far, 0.35f), colour::with_alpha(near, 0.35f),
                                    colour::with_alpha(near, 0.35f), colour::with_alpha(far, 0.35f));
      list->AddRect(lo, hi, colour::mix(far, near, 0.5f));
      break;
    case shared::k_tile_done:
      list->AddRectFilled(lo, hi, colour::grey(62));
      break;
    default:
      list->AddRectFilled(lo, hi, colour::grey(50));
      list->PushClipRect(lo, hi, true);
      for (float x = -1; x < 2; x += 0.4f)
        list->AddLine({lo.x + x * px(12), hi.y}, {lo.x + (x + 1) * px(12), lo.y}, far);
      list->PopClipRect();
  }
}

/// A square of a colour and its meaning; returns the x behind it.
float swatch(ImDrawList* list, const ImVec2& at, ImU32 colour, const std::string& name) {
  ImFont* font = theme().fonts.small;
  list->AddRectFilled({at.x, at.y + px(3)}, {at.x + px(10), at.y + px(13)}, colour, px(2));
  if (name.empty()) return at.x + px(12);
  const float end = at.x + px(14) + text_width(name, font);
  draw_text(list, {at.x + px(14), at.y}, {end + px(2), at.y + px(16)}, name, colour::text, Align::left, font);
  return end + px(10);
}

/// Labels of a solver's ramp; by default the ticks of its range.
std::vector<std::pair<float, std::string>> ramp_labels(const solvers::Legend& legend) {
  using Scale = solvers::Legend::Range::Unit;
  std::vector<std::pair<float, std::string>> labels;
  for (const solvers::Legend::Tick& tick : legend.ticks) labels.emplace_back(tick.at, tick.text);
  if (!legend.range) return labels;
  const auto [lo, hi, scale] = *legend.range;
  const auto text = [scale = scale](double value) {
    const std::string number =
        scale == Scale::count || value >= 1000 ? tick_text(value, Unit::count) : fmt::format("{:.3g}", value);
    return number + (scale == Scale::metres ? " m" : "");
  };
  for (const Tick& tick : ticks(LogAxis{double{lo}, double{hi}, 0, px(k_ramp_width)}, Unit::count, px(40)))
    labels.emplace_back(shared::ramp_position(static_cast<float>(tick.value), lo, hi, 1u),
                        tick.labelled ? text(tick.value) : "");
  // A scale too short for a round number shows its ends.
  if (std::none_of(labels.begin(), labels.end(), [](const auto& l) { return !l.second.empty(); }))
    labels = {{0.0f, text(double{lo})}, {1.0f, text(double{hi})}};
  return labels;
}

constexpr float k_title = 20, k_ramp = 28, k_mark = 18;  // heights

/// With its title, without the gap to the next legend.
float height_of(const solvers::Legend& legend) {
  float h = px(k_title);
  if (legend.ramp) h += px(k_ramp);
  if (!legend.marks.empty())
    h += legend.marks_in_line ? px(20) : px(k_mark * static_cast<float>(legend.marks.size()) - 2);
  return h;
}

/// Below its title, at `at`.
void draw_below_title(ImDrawList* list, ImVec2 at, const solvers::Legend& legend) {
  if (legend.ramp) {
    ramp_bar(list, at, *legend.ramp, ramp_labels(legend));
    at.y += px(k_ramp);
  }
  float x = at.x;
  for (const solvers::Legend::Mark& mark : legend.marks) {
    if (legend.marks_in_line && x >= at.x + px(k_ramp_width - 24)) break;
    const float end = swatch(list, {x, at.y}, ink(mark.ink), mark.text);
    if (legend.marks_in_line)
      x = end;
    else
      at.y += px(k_mark);
  }
}

}  // namespace

void draw_legend(Ui& ui, const Area& area) {
  const session::Snapshot* s = ui.snapshot.get();
  if (!s || !s->activity.empty()) return;
  // The coarse first image has neither sample counts nor tiles; solvers draw over it too.
  const bool heat = !s->coarse && s->legend.layer != 0, tiles = !s->coarse && s->tiles && s->accuracy;
  std::vector<const solvers::Legend*> legends;
  for (const auto& report : s->reports)
    for (const solvers::Legend& legend : report->legends) legends.push_back(&legend);
  if (!heat && !tiles && legends.empty()) return;
  struct Row {
    uint32_t state;
    std::string name, count;
  };
  std::vector<Row> rows;
  uint32_t heavy = 0;
  if (tiles) {
    const session::Accuracy& a = *s->accuracy;
    for (const session::TileStatus& t : a.tiles) heavy += t.heavy_tailed;
    const auto row = [&](uint32_t state, const char* name, bool always) {
      const uint32_t n = a.count(state);
      if (n > 0 || always) rows.push_back({state, name, count_text(n)});
    };
    row(shared::k_tile_waiting, "before the minimum of samples", false);
    row(shared::k_tile_active, a.adaptive ? "active" : "over the target", true);
    row(shared::k_tile_done, a.adaptive ? "done" : "under the target", true);
    row(shared::k_tile_capped, "stays over the target", false);
  }
  const float line = px(18), pad = px(12);
  const float heat_height = heat ? px(48) : 0;
  const float tiles_height = tiles ? px(50) + line * static_cast<float>(rows.size() + (heavy > 0)) : 0;
  float solver_height = 0;
  for (const solvers::Legend* legend : legends) solver_height += height_of(*legend);
  const float between = px(6) * static_cast<float>(size_t{heat} + size_t{tiles} + legends.size() - 1);
  const float w = px(k_ramp_width) + 2 * pad, h = heat_height + tiles_height + solver_height + pad + between;
  if (h > area.height() - px(24) || w > area.width() - px(24)) return;
  const ImVec2 lo(area.lo.x + px(12), area.hi.y - h - px(12)), hi(lo.x + w, lo.y + h);
  ImDrawList* list = card(lo, hi, 0.92f);
  ImFont* font = theme().fonts.small;
  float y = lo.y + px(6);
  const auto title = [&](const std::string& text) {
    draw_text(list, {lo.x + pad, y}, {hi.x, y + px(16)}, text, colour::text_dim, Align::left, font);
    y += px(20);
  };
  if (heat) {
    title(title_of(s->legend.layer));
    ramp_bar(list, {lo.x + pad, y}, s->legend.ramp, heat_labels(s->legend));
    y += heat_height - px(20) + px(6);
  }
  for (const solvers::Legend* legend : legends) {
    title(legend->title);
    draw_below_title(list, {lo.x + pad, y}, *legend);
    y += height_of(*legend) - px(k_title) + px(6);
  }
  if (!tiles) return;
  const session::Accuracy& a = *s->accuracy;
  title("Tiles: error as seen, estimated");
  std::vector<std::pair<float, std::string>> labels;
  for (const double times : {8.0, 4.0, 2.0, 1.0})
    labels.emplace_back(film::tile_position(times * a.target, a.target),
                        (times == 8 ? "\xE2\x89\xA5 " : "") + tick_text(times * a.target, Unit::relative));
  ramp_bar(list, {lo.x + pad, y}, shared::k_ramp_tiles, labels);
  y += px(28);
  const auto row = [&](const std::string& name, const std::string& count) {
    draw_text(list, {lo.x + pad + px(20), y}, {hi.x, y + line}, name, colour::text_dim, Align::left, font);
    draw_text(list, {lo.x, y}, {hi.x - pad, y + line}, count, colour::text, Align::right, font);
  };
  for (const Row& r : rows) {
    tile_sample(list, {lo.x + pad, y + px(3)}, r.state);
    row(r.name, r.count);
    y += line;
  }
  if (heavy > 0) {
    const ImVec2 corner(lo.x + pad + px(12), y + px(3));
    list->AddRectFilled({corner.x - px(12), corner.y}, {corner.x, corner.y + px(12)}, colour::grey(50));
    list->AddTriangleFilled({corner.x - px(6), corner.y}, corner, {corner.x, corner.y + px(6)}, colour::text);
    row("light in rare large amounts", count_text(heavy));
  }
}

}  // namespace lucerna::ui
