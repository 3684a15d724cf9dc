// The legend of what lies over the picture, at its lower left: the ramp of a heat map, the states of tiles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart.h"
#include "film/overlay.h"
#include "shaders/shared/irradiance_cache/placement_view.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

constexpr float k_ramp_width = 248, k_ramp_height = 8;

ImU32 ramp_ink(uint32_t ramp, float t) {
  const vec3 c = shared::ramp_color(ramp, t);
  return IM_COL32(static_cast<int>(255 * c.x + 0.5f), static_cast<int>(255 * c.y + 0.5f),
                  static_cast<int>(255 * c.z + 0.5f), 255);
}

/// The ramp from left to right, with labels under the given places (0..1).
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
  float taken = at.x - px(8);  // up to where there are labels
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
  if (layer == shared::k_layer_samples) return "Samples a pixel";
  if (layer == shared::k_layer_error) return "Relative error, estimated, of 8 \xC3\x97 8 pixels";
  return "Device time a pixel";
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

ImU32 ink_of(const vec3& encoded) {
  return IM_COL32(static_cast<int>(255 * encoded.x + 0.5f), static_cast<int>(255 * encoded.y + 0.5f),
                  static_cast<int>(255 * encoded.z + 0.5f), 255);
}

/// A square of a colour and what it stands for; returns the x behind it.
float swatch(ImDrawList* list, const ImVec2& at, ImU32 ink, const std::string& name) {
  ImFont* font = theme().fonts.small;
  list->AddRectFilled({at.x, at.y + px(3)}, {at.x + px(10), at.y + px(13)}, ink, px(2));
  const float end = at.x + px(14) + text_width(name, font);
  draw_text(list, {at.x + px(14), at.y}, {end + px(2), at.y + px(16)}, name, colour::text, Align::left, font);
  return end + px(10);
}

/// What records are coloured by; `at` is below the title.
void record_inks(ImDrawList* list, const ImVec2& at, const session::CacheReport& r) {
  float x = at.x;
  if (r.color == shared::k_record_by_pass) {
    uint32_t most = 0;
    for (const auto& p : r.status.passes)
      if (p.records > 0) most = std::max(most, p.number);
    for (uint32_t i = 0; i <= most && x < at.x + px(k_ramp_width - 24); ++i)
      x = swatch(list, {x, at.y}, ink_of(shared::ramp_hue(i)), fmt::format("{}", i + 1));
    return;
  }
  if (r.color == shared::k_record_by_origin) {
    for (uint32_t i = 0; i < std::size(irradiance_cache::k_origins); ++i)
      x = swatch(list, {x, at.y}, ink_of(shared::ramp_hue(i)), irradiance_cache::k_origins[i]);
    return;
  }
  std::vector<std::pair<float, std::string>> labels;
  const auto [lo, hi] = r.scale;
  const auto text = [&](double value) {
    if (r.color == shared::k_record_by_rays) return tick_text(value, Unit::count);
    return fmt::format("{:.3g}{}", value, r.color == shared::k_record_by_distance ? " m" : "");
  };
  for (const Tick& tick : ticks(LogAxis{double{lo}, double{hi}, 0, px(k_ramp_width)}, Unit::count, px(40)))
    labels.emplace_back(shared::ramp_position(static_cast<float>(tick.value), lo, hi, 1u),
                        tick.labelled ? text(tick.value) : "");
  // A scale too short for a round number shows its ends.
  if (std::none_of(labels.begin(), labels.end(), [](const auto& l) { return !l.second.empty(); }))
    labels = {{0.0f, text(double{lo})}, {1.0f, text(double{hi})}};
  ramp_bar(list, at, shared::k_ramp_viridis, labels);
}

const char* record_title(uint32_t color) {
  switch (color) {
    case shared::k_record_by_pass:
      return "Records, by the pass that placed them";
    case shared::k_record_by_origin:
      return "Records, by what asked for them";
    case shared::k_record_by_rays:
      return "Records, by their rays";
    case shared::k_record_by_distance:
      return "Records, by the mean distance they see";
    default:
      return "Records, by their error (irradiance)";
  }
}

/// How many records serve a pixel.
void overlap_inks(ImDrawList* list, const ImVec2& at) {
  std::vector<std::pair<float, std::string>> labels;
  for (const int n : {1, 4, 8, static_cast<int>(shared::k_overlap_scale)})
    labels.emplace_back(
        static_cast<float>(n) / shared::k_overlap_scale,
        (n == static_cast<int>(shared::k_overlap_scale) ? "\xE2\x89\xA5 " : "") + fmt::format("{}", n));
  ramp_bar(list, at, shared::k_ramp_viridis, labels);
  swatch(list, {at.x, at.y + px(28)}, ink_of(shared::k_gathered_ink), "none: paths gather there");
  swatch(list, {at.x, at.y + px(46)}, ink_of(shared::k_unserved_ink), "none: path traced");
}

/// What has become of places; returns the title, draws below it when there is a list.
const char* placement_title(irradiance_cache::PlacementShow drawn) {
  switch (drawn) {
    case irradiance_cache::PlacementShow::candidates:
      return "Candidates, by what asks for a record";
    case irradiance_cache::PlacementShow::clusters:
      return "Candidates, by their cluster";
    default:
      return "Places that were tried, with their radii";
  }
}

void placement_inks(ImDrawList* list, const ImVec2& at, const session::CacheReport& r) {
  float x = at.x;
  const irradiance_cache::CachePass* pass = r.status.passes.empty() ? nullptr : &r.status.passes.back();
  if (r.placement == irradiance_cache::PlacementShow::candidates) {
    for (uint32_t i = 0; i < std::size(irradiance_cache::k_origins); ++i)
      x = swatch(list, {x, at.y}, ink_of(shared::ramp_hue(i)), irradiance_cache::k_origins[i]);
    return;
  }
  const auto counted = [&](const char* name, uint32_t n) {
    return pass ? fmt::format("{} {}", count_text(n), name) : std::string(name);
  };
  if (r.placement == irradiance_cache::PlacementShow::clusters) {
    for (uint32_t i = 0; i < 5; ++i) {
      list->AddRectFilled({x, at.y + px(3)}, {x + px(10), at.y + px(13)},
                          ink_of(shared::placed_cluster_ink(i)), px(2));
      x += px(12);
    }
    const std::string text = counted("clusters", pass ? pass->clusters : 0);
    draw_text(list, {x + px(2), at.y}, {x + px(120), at.y + px(16)}, text, colour::text, Align::left,
              theme().fonts.small);
    x += px(14) + text_width(text, theme().fonts.small);
    swatch(list, {x, at.y}, ink_of(shared::k_tried_ink), counted("tried", pass ? pass->tried : 0));
    return;
  }
  const bool thinned = pass && pass->records > 0;
  if (thinned) x = swatch(list, {x, at.y}, ink_of(shared::k_chosen_ink), counted("chosen", pass->records));
  swatch(
      list, {x, at.y}, ink_of(thinned ? shared::k_rejected_ink : shared::k_tried_ink),
      thinned ? counted("rejected", pass->tried - pass->records) : counted("tried", pass ? pass->tried : 0));
}

/// How much geometry or irradiance changes in a cell.
void discontinuity_inks(ImDrawList* list, const ImVec2& at) {
  ramp_bar(list, at, shared::k_ramp_magma,
           {{0.0f, "0 flat"}, {0.25f, "0.25"}, {0.5f, "0.5"}, {0.75f, "0.75"}, {1.0f, "1 full"}});
}

std::string discontinuity_title(const std::string& of, uint32_t level) {
  return fmt::format("Detail of {}, cells of {} pixel{}", of, 1u << level, level == 0 ? "" : "s");
}

}  // namespace

void draw_legend(Ui& ui, const Area& area) {
  const session::Snapshot* s = ui.snapshot.get();
  if (!s || !s->activity.empty() || (s->coarse && !s->cache)) return;
  const bool heat = !s->coarse && s->legend.layer != 0, tiles = !s->coarse && s->tiles && s->accuracy;
  const session::CacheReport* cache = s->cache.get();
  const bool records = cache && (ui.setting_on("overlay.records") || ui.setting_on("overlay.normals"));
  const bool overlap = cache && ui.setting_on("overlay.overlap");
  const bool placement = cache && cache->placement != irradiance_cache::PlacementShow::off;
  const std::string detail = cache ? ui.setting("overlay.discontinuity") : "off";
  const bool detailed = detail != "off";
  if (!heat && !tiles && !records && !overlap && !placement && !detailed) return;
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
    row(shared::k_tile_active, a.adaptive ? "at work" : "over the target", true);
    row(shared::k_tile_done, a.adaptive ? "done" : "under the target", true);
    row(shared::k_tile_capped, "stays over the target", false);
  }
  const float line = px(18), pad = px(12);
  const float heat_height = heat ? px(48) : 0;
  const float tiles_height = tiles ? px(50) + line * static_cast<float>(rows.size() + (heavy > 0)) : 0;
  const bool numbered = records && cache->color <= shared::k_record_by_origin;
  const float records_height = records ? px(numbered ? 40 : 48) : 0, overlap_height = overlap ? px(82) : 0,
              placement_height = placement ? px(40) : 0, detail_height = detailed ? px(48) : 0;
  const float between =
      px(6) * static_cast<float>(heat + tiles + records + overlap + placement + detailed - 1);
  const float w = px(k_ramp_width) + 2 * pad, h = heat_height + tiles_height + records_height +
                                                  overlap_height + placement_height + detail_height + pad +
                                                  between;
  if (h > area.height() - px(24) || w > area.width() - px(24)) return;
  const ImVec2 lo(area.lo.x + px(12), area.hi.y - h - px(12)), hi(lo.x + w, lo.y + h);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(lo, hi, colour::with_alpha(colour::bar, 0.92f), px(3));
  list->AddRect(lo, hi, colour::hairline, px(3));
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
  if (records) {
    title(record_title(cache->color));
    record_inks(list, {lo.x + pad, y}, *cache);
    y += records_height - px(20) + px(6);
  }
  if (placement) {
    title(placement_title(cache->placement));
    placement_inks(list, {lo.x + pad, y}, *cache);
    y += placement_height - px(20) + px(6);
  }
  if (overlap) {
    title("Records that serve a pixel");
    overlap_inks(list, {lo.x + pad, y});
    y += overlap_height - px(20) + px(6);
  }
  if (detailed) {
    title(discontinuity_title(detail, static_cast<uint32_t>(ui.setting_real("overlay.discontinuity_level"))));
    discontinuity_inks(list, {lo.x + pad, y});
    y += detail_height - px(20) + px(6);
  }
  if (!tiles) return;
  const session::Accuracy& a = *s->accuracy;
  title("Tiles: relative error, estimated");
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
