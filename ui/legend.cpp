// The legend of what lies over the picture, at its lower left: the layer shown, what solvers have drawn
// (solvers::Legend), marks of lights, the states of tiles. Each says in words what is drawn and what its
// colours mean.
#include "legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "chart.h"
#include "film/tile_scale.h"
#include "shaders/shared/preview.h"
#include "shaders/shared/ramp.h"
#include "shown_lines.h"
#include "shown_text.h"
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

/// A square of a colour and its meaning.
void swatch(ImDrawList* list, const ImVec2& at, ImU32 colour, const std::string& name) {
  ImFont* font = theme().fonts.small;
  list->AddRectFilled({at.x, at.y + px(3)}, {at.x + px(10), at.y + px(13)}, colour, px(2));
  if (name.empty()) return;
  const float end = at.x + px(16) + text_width(name, font);
  draw_text(list, {at.x + px(14), at.y}, {end, at.y + px(16)}, name, colour::text, Align::left, font);
}

/// Places of marks in lines, from the corner of the first: marks with names go on in the next line; of
/// colours without names only those of the first line are shown.
std::vector<ImVec2> places_in_lines(const std::vector<solvers::Legend::Mark>& marks) {
  std::vector<ImVec2> places;
  ImVec2 at(0, 0);
  for (const solvers::Legend::Mark& mark : marks) {
    const bool named = !mark.text.empty();
    const float width = named ? px(14) + text_width(mark.text, theme().fonts.small) : px(10);
    if (at.x > 0 && at.x + width > px(k_ramp_width)) {
      if (!named) break;
      at = {0, at.y + px(18)};
    }
    places.push_back(at);
    at.x += width + px(named ? 10.0f : 2.0f);
  }
  return places;
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

constexpr float k_title = 20, k_ramp = 28, k_mark = 18, k_between = 8;  // heights

/// Without title and note.
float body_height(const solvers::Legend& legend) {
  float h = legend.ramp ? px(k_ramp) : 0;
  if (!legend.marks.empty())
    h += legend.marks_in_line ? places_in_lines(legend.marks).back().y + px(20)
                              : px(k_mark * static_cast<float>(legend.marks.size()));
  return h;
}

void draw_body(ImDrawList* list, ImVec2 at, const solvers::Legend& legend) {
  if (legend.ramp) {
    ramp_bar(list, at, *legend.ramp, ramp_labels(legend));
    at.y += px(k_ramp);
  }
  if (legend.marks_in_line) {
    const std::vector<ImVec2> places = places_in_lines(legend.marks);
    for (size_t i = 0; i < places.size(); ++i)
      swatch(list, {at.x + places[i].x, at.y + places[i].y}, ink(legend.marks[i].ink), legend.marks[i].text);
    return;
  }
  for (const solvers::Legend::Mark& mark : legend.marks) {
    swatch(list, at, ink(mark.ink), mark.text);
    at.y += px(k_mark);
  }
}

/// The legend of one thing: a title, what draws itself at a place below it, and a sentence.
struct Block {
  std::string title, note;
  float body = 0;  ///< height
  std::function<void(ImDrawList*, const ImVec2&)> draw;

  float note_height() const {
    if (note.empty()) return 0;
    const ImFont* font = theme().fonts.small;
    return font->CalcTextSizeA(font->FontSize, 1e9f, px(k_ramp_width), note.c_str()).y + px(4);
  }
  float height(bool notes) const { return px(k_title) + body + (notes ? note_height() : 0); }
};

Block heat_block(const session::Legend& legend) {
  const HeatWords words = heat_words(legend.layer);
  return {words.title, words.note, px(k_ramp), [legend](ImDrawList* list, const ImVec2& at) {
            ramp_bar(list, at, legend.ramp, heat_labels(legend));
          }};
}

/// The error of tiles, and how many are in which state.
Block tiles_block(const session::Accuracy& a) {
  struct Row {
    uint32_t state;
    std::string name, count;
  };
  std::vector<Row> rows;
  uint32_t heavy = 0;
  for (const session::TileStatus& t : a.tiles) heavy += t.heavy_tailed;
  const auto add = [&](uint32_t state, const char* name, bool always) {
    const uint32_t n = a.count(state);
    if (n > 0 || always) rows.push_back({state, name, count_text(n)});
  };
  add(shared::k_tile_waiting, "before the minimum of samples", false);
  add(shared::k_tile_active, a.adaptive ? "at work" : "over the target", true);
  add(shared::k_tile_done, a.adaptive ? "done" : "under the target", true);
  add(shared::k_tile_capped, "stays over the target", false);
  const float line = px(18);
  const auto draw = [rows, heavy, line, target = a.target](ImDrawList* list, const ImVec2& at) {
    std::vector<std::pair<float, std::string>> labels;
    for (const double times : {8.0, 4.0, 2.0, 1.0})
      labels.emplace_back(film::tile_position(times * target, target),
                          (times == 8 ? "\xE2\x89\xA5 " : "") + tick_text(times * target, Unit::relative));
    ramp_bar(list, at, shared::k_ramp_tiles, labels);
    float y = at.y + px(k_ramp);
    ImFont* font = theme().fonts.small;
    const auto row = [&](const std::string& name, const std::string& count) {
      const ImVec2 lo(at.x + px(20), y), hi(at.x + px(k_ramp_width), y + line);
      draw_text(list, lo, hi, name, colour::text_dim, Align::left, font);
      draw_text(list, lo, hi, count, colour::text, Align::right, font);
      y += line;
    };
    for (const Row& r : rows) {
      tile_sample(list, {at.x, y + px(3)}, r.state);
      row(r.name, r.count);
    }
    if (heavy == 0) return;
    const ImVec2 corner(at.x + px(12), y + px(3));
    list->AddRectFilled({corner.x - px(12), corner.y}, {corner.x, corner.y + px(12)}, colour::grey(50));
    list->AddTriangleFilled({corner.x - px(6), corner.y}, corner, {corner.x, corner.y + px(6)}, colour::text);
    row("light in rare large amounts", count_text(heavy));
  };
  return {
      "Tiles: error as seen, estimated",
      "Colour of an outline: the tile's error relative to the light around it; at the right end, the target.",
      px(k_ramp) + line * static_cast<float>(rows.size() + (heavy > 0)), draw};
}

}  // namespace

HeatWords heat_words(uint32_t layer) {
  if (layer == shared::k_layer_samples)
    return {"Samples per pixel", "Dark: few. Bright: as many as a pixel may take; balanced: twice the mean."};
  if (layer == shared::k_layer_error)
    return {"Error as seen, estimated",
            "Of squares of 8 \xC3\x97 8 pixels, relative to the light around them. Middle of the scale: the "
            "target error."};
  return {"Device time per pixel", "Time that the paths of a pixel took. Middle of the scale: the mean."};
}

std::vector<solvers::Legend> window_legends(const session::Legend& layer, bool light_marks, bool former) {
  std::vector<solvers::Legend> list;
  if (layer.layer == shared::k_layer_albedo)
    list.push_back({.title = "Albedo",
                    .note = "Share of the light that the first surface reflects, by colour. Black: none. "
                            "White: all."});
  if (layer.layer == shared::k_layer_normal)
    list.push_back({.title = "Normal",
                    .marks = {{{1, 0.5f, 0.5f}, "+x"}, {{0.5f, 1, 0.5f}, "+y, up"}, {{0.5f, 0.5f, 1}, "+z"}},
                    .note = "Direction that the first surface faces, in the scene's axes."});
  if (layer.layer == shared::k_layer_depth)
    list.push_back({.title = "Depth",
                    .marks = {{vec3(0), "0 m"}, {vec3(1), fmt::format("{:.3g} m or farther", layer.hi)}},
                    .note = "Distance of the first surface along the view. White too: no surface."});
  if (light_marks)
    list.push_back({.title = "Lights",
                    .note =
                        "Circle: lamp. Square: emitting surface. Cross: aim of the selected spot. Filled: "
                        "on. Where many lie together, the nearest are marked."});
  if (former)
    list.push_back({.title = "Light from before the edit",
                    .marks = {{shared::k_preview_former_tint, "not replaced yet"}},
                    .note = "The new light replaces it where it is less noisy, or clearly different."});
  return list;
}

Area draw_legend(const commands::OpenScene& open, bool light_marks, const Area& frame, const Area& room) {
  const session::Snapshot& picture = *open.snapshot;
  if (!picture.activity.empty() || picture.rgba.empty()) return {};
  std::vector<Block> blocks;
  // The coarse first image has neither samples to be counted nor tiles; solvers draw over it too.
  if (!picture.coarse && picture.legend.layer >= shared::k_layer_samples)
    blocks.push_back(heat_block(picture.legend));
  const std::vector<solvers::Legend> own =
      window_legends(picture.legend, light_marks, open.setting_on("overlay.former") && shows_former(picture));
  std::vector<solvers::Legend> of_layer;
  for (const session::LayerStatus& layer : picture.layers)
    if (layer.name == open.setting("film.layer"))
      of_layer.push_back(
          {.title = layer.name,
           .note = fmt::format(
               "Light of the paths {}.{}{}", layer.expression,
               picture.coarse ? " It appears with the first sample." : "",
               layer.lacks.empty() ? "" : " Part of its " + layer.lacks + " light is not known.")});
  const auto add = [&](const solvers::Legend& legend) {
    blocks.push_back({legend.title, legend.note, body_height(legend),
                      [&legend](ImDrawList* list, const ImVec2& at) { draw_body(list, at, legend); }});
  };
  std::for_each(own.begin(), own.end(), add);
  std::for_each(of_layer.begin(), of_layer.end(), add);
  for (const auto& report : picture.reports)
    std::for_each(report->legends.begin(), report->legends.end(), add);
  if (!picture.coarse && picture.tiles && picture.accuracy) blocks.push_back(tiles_block(*picture.accuracy));
  if (blocks.empty()) return {};

  const float pad = px(12), edge = px(12), w = px(k_ramp_width) + 2 * pad;
  const auto height = [&](size_t count, bool notes) {
    float h = pad;
    for (size_t i = 0; i < count; ++i) h += blocks[i].height(notes) + (i > 0 ? px(k_between) : 0);
    return h;
  };
  // In the corner of the picture, or of the room around a small one; without sentences, then without the
  // last blocks, where there is no room for all.
  const auto fits = [&](const Area& area, float h) {
    return h + 2 * edge <= area.height() && w + 2 * edge <= area.width();
  };
  const Area& area = fits(frame, height(blocks.size(), true)) ? frame : room;
  const bool notes = fits(area, height(blocks.size(), true));
  size_t shown = blocks.size();
  while (shown > 0 && !fits(area, height(shown, notes))) --shown;
  if (shown == 0) return {};
  const float h = height(shown, notes);
  const ImVec2 lo(area.lo.x + edge, area.hi.y - h - edge);
  ImDrawList* list = card(lo, {lo.x + w, lo.y + h}, 0.92f);
  ImFont* font = theme().fonts.small;
  ImVec2 at(lo.x + pad, lo.y + px(6));
  for (size_t i = 0; i < shown; ++i) {
    const Block& block = blocks[i];
    draw_text(list, at, {lo.x + w - pad, at.y + px(16)}, block.title, colour::text, Align::left, font);
    block.draw(list, {at.x, at.y + px(k_title)});
    if (notes && !block.note.empty()) {
      ShownLines::instance().note(block.note);
      list->AddText(font, font->FontSize, {at.x, at.y + px(k_title) + block.body}, colour::text_dim,
                    block.note.c_str(), nullptr, px(k_ramp_width));
    }
    at.y += block.height(notes) + px(k_between);
  }
  return {lo, {lo.x + w, lo.y + h}};
}

}  // namespace lucerna::ui
