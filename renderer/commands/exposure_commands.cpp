// Commands that set the exposure by what the picture holds, and environments from files.
#include <filesystem>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "commands/command_list.h"
#include "commands/exposure.h"

namespace lucerna::commands {

void add_exposure_commands(Registry& registry, const OpenScene& open, const Navigation& camera,
                           Exposure& exposure) {
  const auto share = [](const char* name, const char* unit) {
    return Parameter{.name = name, .type = Type::real, .lo = 0, .hi = 1, .unit = unit};
  };
  const auto done = [&exposure](const Arguments&) { return exposure.done(); };
  registry.add({.name = "exposure.find",
                .help =
                    "Sets film.ev for the whole picture: its log-average becomes middle grey, and its bright "
                    "parts are not far above white.",
                .parameters = {},
                .run =
                    [&open, &camera, &exposure](const Arguments&) {
                      open.needs_scene(), camera.needs_view();
                      exposure.measure(std::nullopt);
                    },
                .done = done,
                .recorded = false});
  registry.add({.name = "exposure.at",
                .help = "Sets film.ev so that a point of the picture is shown as middle grey.",
                .parameters = {share("right", "picture widths"), share("down", "picture heights")},
                .run =
                    [&open, &camera, &exposure](const Arguments& a) {
                      open.needs_scene(), camera.needs_view();
                      exposure.measure(vec2(a.number("right"), a.number("down")));
                    },
                .done = done,
                .recorded = false});
}

void add_environment_file_commands(Registry& registry, OpenScene& open) {
  registry.add(
      {.name = "environment.load",
       .help = "Replaces the scene's environment by a latitude-longitude image, with its own brightness and "
               "rotation.",
       .parameters = {file_named({".exr", ".hdr"})},
       .run =
           [&open](const Arguments& a) {
             std::error_code error;
             if (!std::filesystem::is_regular_file(a.text("file"), error))
               throw Error(a.text("file"),
                           "no such file; expected a latitude-longitude image (.exr or .hdr)");
             open.needs_scene();
             Document& d = open.edit();
             d.environment_file = absolute_path(a.text("file")).string();
             d.sky.reset();
             d.environment_scale = 1, d.environment_rotation = 0;
           },
       .undoable = true});
  registry.add({.name = "environment.own",
                .help = "Restores the scene's environment, with the brightness and rotation of its file.",
                .parameters = {},
                .run =
                    [&open](const Arguments&) {
                      open.needs_scene();
                      Document& d = open.edit();
                      d.environment_file.clear(), d.sky.reset();
                      std::tie(d.environment_scale, d.environment_rotation) = open.own_environment();
                    },
                .undoable = true});
}

}  // namespace lucerna::commands
