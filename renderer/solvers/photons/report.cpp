#include "solvers/photons/report.h"

#include <algorithm>

#include "base/figures.h"
#include "shaders/shared/ramp.h"
#include "solvers/photons/info.h"

namespace lucerna::photons {

using namespace solvers;

Report make_report(const PhotonReport& r) {
  Report report;
  report.solver = info().name;
  report.ready = r.ready;
  if (!r.ready) report.preparing = "photons: looking for what bundles light";
  report.state = r.rounds == 0 ? "beginning" : fmt::format("round {}", r.last.round + 1);
  PanelSection map{.title = "Photons", .note = "", .items = {}};
  if (r.lights_power <= 0)
    map.items.push_back(Paragraph{"Nothing in the scene shines, so that there are no photons."});
  else if (!r.sends)
    map.items.push_back(
        Paragraph{"Nothing in the scene reflects or refracts otherwise than diffusely, so that there "
                  "are no caustics: no photons are sent."});
  map.items.push_back(
      ValueRow{"Rounds", count_text(double(r.rounds)), "One for every sample of the picture."});
  map.items.push_back(
      ValueRow{"Paths a round", count_text(r.last.paths), "That began at lights, in the last round."});
  map.items.push_back(ValueRow{"Photons a round", count_text(r.last.photons),
                               "That these left on surfaces, in the last round."});
  map.items.push_back(ValueRow{
      "Stored a path", r.paths > 0 ? real_text(double(r.photons) / double(r.paths), 2) : "\xE2\x80\x93",
      "Photons that a path leaves, on average over the picture's rounds."});
  map.items.push_back(ValueRow{"Left the scene", share_text(double(r.escaped), double(r.paths)),
                               "Of the paths: that met nothing any more."});
  if (r.dark > 0)
    map.items.push_back(ValueRow{"Began in the dark", share_text(double(r.dark), double(r.paths)),
                                 "Of the paths: where a lamp's texture or the sky is black."});
  map.items.push_back(ValueRow{
      "Radius", fmt::format("{} pixels{}", real_text(r.radius_pixels, 2), r.at_floor ? ", the least" : ""),
      "Within which a photon counts, as the camera sees it."});
  if (r.limited)
    map.items.push_back(
        Paragraph{"The radius asked for is wider than photons may be seen, and is held to a quarter of "
                  "their distance.",
                  Tone::warning});
  map.items.push_back(
      ValueRow{"Memory", megabytes_text(double(r.bytes) / 1e6), "Of photons and what finds them."});
  report.sections.push_back(std::move(map));
  report.sections.push_back(
      {.title = "Settings",
       .note = "",
       .items = {OptionRow{"photons.per_round"}, OptionRow{"photons.radius"}, OptionRow{"photons.floor"},
                 OptionRow{"photons.alpha"}, OptionRow{"photons.borders"}, OptionRow{"photons.aim"}}});
  report.sections.push_back(
      {.title = "Over the picture", .note = "", .items = {OptionRow{"overlay.photons"}}});
  if (r.view == shared::k_photons_by_bounce) {
    Legend legend{.title = "surfaces before", .ramp = std::nullopt, .ticks = {}, .range = {}, .marks = {}};
    for (uint32_t bounce = 0; bounce < 6; ++bounce)
      legend.marks.push_back({shared::ramp_hue(bounce), fmt::format("{}{}", bounce, bounce == 5 ? "+" : "")});
    report.legends.push_back(std::move(legend));
  }
  report.figures = {{"rounds", double(r.rounds)},       {"light paths", double(r.paths)},
                    {"photons", double(r.photons)},     {"last photons", double(r.last.photons)},
                    {"escaped", double(r.escaped)},     {"dark", double(r.dark)},
                    {"casters", double(r.casters)},     {"unaimed", r.unaimed},
                    {"radius pixels", r.radius_pixels}, {"bytes", double(r.bytes)}};
  return report;
}

}  // namespace lucerna::photons
