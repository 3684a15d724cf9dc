// Commands that ask what solvers hold at a place of the picture.
#include <algorithm>

#include "base/error.h"
#include "commands/workspace.h"

namespace lucerna::commands {

void Workspace::add_inspect_commands() {
  const auto place = [](const Arguments& a) { return vec2(a.number("right"), a.number("down")); };
  registry.add(
      {.name = "inspect.at",
       .help = "Shows what the solvers that are looked up hold at a point of the picture: what of it serves "
               "there, and how much each counts; with overlay.lights the lights that are chosen there. A "
               "script goes on when it is shown.",
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
                .help = "Ends inspect.at.",
                .parameters = {},
                .run = [this](const Arguments&) { session.inspect(std::nullopt); },
                .recorded = false});
}

}  // namespace lucerna::commands
