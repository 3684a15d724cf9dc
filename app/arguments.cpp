#include "app/arguments.h"

#include <fmt/ranges.h>

#include <cmath>

#include "plan/settings.h"

namespace lucerna::app {

std::string Common::command() const { return fmt::format("lucerna {}", fmt::join(typed, " ")); }

CLI::Validator finite() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0;
        return CLI::detail::lexical_cast(text, value) && std::isfinite(value)
                   ? std::string()
                   : fmt::format("'{}': expected a finite number", text);
      },
      "");
}

CLI::Validator named() {
  return CLI::Validator(
      [](std::string& text) {
        return text.empty() ? std::string("'': expected a file name") : std::string();
      },
      "");
}

void Common::complete(VerbArguments& arguments) const {
  if (arguments.device.empty()) arguments.device = device;
  arguments.scenes = scenes;
  arguments.command = command();
}

void add_scene_options(CLI::App& verb, Common& common) {
  verb.add_flag("--allow-outside", common.scenes.outside,
                "allow scenes to read files outside their folder (\"..\", absolute paths, symbolic links)");
  verb.add_option("--scene-memory", common.scene_gib,
                  "memory limit in GiB for a scene's files, images and geometry, counting every instance; "
                  "larger scenes are refused")
      ->check(finite() & CLI::Range(0.001, 1e6))
      ->capture_default_str();
}

std::string settings_help() {
  std::string text = "\nSettings for --set KEY=VALUE (and settings.json beside a scene):\n";
  for (const OptionInfo& o : plan::options()) {
    const std::string range = describe_values(o);
    text +=
        fmt::format("  {:<24}{} [{}] {}\n", o.key, o.help, o.fallback.empty() ? "none" : o.fallback, range);
  }
  return text;
}

}  // namespace lucerna::app
