// Commands that send the picture to another viewer.
#include <memory>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
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
  const auto opener = std::make_shared<std::unique_ptr<film::TevSender>>();
  const auto opens_at = std::make_shared<std::string>();
  work.registry.add(
      {.name = "tev.open",
       .help = "Opens a file, such as a saved EXR, in a running tev, or reads it again there.",
       .parameters = {file_named({".exr", ".png", ".hdr"}),
                      {.name = "address",
                       .help =
                           "HOST:PORT with a host in digits; by default that of tev.send, or 127.0.0.1:14158",
                       .optional = true}},
       .run =
           [&work, opener, opens_at](const Arguments& a) {
             if (!file_exists(a.text("file"))) throw Error(a.text("file"), "there is no such file");
             const std::string known = work.open.snapshot ? work.open.snapshot->tev : "";
             const film::TevAddress address =
                 film::parse_tev_address(a.has("address") ? a.text("address") : known, "");
             if (!*opener || *opens_at != address.text() || (*opener)->ended()) {
               *opener = std::make_unique<film::TevSender>(
                   address, "", 5, [](const std::string& problem) { log::error("{}", problem); });
               *opens_at = address.text();
             }
             (*opener)->open(absolute_path(a.text("file")).string());
           },
       .done = [opener](const Arguments&) { return !*opener || !(*opener)->busy(); },
       .recorded = false});
}

}  // namespace lucerna::commands
