#include "solvers/photons/report.h"

#include <algorithm>
#include <tuple>

#include "base/figures.h"
#include "shaders/shared/ramp.h"
#include "solvers/aim_report.h"
#include "solvers/photons/info.h"

namespace lucerna::photons {

using namespace solvers;
using namespace shared;

namespace {

/// Card for the inspected place.
Card make_card(const Inspected& found) {
  const PhotonInspectHeader& at = found.at;
  Card card;
  const auto add = [&](auto line, Card::Room room = Card::Room::any) { card.lines.push_back({line, room}); };
  const auto row = [&](const char* name, std::string value) { add(Card::Row{name, std::move(value)}); };
  add(Card::Title{count_text(double(at.count)) + (at.count == 1 ? " photon" : " photons"),
                  fmt::format("{} mm", real_text(1e3 * double(at.radius), 2))});
  row("Density", fmt::format("{} per m\u00b2", count_text(double(at.density))));
  row("Irradiance", real_text(double(luminance(at.irradiance)), 3));
  if (at.area < 0.999f) row("Surface in disc", share_text(double(at.area), 1));
  if (found.photons.empty()) return card;
  double sum = 0;
  for (const PhotonInspected& p : found.photons) sum += double(p.contribution);
  add(Card::Rule{}, Card::Room::much);
  const float most = float(double(found.photons[0].contribution) / sum);
  for (size_t i = 0; i < std::min<size_t>(found.photons.size(), 5); ++i) {
    const PhotonInspected& p = found.photons[i];
    const uint32_t events = p.bits >> k_photon_events_shift & k_photon_most_events;
    add(Card::Weight{fmt::format("{}{} bounce{}", events, events == k_photon_most_events ? " or more" : "",
                                 events == 1 ? "" : "s"),
                     float(double(p.contribution) / sum), most},
        Card::Room::much);
  }
  return card;
}

/// What the heat map of densities shows.
const char* density_note(uint32_t of) {
  if (of == k_density_of_photons) return "Colour: photons stored per m\u00b2. Dark: few, or none.";
  if (of == k_density_of_caustics) return "Colour: share of the samples. Elsewhere caustics are path traced.";
  if (of == k_density_of_importance)
    return "Colour: how much the picture depends on photons there. More are sent to bright places.";
  return "Colour: irradiance of the photons, in W/m\u00b2. Dark: little, or none.";
}

/// The radius of rounds 1, 2, 4, ...; those that the picture has had in the accent's ink.
Histogram radius_columns(const PhotonReport& r) {
  constexpr uint32_t k_columns = 13;  // to round 4096
  constexpr vec3 k_had{0.44f, 0.64f, 0.87f}, k_to_come{0.38f, 0.38f, 0.42f};
  Histogram histogram;
  for (uint32_t k = 0; k < k_columns; ++k) {
    const uint32_t round = 1u << k;
    const double radius = r.radius_law.at(round - 1);
    const std::string name = count_text(round);
    histogram.columns.push_back({.height = float(radius / r.radius_law.at(0)),
                                 .ink = round <= r.rounds ? k_had : k_to_come,
                                 .label = name,
                                 .help = fmt::format("Round {}: {} pixels{}.", name, real_text(radius, 2),
                                                     radius <= r.radius_law.floor ? ", the minimum" : "")});
  }
  return histogram;
}

/// Names of components (bits): "secondary and tertiary".
std::string names_of(uint32_t components, bool begins = false) {
  std::string all;
  for (const size_t c : k_components)
    if ((components >> c & 1u) != 0)
      all += (all.empty() ? "" : " and ") + std::string(paths::k_component_names[c]);
  if (begins && !all.empty()) all[0] = char(std::toupper(all[0]));
  return all;
}

}  // namespace

Report make_report(const PhotonReport& r) {
  Report report;
  report.solver = info().name;
  report.ready = r.ready;
  if (!r.ready) report.preparing = "photons: finding lookups, casters and entrances";
  const bool all_delegated = r.tried != 0 && !r.sends_rounds;
  report.state = all_delegated            ? "path traced"
                 : r.maps && r.pieces > 0 ? fmt::format("{} cells", count_text(r.pieces))
                 : r.rounds == 0          ? "beginning"
                                          : fmt::format("round {}", r.last.round + 1);
  PanelSection map{.title = "Photons", .note = "", .items = {}};
  if (r.lights_power <= 0)
    map.items.push_back(Paragraph{"The scene has no light, so there are no photons."});
  else if (!r.sends)
    map.items.push_back(Paragraph{
        "The scene has no specular or glossy surface, so there are no caustics and no photons are traced."});
  if (r.maps)
    map.items.push_back(ValueRow{"Maps", count_text(double(r.rounds)),
                                 "Irradiance maps so far. Each has twice as many paths as the one before and "
                                 "serves twice as many samples."});
  else
    map.items.push_back(ValueRow{"Rounds", count_text(double(r.rounds)), "One per sample of the picture."});
  map.items.push_back(ValueRow{r.maps ? "Paths" : "Paths per round", count_text(r.last.paths),
                               "Light paths of the last one."});
  if (r.last.paths < r.last.wanted)
    map.items.push_back(Paragraph{
        fmt::format("{} light paths are set, but their photons do not fit into one buffer of this device.",
                    count_text(r.last.wanted)),
        Tone::warning});
  map.items.push_back(ValueRow{r.maps ? "Photons" : "Photons per round", count_text(r.last.photons),
                               "Photons stored by these paths."});
  if (r.pieces > 0)
    map.items.push_back(
        ValueRow{"Surface cells", count_text(r.pieces),
                 "Cells of the last map with irradiance. In cells with too few photons paths continue."});
  for (const auto& [part, name, help] :
       {std::tuple{0u, "Primary", "Photons of direct light."},
        {1u, "Secondary", "Photons of light behind one diffuse surface."},
        {2u, "Tertiary", "Photons of light behind several diffuse surfaces."},
        {3u, "Caustic", "Photons of light behind specular surfaces only."}})
    if (r.last.by_part[part] > 0) map.items.push_back(ValueRow{name, count_text(r.last.by_part[part]), help});
  map.items.push_back(ValueRow{
      "Photons per path", r.paths > 0 ? real_text(double(r.photons) / double(r.paths), 2) : "\xE2\x80\x93",
      "Mean number of stored photons per path, over the picture's rounds."});
  if (r.spared > 0)
    map.items.push_back(ValueRow{"Not stored", share_text(double(r.spared), double(r.spared + r.photons)),
                                 "Share of the photons removed by Russian roulette far from lookups."});
  map.items.push_back(ValueRow{"Left the scene", share_text(double(r.escaped), double(r.paths)),
                               "Share of the paths that left the scene."});
  const auto of_round = [&](const char* name, uint64_t n, const char* help) {
    if (n > 0) map.items.push_back(ValueRow{name, share_text(double(n), double(r.last.paths)), help});
  };
  of_round("Ended by roulette", r.last.roulette, "Share of the paths of the last round.");
  of_round(
      "Ended by length", r.last.depth,
      "Share of the paths of the last round that reached the maximum number of events (path.max_depth).");
  if (r.last.paths > 0)
    map.items.push_back(ValueRow{"Rays per path", real_text(double(r.last.rays) / double(r.last.paths), 2),
                                 "Of the last round, including the first ray from the light."});
  if (r.dark > 0)
    map.items.push_back(ValueRow{"Started dark", share_text(double(r.dark), double(r.paths)),
                                 "Share of the paths that started at a black texel of a lamp or the sky."});
  if (!r.maps)
    map.items.push_back(
        ValueRow{"Radius",
                 fmt::format("{} pixels{}", real_text(r.radius_pixels, 2), r.at_floor ? ", the minimum" : ""),
                 "Radius of photons as seen from the camera; below: by round."});
  if (r.sends && !r.maps) map.items.push_back(radius_columns(r));
  if (r.limited && !r.maps)
    map.items.push_back(
        Paragraph{"The radius is limited to a quarter of the distance from the camera.", Tone::warning});
  add_aim_rows(map.items, {r.casters, r.entrances}, r.unaimed, r.aimed);
  if (r.delegated != 0)
    map.items.push_back(
        Paragraph{fmt::format("In the pilot, path tracing of {} light was {}× more efficient, so it is used. "
                              "Turn 'Only where more efficient' off to use photons anyway.",
                              names_of(r.delegated), real_text(r.delegation_gain, 1)),
                  Tone::warning});
  else if (r.tried != 0 && r.ready)
    map.items.push_back(ValueRow{names_of(r.tried, true), "by photons",
                                 "In the pilot, path tracing was not much more efficient."});
  if (r.weighs && r.ready) {
    map.items.push_back(
        ValueRow{"Caustics by photons", share_text(r.by_photons, 1),
                 "Share of the picture; elsewhere path tracing was more efficient in the pilot."});
    if (r.by_photons < 1)
      map.items.push_back(
          ValueRow{"Efficiency gain", fmt::format("{}×", real_text(r.efficiency_gain, 2)),
                   "Estimated efficiency gain for caustics (variance × time) over photons everywhere."});
  }
  const auto rate = [&](const char* name, double n, const char* help) {
    if (n > 0) map.items.push_back(ValueRow{name, count_text(n) + " / s", help});
  };
  rate("Tracing rate", r.emitted_per_s, "Light paths per second of tracing time.");
  rate("Storing rate", r.stored_per_s, "Stored photons per second of tracing time.");
  rate("Sorting rate", r.sorted_per_s, "Photons per second of sorting time.");
  if (r.rounds > 0) {
    map.items.push_back(
        ValueRow{r.maps ? "Tracing time per map" : "Tracing time per round",
                 ms_text(1e3 * r.trace_s / double(r.rounds)),
                 r.maps ? "Mean over the picture's maps." : "Mean over the picture's rounds."});
    map.items.push_back(ValueRow{r.maps ? "Sorting time per map" : "Sorting time per round",
                                 ms_text(1e3 * r.build_s / double(r.rounds)),
                                 "Mean time of sorting photons by cell."});
  }
  map.items.push_back(ValueRow{"Memory", megabytes_text(double(r.bytes) / 1e6),
                               "Memory of photons and their lookup structures."});
  report.sections.push_back(std::move(map));
  report.sections.push_back(
      {.title = "Settings",
       .note = "",
       .items = {OptionRow{"photons.per_round"}, OptionRow{"photons.radius"}, OptionRow{"photons.floor"},
                 OptionRow{"photons.alpha"}, OptionRow{"photons.borders"},
                 OptionRow{"photons.irradiance_map"}, OptionRow{"photons.aim"},
                 OptionRow{"photons.importons"}, OptionRow{"photons.efficiency"}}});
  report.sections.push_back(
      {.title = "Overlays",
       .note = "",
       .items = {OptionRow{"overlay.photons"}, OptionRow{"overlay.photon_density"},
                 OptionRow{"overlay.photon_paths"}, OptionRow{"overlay.photon_paths_of"},
                 OptionRow{"overlay.photon_aim"}}});
  if (r.paths_shown) report.legends.push_back(light_paths_legend());
  if (r.aim_shown && !r.aimed.empty()) report.legends.push_back(aim_legend());
  if (r.view == shared::k_photons_by_flux)
    report.legends.push_back({.title = "Photons, by their light",
                              .note = "Dot: a photon of the last pass, in the colour of its light."});
  if (r.view == shared::k_photons_by_light)
    report.legends.push_back(
        {.title = "Photons, by the light that sent them",
         .note = "Dot: a photon of the last pass. One colour per light; colours repeat."});
  if (r.view == shared::k_photons_by_round)
    report.legends.push_back({.title = "Photons, by pass",
                              .note = "Dot: a photon of the last pass. The colour changes with each pass."});
  if (r.view == shared::k_photons_by_map) {
    Legend legend{
        .title = "Photons, by component", .ramp = std::nullopt, .ticks = {}, .range = {}, .marks = {}};
    for (const auto& [hue, name] :
         {std::pair{0u, "primary"}, {1u, "secondary"}, {2u, "tertiary"}, {3u, "caustic"}})
      legend.marks.push_back({shared::ramp_hue(hue), name});
    legend.note = "Dot: a photon of the last pass. Colour: the component it contributes to.";
    report.legends.push_back(std::move(legend));
  }
  if (r.view == shared::k_photons_by_bounce) {
    Legend legend{
        .title = "Photons, by bounces", .ramp = std::nullopt, .ticks = {}, .range = {}, .marks = {}};
    for (uint32_t bounce = 0; bounce < 6; ++bounce)
      legend.marks.push_back({shared::ramp_hue(bounce), fmt::format("{}{}", bounce, bounce == 5 ? "+" : "")});
    legend.note = "Dot: a photon of the last pass. Colour: surfaces on its path before this one.";
    report.legends.push_back(std::move(legend));
  }
  if (r.density.of > 0 && r.density.hi > 0)
    report.legends.push_back(
        {.title = r.density.of == k_density_of_photons      ? "Photons per m\u00b2, last round"
                  : r.density.of == k_density_of_caustics   ? "Samples whose caustics photons compute"
                  : r.density.of == k_density_of_importance ? "Photon importance"
                                                            : "Irradiance of the last round's photons",
         .ramp = k_ramp_magma,
         .ticks = {},
         .range = Legend::Range{.lo = r.density.lo, .hi = r.density.hi},
         .marks = {},
         .note = density_note(r.density.of)});
  report.looked_at = r.looked_at;
  if (r.inspected) report.card = make_card(*r.inspected);
  report.figures = {{"rounds", double(r.rounds)},
                    {"light paths", double(r.paths)},
                    {"photons", double(r.photons)},
                    {"last photons", double(r.last.photons)},
                    {"last primary", double(r.last.by_part[0])},
                    {"last secondary", double(r.last.by_part[1])},
                    {"last tertiary", double(r.last.by_part[2])},
                    {"last caustic", double(r.last.by_part[3])},
                    {"escaped", double(r.escaped)},
                    {"dark", double(r.dark)},
                    {"spared", double(r.spared)},
                    {"density most", double(r.density.hi)},
                    {"inspected", r.inspected ? double(r.inspected->at.count) : 0},
                    {"casters", double(r.casters)},
                    {"entrances", double(r.entrances)},
                    {"unaimed", r.unaimed},
                    {"by photons", r.by_photons},
                    {"radius pixels", r.radius_pixels},
                    {"bytes", double(r.bytes)}};
  return report;
}

}  // namespace lucerna::photons
