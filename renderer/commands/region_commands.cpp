// Commands that give samples to a region of the picture only.
#include "base/error.h"
#include "commands/command_list.h"
#include "commands/text.h"
#include "commands/workspace.h"
#include "schedule/region.h"

namespace lucerna::commands {

void add_region_commands(Workspace& work) {
  const auto part = [](const char* name, const char* unit) {
    return Parameter{.name = name, .type = Type::real, .lo = 0, .hi = 1, .unit = unit};
  };
  work.registry.add(
      {.name = "region.set",
       .help = "Gives all further samples to a rectangle of the picture (sampling.region); the rest keeps "
               "those it has.",
       .parameters = {part("right", "picture widths"), part("down", "picture heights"),
                      part("width", "picture widths"), part("height", "picture heights")},
       .run =
           [&work](const Arguments& a) {
             work.open.needs_scene();
             const schedule::Region region{a.real("right"), a.real("down"), a.real("width"),
                                           a.real("height")};
             const std::string text = schedule::region_text(region);
             schedule::parse_region(text, "");
             work.run(line("set", "sampling.region", text));
           },
       .recorded = false});
  work.registry.add({.name = "region.clear",
                     .help = "Gives samples to the whole picture again.",
                     .parameters = {},
                     .run =
                         [&work](const Arguments&) {
                           if (work.open.setting("sampling.region").empty())
                             throw Error("", "there is no region");
                           work.run("reset sampling.region");
                         },
                     .recorded = false});
}

}  // namespace lucerna::commands
