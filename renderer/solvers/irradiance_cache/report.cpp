#include "solvers/irradiance_cache/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/figures.h"
#include "shaders/shared/irradiance_cache/placement_view.h"
#include "shaders/shared/ramp.h"
#include "solvers/irradiance_cache/build_forecast.h"
#include "solvers/irradiance_cache/info.h"

namespace lucerna::irradiance_cache {
namespace {

using namespace solvers;
using Items = std::vector<PanelItem>;

constexpr size_t k_passes_shown = 16;   // frequent camera moves add many
constexpr size_t k_weights_shown = 6;   // on the card
constexpr size_t k_least_columns = 13;  // of the histogram

/// Key of a command in the window.
char key_of(const char* command) { return find_command(info(), command)->shortcut; }

const CachePass* last_pass(const CacheStatus& s) { return s.passes.empty() ? nullptr : &s.passes.back(); }

std::string preparing(const CacheReport& r) {
  const CacheStatus& s = r.status;
  if (s.stop != StopReason::building) return "";
  if (s.waits && s.last) return fmt::format("cache waits: {}", stage_words(*s.last));
  if (s.relighting.records > 0)
    return fmt::format("cache: relighting {} records, {:.0f} %", s.relighting.records,
                       100 * s.relighting.share);
  if (r.placed == 0) return fmt::format("cache, pass {}: choosing places for records", s.pass + 1);
  return fmt::format("cache, pass {}: {} records", s.pass + 1, r.placed);
}

// The panel.

void add_overlap_rows(Items& items, const std::optional<Overlap>& overlap) {
  if (!overlap || overlap->pixels == 0) {
    for (const char* name : {"Overlap", "Gathered by paths", "Pixels without records"})
      items.push_back(
          ValueRow{name, k_dash, "Available after the first samples of the picture.", Tone::faint});
    return;
  }
  const Overlap& o = *overlap;
  items.push_back(ValueRow{"Overlap", fmt::format("{:.1f} on average, {} at most", o.mean, o.most),
                           "Records that serve a pixel, over the pixels with at least one record."});
  items.push_back(ValueRow{"Gathered by paths", share_text(double(o.gathered), double(o.pixels)),
                           "Pixels near edges, where light is not interpolated: paths gather it and end in "
                           "records one vertex later (cache.gather)."});
  items.push_back(ValueRow{"Pixels without records",
                           share_text(double(o.pixels - o.served - o.gathered), double(o.pixels)),
                           "Pixels with a diffuse surface that no record serves; they are path traced."});
}

/// Histogram of the number of records that serve a pixel, in the colours of the overlay.
Histogram overlap_columns(const Overlap& o) {
  const std::vector<uint32_t>& bins = o.histogram;
  size_t used = 1;
  for (size_t i = 0; i < bins.size(); ++i)
    if (bins[i] > 0) used = std::max(used, i + 1);
  const uint32_t most = std::max(1u, *std::max_element(bins.begin(), bins.end()));
  Histogram histogram;
  for (size_t i = 0; i < std::min(std::max(used, k_least_columns), bins.size()); ++i) {
    const std::string n = i + 1 == bins.size() ? fmt::format("\xE2\x89\xA5{}", i) : fmt::format("{}", i);
    Histogram::Column column{
        .height = float(bins[i]) / float(most),
        .ink = shared::ramp_color(shared::k_ramp_viridis, float(i) / shared::k_overlap_scale),
        .label = n,
        .help = fmt::format("{} of the pixels: served by {} record{}.", share_text(bins[i], double(o.pixels)),
                            i == 0 ? "no" : n, i == 1 ? "" : "s")};
    if (i == 0) {
      column.ink = shared::k_unserved_ink;
      column.lower = bins[0] > 0 ? float(o.gathered) / float(bins[0]) : 0;
      column.lower_ink = shared::k_gathered_ink;
      column.help +=
          fmt::format(" In {} paths gather the light.", share_text(double(o.gathered), double(o.pixels)));
    }
    histogram.columns.push_back(std::move(column));
  }
  return histogram;
}

PanelSection numbers(const CacheReport& r, const OptionValues& settings, const std::string& state) {
  const CacheStatus& s = r.status;
  PanelSection section{.title = info().label, .note = state, .items = {}};
  Items& items = section.items;
  items.push_back(ValueRow{"Records", fmt::format("{} of {}", count_text(s.records), count_text(r.room)),
                           "Complete records, and their maximum number (cache.max_records)."});
  items.push_back(ValueRow{
      "Passes", fmt::format("{} of {}", s.pass, settings.text("cache.passes")),
      "Complete passes since building began or the camera moved, and their maximum number (cache.passes)."});
  uint64_t rays = 0;  // of complete records
  for (const CachePass& p : s.passes) rays += p.complete ? p.rays : 0;
  items.push_back(ValueRow{"Rays of records",
                           s.records > 0 ? fmt::format("{}, {} each", amount_text(double(s.rays)),
                                                       count_text(std::round(double(rays) / s.records)))
                                         : amount_text(double(s.rays)),
                           "Rays over the records' hemispheres, and their mean per record; later rays of "
                           "their paths not included."});
  items.push_back(
      ValueRow{"Memory", megabytes_text(double(s.bytes) / (1 << 20)),
               fmt::format("Device memory, allocated for the maximum number of records: {} bytes per record, "
                           "and the octree, whose leaves list a record {:.1f} times on average.",
                           shared::k_record_bytes, s.references)});
  add_overlap_rows(items, r.overlap);
  if (const CachePass* last = last_pass(s))
    items.push_back(
        ValueRow{"New candidates, last pass", share_text(double(last->uncovered), double(last->paths)),
                 fmt::format("{} of {} paths found no record, {} of them behind the first surface. Building "
                             "stops when at most {:.2f} % find none.",
                             count_text(double(last->uncovered)), count_text(double(last->paths)),
                             count_text(double(last->uncovered_world)), 100 * settings.real("cache.stop"))});
  items.push_back(Gap{4});
  if (s.waits)
    items.push_back(Paragraph{fmt::format("Building is paused: {} runs the next stage, {} all stages.",
                                          key_of("step"), key_of("run")),
                              Tone::accent});
  else if (s.stop == StopReason::building)
    items.push_back(Paragraph{"Still building\xE2\x80\xA6", Tone::accent});
  else
    items.push_back(Paragraph{fmt::format("Building has stopped: {}.", words(s.stop)),
                              s.stop == StopReason::covered ? Tone::dim : Tone::warning});
  if (r.overlap && r.overlap->pixels > 0) items.push_back(overlap_columns(*r.overlap));
  return section;
}

/// Controls and figures of the stages of building.
PanelSection steps(const CacheReport& r) {
  const CacheStatus& s = r.status;
  PanelSection section{.title = "Stages of building", .note = "", .items = {}};
  Items& items = section.items;
  items.push_back(ChoiceButtons{.key = "cache.pause",
                                .labels = {"No pause", "Each pass", "Each stage"},
                                .short_labels = {"Off", "Pass", "Stage"},
                                .help = "R builds it again."});
  items.push_back(Gap{4});
  const bool building = s.stop == StopReason::building;
  items.push_back(CommandButtons{
      {{.command = "step",
        .help = building ? "Runs the next stage and pauses."
                         : "The cache is complete. R builds it again; a camera move adds missing records.",
        .enabled = building},
       {.command = "run",
        .help = building ? "Builds without a pause until the cache is complete." : "The cache is complete.",
        .enabled = building}}});
  items.push_back(Gap{8});
  StepStrip strip{.steps = {}, .last = s.last ? int(s.last->stage) : -1};
  for (const StepText& text : k_stage_texts) strip.steps.push_back({text.name, text.help});
  items.push_back(std::move(strip));
  if (s.last) {
    const StageDone& last = *s.last;
    items.push_back(ValueRow{s.waits ? "Paused after" : "Last stage", stage_words(last),
                             "The most recent complete stage of building.",
                             s.waits ? Tone::accent : Tone::normal});
    items.push_back(
        ValueRow{"Duration",
                 last.rays > 0 ? fmt::format("{}, {} rays", ms_text(last.ms), amount_text(double(last.rays)))
                               : ms_text(last.ms),
                 "Device time, and wall time of host work; rays of records."});
  } else {
    items.push_back(ValueRow{"Last stage", k_dash, "No stage of building is complete yet.", Tone::faint});
    items.push_back(ValueRow{"Duration", k_dash, "", Tone::faint});
  }
  const CachePass* pass = last_pass(s);
  const auto count = [&](const char* name, double n, bool known, const char* help) {
    items.push_back(ValueRow{name, known ? count_text(n) : k_dash, help, known ? Tone::normal : Tone::faint});
  };
  const bool chosen = pass && pass->clusters > 0;
  count("Candidates", pass ? double(pass->uncovered) : 0, pass != nullptr,
        "Paths of this pass that found no record.");
  count("Clusters", pass ? pass->clusters : 0, chosen, "Clusters of the candidates.");
  count("Tried", pass ? pass->tried : 0, chosen, "Candidates drawn from the clusters and measured.");
  count("Chosen", pass ? pass->records : 0, pass && pass->records > 0,
        "Tried candidates that became records.");
  return section;
}

PanelSection overlays(const OptionValues& settings) {
  PanelSection section{.title = "Overlays",
                       .note = "",
                       .items = {ViewButtons{{"overlay.records", "overlay.overlap", "overlay.normals"}},
                                 Gap{4}, OptionRow{"overlay.records_by"}, OptionRow{"overlay.placement"},
                                 OptionRow{"overlay.discontinuity"}}};
  if (settings.text("overlay.discontinuity") != "off")
    section.items.push_back(OptionRow{"overlay.discontinuity_level"});
  for (const char* view : {"overlay.records", "overlay.overlap", "overlay.normals"}) {
    if (!settings.boolean(view)) continue;
    section.items.push_back(Gap{4});
    section.items.push_back(
        Paragraph{"Rest the pointer on the picture to see which records serve there.", Tone::faint});
    break;
  }
  return section;
}

/// One row per pass: its results and time.
Table passes(const CacheStatus& s) {
  Table table{.columns = {"", "records", "candidates", "rays", "time"}, .droppable = 3, .rows = {}};
  uint32_t most = 1;
  for (const CachePass& p : s.passes) most = std::max(most, p.records);
  const size_t from = s.passes.size() > k_passes_shown ? s.passes.size() - k_passes_shown : 0;
  for (size_t i = from; i < s.passes.size(); ++i) {
    const CachePass& p = s.passes[i];
    std::string help = fmt::format(
        "Pass {}: {} of {} paths found no record, {} of them behind the first surface; {} records placed "
        "with {} rays.",
        i + 1, count_text(double(p.uncovered)), count_text(double(p.paths)),
        count_text(double(p.uncovered_world)), count_text(p.records), count_text(double(p.rays)));
    for (size_t k = 0; k < p.ms.size(); ++k)
      help += fmt::format("\n{}: {}", k_step_texts[k].name, ms_text(p.ms[k]));
    table.rows.push_back({.cells = {fmt::format("{}", i + 1), p.records > 0 ? count_text(p.records) : k_dash,
                                    share_text(double(p.uncovered), double(p.paths)),
                                    p.rays > 0 ? amount_text(double(p.rays)) : k_dash, ms_text(p.total_ms())},
                          .bar = float(p.records) / float(most),
                          .ink = p.records > 0 ? std::optional(shared::ramp_hue(p.number)) : std::nullopt,
                          .tone = p.complete ? Tone::normal : Tone::accent,
                          .help = std::move(help)});
  }
  return table;
}

/// Time of each step of building.
void add_times(Items& items, const CacheStatus& s) {
  std::array<double, k_build_steps.size()> ms{};
  double total = 0;
  for (const CachePass& p : s.passes) {
    for (size_t i = 0; i < ms.size(); ++i) ms[i] += p.ms[i];
    total += p.total_ms();
  }
  items.push_back(ValueRow{"Time of building", ms_text(total),
                           "Device time of all passes, and wall time of host work (including its tracer)."});
  Parts parts;
  for (size_t i = 0; i < ms.size(); ++i)
    parts.parts.push_back({.name = k_step_texts[i].name,
                           .value = ms_text(ms[i]),
                           .help = k_step_texts[i].help,
                           .share = total > 0 ? float(ms[i] / total) : 0,
                           .host = i == size_t(BuildStep::choose)});
  items.push_back(std::move(parts));
}

// Legends.

void add_origins(Legend& legend) {
  for (uint32_t i = 0; i < k_origins.size(); ++i) legend.marks.push_back({shared::ramp_hue(i), k_origins[i]});
}

/// Colour legend of records.
Legend record_legend(const CacheReport& r) {
  Legend legend;
  switch (r.color) {
    case shared::k_record_by_pass: {
      legend.title = "Records, by the pass that placed them";
      uint32_t most = 0;
      for (const CachePass& p : r.status.passes)
        if (p.records > 0) most = std::max(most, p.number);
      for (uint32_t i = 0; i <= most; ++i)
        legend.marks.push_back({shared::ramp_hue(i), fmt::format("{}", i + 1)});
      legend.note = "Ring: where a record is valid. Colour: the pass of building that placed it.";
      return legend;
    }
    case shared::k_record_by_origin:
      legend.title = "Records, by the origin of their candidate";
      add_origins(legend);
      legend.note = "Ring: where a record is valid. Colour: the lookup that found no record there.";
      return legend;
    case shared::k_record_by_rays:
      legend.title = "Records, by their rays";
      legend.note = "Ring: where a record is valid. Colour: rays traced for its irradiance.";
      break;
    case shared::k_record_by_distance:
      legend.title = "Records, by the mean distance they see";
      legend.note =
          "Ring: where a record is valid. Colour: harmonic mean distance of the surfaces around, in metres.";
      break;
    default:
      legend.title = "Records, by their error (irradiance)";
      legend.note = "Ring: where a record is valid. Colour: standard error of its irradiance, in W/m\u00b2.";
  }
  legend.ramp = shared::k_ramp_viridis;
  legend.range =
      Legend::Range{.lo = r.scale.first,
                    .hi = r.scale.second,
                    .unit = r.color == shared::k_record_by_rays       ? Legend::Range::Unit::count
                            : r.color == shared::k_record_by_distance ? Legend::Range::Unit::metres
                                                                      : Legend::Range::Unit::plain};
  return legend;
}

/// Legend of the states of places.
Legend placement_legend(const CacheReport& r) {
  Legend legend;
  const CachePass* pass = last_pass(r.status);
  const auto counted = [&](const char* name, uint32_t n) {
    return pass ? fmt::format("{} {}", count_text(n), name) : std::string(name);
  };
  if (r.placement == PlacementShow::candidates) {
    legend.title = "Candidates, by origin";
    add_origins(legend);
    legend.note = "Dot: a place where a lookup found no record. Colour: the lookup.";
  } else if (r.placement == PlacementShow::clusters) {
    legend.title = "Candidates, by their cluster";
    constexpr uint32_t k_inks = 5;
    for (uint32_t i = 0; i < k_inks; ++i)
      legend.marks.push_back({shared::placed_cluster_ink(i),
                              i + 1 < k_inks ? "" : counted("clusters", pass ? pass->clusters : 0)});
    legend.marks.push_back({shared::k_tried_ink, counted("tried", pass ? pass->tried : 0)});
    legend.note = "Dots of one colour: a cluster of candidates. Few of each cluster are tried.";
  } else {
    legend.title = "Tried places with their radii";
    if (pass && pass->records > 0) {
      legend.marks.push_back({shared::k_chosen_ink, counted("chosen", pass->records)});
      legend.marks.push_back({shared::k_rejected_ink, counted("rejected", pass->tried - pass->records)});
    } else {
      legend.marks.push_back({shared::k_tried_ink, counted("tried", pass ? pass->tried : 0)});
    }
    legend.note =
        "Ring: where the record of a place would be valid. Rejected places lie too close to others.";
  }
  return legend;
}

/// Number of records that serve a pixel.
Legend overlap_legend() {
  Legend legend{.title = "Records that serve a pixel", .ramp = shared::k_ramp_viridis};
  constexpr auto most = static_cast<int>(shared::k_overlap_scale);
  for (const int n : {1, 4, 8, most})
    legend.ticks.push_back({static_cast<float>(n) / shared::k_overlap_scale,
                            (n == most ? "\xE2\x89\xA5 " : "") + fmt::format("{}", n)});
  legend.marks = {{shared::k_gathered_ink, "none: paths gather there"},
                  {shared::k_unserved_ink, "none: path traced"}};
  legend.marks_in_line = false;
  legend.note = "Colour: how many records each pixel interpolates.";
  return legend;
}

/// Detail of geometry or irradiance in a cell.
Legend detail_legend(const std::string& of, int64_t level) {
  return {.title = fmt::format("Detail of {}, cells of {} pixel{}", of, 1u << level, level == 0 ? "" : "s"),
          .ramp = shared::k_ramp_magma,
          .ticks = {{0.0f, "0 flat"}, {0.25f, "0.25"}, {0.5f, "0.5"}, {0.75f, "0.75"}, {1.0f, "1 full"}},
          .note = "Share of the most detail a cell can have; more candidates are drawn where it is high."};
}

std::vector<Legend> legends(const CacheReport& r, const OptionValues& settings) {
  std::vector<Legend> list;
  if (settings.boolean("overlay.records") || settings.boolean("overlay.normals")) {
    list.push_back(record_legend(r));
    if (settings.boolean("overlay.normals")) list.back().note += " Line: its normal.";
  }
  if (r.placement != PlacementShow::off) list.push_back(placement_legend(r));
  if (settings.boolean("overlay.overlap")) list.push_back(overlap_legend());
  if (const std::string& of = settings.text("overlay.discontinuity"); of != "off")
    list.push_back(detail_legend(of, settings.integer("overlay.discontinuity_level")));
  return list;
}

// The card.

std::string vector_text(const vec3& v, int decimals) {
  return fmt::format("{}  {}  {}", real_text(double{v.x}, decimals), real_text(double{v.y}, decimals),
                     real_text(double{v.z}, decimals));
}

/// In five characters, whatever the magnitude.
std::string figure_text(float v) {
  const float a = std::abs(v);
  if (v == 0 || (a >= 100 && a < 1e5f)) return fmt::format("{:.0f}", v);
  if (a >= 0.0095f && a < 100) return fmt::format("{:.{}f}", v, a >= 10 ? 1 : a >= 1 ? 2 : 3);
  const int power = static_cast<int>(std::floor(std::log10(a)));
  return fmt::format("{:.0f}e{}", double{v} / std::pow(10.0, power), power);
}

/// Length of the luminance gradient.
float gradient_length(const std::array<vec3, 3>& by_channel) {
  return glm::length(0.2126f * by_channel[0] + 0.7152f * by_channel[1] + 0.0722f * by_channel[2]);
}

/// Fields of the record whose disc covers the pixel.
void add_fields(Card& card, const Covering& under) {
  const Record& r = under.record;
  using Room = Card::Room;
  const auto add = [&](auto line) { card.lines.push_back({std::move(line), Room::much}); };
  const auto row = [&](const char* name, std::string value) { add(Card::Row{name, std::move(value)}); };
  const std::string name = fmt::format("Record {}", count_text(under.index));
  card.lines.push_back({Card::Title{name, metres_text(r.radius)}, Room::little});
  add(Card::Title{name, fmt::format("pass {} \xC2\xB7 {}", r.pass + 1,
                                    k_origins[std::min<size_t>(r.place.origin, k_origins.size() - 1)])});
  row("Position", vector_text(r.place.position, 3) + " m");
  row("Normal", vector_text(r.place.normal, 3));
  row("Radius", r.lesser_radius < r.radius
                    ? fmt::format("{} x {}", metres_text(r.lesser_radius), metres_text(r.radius))
                    : metres_text(r.radius));
  row("Mean distance (harmonic)", metres_text(r.mean_distance));
  row("Least distance", metres_text(r.least_distance));
  row("Rays", count_text(r.rays));
  vec3 sum(0);
  for (const Irradiance& e : r.parts) sum += e.value;
  const float bright = luminance(sum);
  row("Standard error",
      bright > 0 ? fmt::format("{} ({:.1f} %)", figure_text(r.error), 100 * double{r.error / bright})
                 : figure_text(r.error));
  if (!r.crowded)
    row("Luminance, smoothed", fmt::format("{}, {}", figure_text(bright), figure_text(under.read)));
  add(Card::Rule{.line = false});
  add(Card::FigureHeads{"Irradiance", {"R", "G", "B", "/rad", "/m"}});
  // Parts have the numbers of components, except the first: sky light, which is primary.
  static constexpr std::array<const char*, shared::k_part_count> k_parts{"environm.", "secondary", "tertiary",
                                                                         "caustic"};
  bool any = false;
  for (uint32_t p = 0; p < shared::k_part_count; ++p) {
    const Irradiance& e = r.parts[p];
    if (e.value == vec3(0)) continue;
    any = true;
    add(Card::Figures{
        int(p),
        k_parts[p],
        e.value,
        {figure_text(e.value.x), figure_text(e.value.y), figure_text(e.value.z),
         figure_text(gradient_length(e.rotation)), figure_text(gradient_length(e.translation))}});
  }
  if (!any) add(Card::Note{r.crowded ? "none: paths gather here" : "no light", Tone::faint});
  add(Card::Rule{.line = true});
}

/// Records that serve there, with their weights.
void add_weights(Card& card, const Inspection& found, bool building) {
  const auto note = [&](std::string text, Tone tone = Tone::dim) {
    card.lines.push_back({Card::Note{std::move(text), tone}});
  };
  if (found.lookup == shared::k_lookup_none) return note("Not diffuse: no lookup here.");
  if (found.lookup == shared::k_lookup_too_steep) {
    note("The normal map is too steep for records.", Tone::warning);
    return note("Path traced here.", Tone::warning);
  }
  if (found.gathers) {
    note("Near an edge: not interpolated.");
    return note("Paths gather the light here.");
  }
  if (found.count == 0)
    return note(building ? "No record serves here yet." : "No record serves here: path traced.",
                building ? Tone::dim : Tone::warning);
  note(fmt::format("Served by {} record{}", found.count, found.count == 1 ? "" : "s"));
  // A single remaining record is shown instead of a summary.
  const size_t shown = found.serving.size() <= k_weights_shown + 1 ? found.serving.size() : k_weights_shown;
  for (size_t i = 0; i < shown; ++i)
    card.lines.push_back({Card::Weight{count_text(found.serving[i].record), found.serving[i].weight,
                                       found.serving[0].weight}});
  if (shown >= found.count) return;
  float rest = 0;
  for (size_t i = shown; i < found.serving.size(); ++i) rest += found.serving[i].weight;
  card.lines.push_back({Card::Row{fmt::format("and {} more", found.count - shown),
                                  fmt::format("{:.1f} %", 100 * double{rest})}});
}

}  // namespace

solvers::Report make_report(const CacheReport& data, const OptionValues& settings) {
  const CacheStatus& s = data.status;
  const bool building = s.stop == StopReason::building;
  Report report{.solver = info().name, .ready = !building, .waits = s.waits};
  if (s.waits) report.to_go_on = "building of the cache is paused (cache.pause); cache.run continues";
  report.preparing = preparing(data);
  if (data.refines) report.refining = "refining records";
  if (const auto left = forecast_of(s, settings.real("cache.stop")); left && !s.waits)
    report.progress = {left->done, left->left_ms};
  report.state = s.waits ? "waits" : building ? "building" : "complete";
  report.sections = {numbers(data, settings, report.state), steps(data), overlays(settings)};
  if (!s.passes.empty()) {
    PanelSection section{.title = "Passes of building", .note = "", .items = {passes(s), Gap{8}}};
    add_times(section.items, s);
    report.sections.push_back(std::move(section));
  }
  report.legends = legends(data, settings);
  report.looked_at = data.looked_at;
  if (const Inspection& found = data.inspection; data.looked_at && found.solid) {
    report.card.emplace();
    if (found.under) add_fields(*report.card, *found.under);
    add_weights(*report.card, found, building);
  }
  report.figures = {{"records", s.records},
                    {"room", data.room},
                    {"rays", double(s.rays)},
                    {"pass", s.pass},
                    {"bytes", double(s.bytes)},
                    {"stage", s.last ? double(s.last->stage) : -1},
                    {"uncovered", double(s.probed.uncovered)},
                    {"paths", double(s.probed.paths)}};
  if (data.overlap) {
    report.figures.emplace_back("overlap", data.overlap->mean);
    report.figures.emplace_back("overlap_most", data.overlap->most);
  }
  return report;
}

}  // namespace lucerna::irradiance_cache
