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
  if (!r.ready) report.preparing = "light tracing: what bundles light";
  report.state = r.rounds == 0 ? "beginning" : fmt::format("round {}", r.last.round + 1);
  PanelSection section{.title = "Light tracing", .note = "", .items = {}};
  auto& items = section.items;
  if (r.lights_power <= 0)
    items.push_back(Paragraph{"Nothing in the scene shines, so that no paths begin."});
  else if (!r.sends)
    items.push_back(
        Paragraph{"Nothing in the scene reflects or refracts otherwise than diffusely, so that "
                  "there are no caustics: no paths are sent."});
  items.push_back(ValueRow{"Rounds", count_text(double(r.rounds)), "One for every sample of the picture."});
  items.push_back(
      ValueRow{"Paths a round", count_text(r.last.paths), "That began at lights, in the last round."});
  items.push_back(ValueRow{"Joined", count_text(double(r.joined)),
                           "Vertices in the picture's view that have been joined to the camera: what lay "
                           "between has been found by shadow rays."});
  items.push_back(
      ValueRow{"Pixels lit", count_text(r.last.pixels), "That the last round has brought light to."});
  if (r.paths > 0) {
    items.push_back(ValueRow{"Left the scene", share_text(double(r.escaped) / double(r.paths), 1),
                             "Of the paths, before they were scattered diffusely."});
    if (r.dark > 0)
      items.push_back(ValueRow{"Dark", share_text(double(r.dark) / double(r.paths), 1),
                               "Of the paths: begun where their light has none, in its texture or map."});
  }
  add_aim_rows(items, {r.casters, 0}, r.unaimed, r.aimed);
  if (r.sent_per_s > 0)
    items.push_back(ValueRow{"Sent", count_text(r.sent_per_s) + " / s",
                             "Paths from lights a second of the time in which they are traced."});
  items.push_back(
      ValueRow{"Memory", megabytes_text(double(r.bytes) / 1e6), "Of what light is summed in, by pixel."});
  report.sections.push_back(std::move(section));
  report.sections.push_back(
      {.title = "Settings", .note = "", .items = {OptionRow{"light.per_round"}, OptionRow{"light.aim"}}});
  report.sections.push_back({.title = "Over the picture",
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
