#include "solvers/light_tracing/report.h"

#include "base/figures.h"
#include "solvers/aim_report.h"
#include "solvers/light_tracing/info.h"

namespace lucerna::light_tracing {

using namespace solvers;

Report make_report(const LightTracingReport& r) {
  Report report;
  report.solver = info().name;
  report.ready = r.ready;
  if (!r.ready) report.preparing = "light tracing: finding casters";
  report.state = r.rounds == 0 ? "beginning" : fmt::format("round {}", r.last.round + 1);
  PanelSection section{.title = "Light tracing", .note = "", .items = {}};
  auto& items = section.items;
  if (r.lights_power <= 0)
    items.push_back(Paragraph{"The scene has no light, so no paths are traced."});
  else if (!r.sends)
    items.push_back(Paragraph{
        "The scene has no specular or glossy surface, so there are no caustics and no paths are traced."});
  items.push_back(ValueRow{"Rounds", count_text(double(r.rounds)), "One per sample of the picture."});
  items.push_back(ValueRow{"Paths per round", count_text(r.last.paths), "Light paths of the last round."});
  items.push_back(
      ValueRow{"Connections", count_text(double(r.joined)),
               "Vertices in view that were connected to the camera; shadow rays test their visibility."});
  items.push_back(
      ValueRow{"Lit pixels", count_text(r.last.pixels), "Pixels that received light in the last round."});
  if (r.paths > 0) {
    items.push_back(ValueRow{"Left the scene", share_text(double(r.escaped) / double(r.paths), 1),
                             "Share of the paths that left the scene before a diffuse event."});
    if (r.dark > 0)
      items.push_back(ValueRow{"Dark", share_text(double(r.dark) / double(r.paths), 1),
                               "Share of the paths that started at black texels of their light."});
  }
  add_aim_rows(items, {r.casters, 0}, r.unaimed, r.aimed);
  if (r.sent_per_s > 0)
    items.push_back(ValueRow{"Tracing rate", count_text(r.sent_per_s) + " / s",
                             "Light paths per second of tracing time."});
  items.push_back(
      ValueRow{"Memory", megabytes_text(double(r.bytes) / 1e6), "Memory of the sums of light, by pixel."});
  report.sections.push_back(std::move(section));
  report.sections.push_back(
      {.title = "Settings", .note = "", .items = {OptionRow{"light.per_round"}, OptionRow{"light.aim"}}});
  report.sections.push_back({.title = "Overlays",
                             .note = "",
                             .items = {OptionRow{"overlay.light_paths"}, OptionRow{"overlay.light_paths_of"},
                                       OptionRow{"overlay.light_aim"}}});
  if (r.paths_shown) report.legends.push_back(light_paths_legend());
  if (r.aim_shown && !r.aimed.empty()) report.legends.push_back(aim_legend());
  report.figures = {
      {"rounds", double(r.rounds)},   {"light paths", double(r.paths)},  {"joined", double(r.joined)},
      {"escaped", double(r.escaped)}, {"dark", double(r.dark)},          {"casters", double(r.casters)},
      {"unaimed", r.unaimed},         {"pixels", double(r.last.pixels)}, {"bytes", double(r.bytes)}};
  return report;
}

}  // namespace lucerna::light_tracing
