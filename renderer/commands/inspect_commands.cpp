// Commands that inspect solver data at a place of the picture.
#include <algorithm>

#include "base/error.h"
#include "commands/workspace.h"

namespace lucerna::commands {

void Workspace::add_inspect_commands() {
  const auto place = [](const Arguments& a) { return vec2(a.number("right"), a.number("down")); };
  registry.add(
      {.name = "inspect.at",
       .help = "Inspects the solvers' data at a point of the picture: the records or photons used there and "
               "their "
               "weights; with overlay.lights the lights that are selected there. A script continues when it "
               "is shown.",
       .parameters = {{.name = "right", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture widths"},
                      {.name = "down", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture heights"}},
       .run =
           [this, place](const Arguments& a) {
             ++inspections;
             needs_lookup();
             session.inspect(place(a), scene_id_);
           },
       .done =
           [this, place](const Arguments& a) {
             return snapshot &&
                    std::any_of(snapshot->reports.begin(), snapshot->reports.end(),
                                [&](const auto& report) { return report->looked_at == place(a); });
           },
       .recorded = false});
  registry.add({.name = "inspect.none",
                .help = "Ends the inspection.",
                .parameters = {},
                .run = [this](const Arguments&) { session.inspect(std::nullopt); },
                .recorded = false});
}

}  // namespace lucerna::commands
