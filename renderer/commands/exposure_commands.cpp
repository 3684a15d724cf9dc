// Commands that set the exposure by what the picture holds, and light that comes from a file.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "commands/workspace.h"

namespace lucerna::commands {

void Workspace::add_exposure_commands() {
  const auto share = [](const char* name, const char* unit) {
    return Parameter{.name = name, .type = Type::real, .lo = 0, .hi = 1, .unit = unit};
  };
  const auto done = [this](const Arguments&) {
    if (!measure_failure_.empty()) throw Error("", measure_failure_);
    return !measuring_;
  };
  registry.add({.name = "exposure.find",
                .help =
                    "Sets film.ev for the whole picture: its log-average becomes middle grey, and its bright "
                    "parts are not far above white.",
                .parameters = {},
                .run =
                    [this](const Arguments&) {
                      needs_scene(), needs_view();
                      measure(std::nullopt, false);
                    },
                .done = done,
                .recorded = false});
  registry.add({.name = "exposure.at",
                .help = "Sets film.ev so that a point of the picture is shown as middle grey.",
                .parameters = {share("right", "picture widths"), share("down", "picture heights")},
                .run =
                    [this](const Arguments& a) {
                      needs_scene(), needs_view();
                      measure(vec2(a.number("right"), a.number("down")), false);
                    },
                .done = done,
                .recorded = false});
  registry.add(
      {.name = "environment.load",
       .help = "Replaces the scene's environment by a latitude-longitude image, with its own brightness and "
               "rotation.",
       .parameters = {file_named({".exr", ".hdr"})},
       .run =
           [this](const Arguments& a) {
             std::error_code error;
             if (!std::filesystem::is_regular_file(a.text("file"), error))
               throw Error(a.text("file"),
                           "no such file; expected a latitude-longitude image (.exr or .hdr)");
             needs_scene();
             Document& d = edit();
             d.environment_file = absolute_path(a.text("file")).string();
             d.environment_scale = 1, d.environment_rotation = 0;
           },
       .undoable = true});
  registry.add({.name = "environment.own",
                .help = "Restores the scene's environment, with the brightness and rotation of its file.",
                .parameters = {},
                .run =
                    [this](const Arguments&) {
                      needs_scene();
                      Document& d = edit();
                      d.environment_file.clear();
                      d.environment_scale = own_environment_.first;
                      d.environment_rotation = own_environment_.second;
                    },
                .undoable = true});
}

void Workspace::measure(std::optional<vec2> at, bool of_load) {
  measure_failure_.clear();
  measuring_ = Measuring{session.measure(at, scene_id_), at.has_value(), of_load, view_scene};
}

void Workspace::take_measure() {
  if (exposure_due_ != 0 && exposure_due_ == view_scene && snapshot && !snapshot->rgba.empty() &&
      !measuring_) {
    const std::string& when = setting("film.exposure_at_load");
    if (exposes_at_load() ? when != "never" : when == "always") measure(std::nullopt, true);
    exposure_due_ = 0;
  }
  if (!measuring_ || measuring_->result.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  const Measuring requested = *measuring_;
  measuring_.reset();
  if (requested.scene != view_scene) return;
  try {
    const film::Brightness found = requested.result.get();
    if (!found.ev)
      throw Error("", requested.at_point ? "it is black there: no exposure makes it grey"
                                         : "the picture is black: no exposure shows it");
    // A value that the user has set meanwhile stays.
    if (requested.of_load && setting("film.ev") != plan::find_option("film.ev")->fallback) return;
    const float ev = std::round(*found.ev * 100) / 100;
    if (number_text(ev) == setting("film.ev")) return;
    run(line("set", "film.ev", ev));
    if (requested.of_load)
      measured(fmt::format("The scene names no exposure; {:+.1f} EV was found for it", ev));
    else
      measured(fmt::format("Exposure {:+.2f} EV", ev));
  } catch (const std::exception& error) {
    measure_failure_ = error.what();
    if (!requested.of_load) log::error("exposure: {}", error.what());
  }
}

}  // namespace lucerna::commands
