// Commands that choose the display and view of an OpenColorIO configuration.
#include <fmt/ranges.h>

#include "base/error.h"
#include "commands/command_list.h"
#include "commands/text.h"
#include "commands/workspace.h"
#include "film/io/ocio.h"

namespace lucerna::commands {
namespace {

/// Displays, or the views of one; none without a configuration that can be read.
std::vector<std::string> ocio_names(const std::vector<std::string>& before) {
  std::vector<std::string> names;
  try {
    const auto config = film::ocio_config();
    if (!config) return names;
    for (const film::OcioDisplay& display : config->displays())
      if (before.empty())
        names.push_back(display.name);
      else if (display.name == before.front())
        return display.views;
  } catch (const Error&) {
    return names;
  }
  if (before.empty()) names.emplace_back("off");
  return names;
}

}  // namespace

void add_ocio_commands(Workspace& work) {
  work.registry.add(
      {.name = "view.ocio",
       .help = "Shows the picture by a display and a view of the OpenColorIO configuration that the "
               "environment variable OCIO names, in place of the tone curve (film.ocio); off: by the tone "
               "curve.",
       .parameters = {{.name = "display", .help = "or off", .names = ocio_names},
                      {.name = "view",
                       .help = "by default the display's default view",
                       .optional = true,
                       .names = ocio_names}},
       .run =
           [&work](const Arguments& a) {
             work.open.needs_scene();
             const std::string &display = a.text("display"), view = a.has("view") ? a.text("view") : "";
             if (display == "off" && view.empty()) {
               work.run("reset film.ocio");
               return;
             }
             const auto config = film::ocio_config();
             if (!config)
               throw Error("", "the environment variable OCIO names no configuration; start Lucerna with it");
             config->show(display, view, {});
             work.run(line("set", "film.ocio", film::ocio_text(display, view)));
           },
       .recorded = false});
}

}  // namespace lucerna::commands
