// Commands that send the picture to another viewer.
#include "base/error.h"
#include "commands/command_list.h"
#include "commands/workspace.h"
#include "film/io/tev.h"

namespace lucerna::commands {

void add_viewer_commands(Workspace& work) {
  work.registry.add(
      {.name = "tev.send",
       .help = "Sends all layers to a running tev, or a viewer with its protocol, when the samples have "
               "doubled, at most once a second, and at the end. Rendering never waits for the viewer.",
       .parameters = {{.name = "address",
                       .help = "HOST:PORT with a host in digits; by default 127.0.0.1:14158",
                       .optional = true}},
       .run =
           [&work](const Arguments& a) {
             work.open.needs_scene();
             const std::string address = a.has("address") ? a.text("address") : "";
             film::parse_tev_address(address, "");
             work.session.send_to_tev(address);
           },
       .recorded = false});
  work.registry.add({.name = "tev.stop",
                     .help = "Ends tev.send.",
                     .parameters = {},
                     .run = [&work](const Arguments&) { work.session.send_to_tev(std::nullopt); },
                     .recorded = false});
}

}  // namespace lucerna::commands
