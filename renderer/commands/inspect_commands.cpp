// Commands that inspect solver data at a place of the picture.
#include <algorithm>

#include "base/error.h"
#include "commands/command_list.h"
#include "commands/workspace.h"

namespace lucerna::commands {

void add_inspect_commands(Workspace& work) {
  const auto place = [](const Arguments& a) { return vec2(a.number("right"), a.number("down")); };
  work.registry.add(
      {.name = "inspect.at",
       .help = "Inspects the solvers' data at a point of the picture: the records or photons used there and "
               "their "
               "weights; with overlay.lights the lights that are selected there. A script continues when it "
               "is shown.",
       .parameters = {{.name = "right", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture widths"},
                      {.name = "down", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture heights"}},
       .run =
           [&work, place](const Arguments& a) {
             ++work.inspections;
             work.open.needs_lookup();
             work.session.inspect(place(a), work.open.id());
           },
       .done =
           [&work, place](const Arguments& a) {
             const session::Snapshot* snapshot = work.open.snapshot.get();
             return snapshot &&
                    std::any_of(snapshot->reports.begin(), snapshot->reports.end(),
                                [&](const auto& report) { return report->looked_at == place(a); });
           },
       .recorded = false});
  work.registry.add({.name = "inspect.none",
                     .help = "Ends the inspection.",
                     .parameters = {},
                     .run = [&work](const Arguments&) { work.session.inspect(std::nullopt); },
                     .recorded = false});
}

}  // namespace lucerna::commands
