// Commands that ask what a solver holds at a place of the picture.
#include "base/error.h"
#include "commands/workspace.h"

namespace lucerna::commands {

void Workspace::add_inspect_commands() {
  const auto place = [](const Arguments& a) { return vec2(a.number("right"), a.number("down")); };
  registry.add(
      {.name = "inspect.records",
       .help =
           "Shows which records of the irradiance cache serve a point of the picture, with their weights, "
           "and the fields of the record in whose disc it lies; a script goes on when they are shown.",
       .parameters = {{.name = "right", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture widths"},
                      {.name = "down", .type = Type::real, .lo = 0, .hi = 1, .unit = "picture heights"}},
       .run =
           [this, place](const Arguments& a) {
             needs_cache();
             session.inspect(place(a));
           },
       .done =
           [this, place](const Arguments& a) {
             return snapshot && snapshot->cache && snapshot->cache->looked_at == place(a);
           },
       .recorded = false});
  registry.add({.name = "inspect.none",
                .help = "Ends inspect.records.",
                .parameters = {},
                .run = [this](const Arguments&) { session.inspect(std::nullopt); },
                .recorded = false});
}

}  // namespace lucerna::commands
