// Commands that measure what the scene's effects cost.
#include <fmt/format.h>

#include "commands/command_list.h"
#include "commands/open_scene.h"

namespace lucerna::commands {

void add_effect_commands(Registry& registry, const OpenScene& open) {
  registry.add(
      {.name = "effects.measure",
       .help = "Measures what each effect of the scene costs per sample and contributes, by tracing small "
               "pictures without it. The picture waits meanwhile. A script continues when it is done; the "
               "section Effects shows them.",
       .parameters = {time_limit()},
       .run =
           [&open](const Arguments&) {
             open.needs_scene();
             open.session.measure_effects(open.id());
           },
       .done =
           [&open](const Arguments&) {
             return open.up_to_date() && open.snapshot && !open.snapshot->measures_effects;
           },
       .recorded = false});
  registry.add({.name = "effects.stop",
                .help = "Ends effects.measure without a result.",
                .parameters = {},
                .run = [&open](const Arguments&) { open.session.stop_measuring_effects(); },
                .recorded = false});
}

}  // namespace lucerna::commands
