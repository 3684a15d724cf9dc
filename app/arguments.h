#pragma once
// Declares the arguments of the batch verbs (CLI11) and runs the one that was given.
#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/verbs.h"
#include "scene/io/load.h"

namespace lucerna::app {

/// What all verbs share.
struct Common {
  std::string device;  ///< --device before the verb; "": the default
  scene::LoadOptions scenes;
  double scene_gib = 0;            ///< --scene-memory
  std::vector<std::string> typed;  ///< the program's arguments, without its name

  /// "lucerna bench --quick": the program's name and its arguments.
  std::string command() const;
  /// Completes a verb's arguments by these; its own device has priority.
  void complete(VerbArguments& arguments) const;
};

struct Verb {
  CLI::App* app;             ///< with its options
  std::function<int()> run;  ///< returns the exit status; throws Error
  std::string footer = {};   ///< below its help
};

/// Runs a verb with its arguments, completed by `common`.
template <class Arguments>
std::function<int()> runs(int (*verb)(const Arguments&), std::shared_ptr<Arguments> arguments,
                          const Common& common) {
  return [verb, arguments, &common] {
    common.complete(*arguments);
    return verb(*arguments);
  };
}

inline constexpr const char* k_device_help =
    "device: index, part of a name, cpu or gpu (also LUCERNA_DEVICE)";

/// Rejects NaN, which CLI11's ranges accept.
CLI::Validator finite();
/// Rejects an empty name, which is usually an unset shell variable.
CLI::Validator named();
void add_scene_options(CLI::App& verb, Common& common);
/// The settings for --set, one line each.
std::string settings_help();

// The verbs, by file. `common` must outlive them; it is read when they run.
Verb add_render(CLI::App& app, Common& common);
std::vector<Verb> add_scene_verbs(CLI::App& app, Common& common);   ///< info, convert, devices
std::vector<Verb> add_result_verbs(CLI::App& app);                  ///< compare, paths
std::vector<Verb> add_script_verbs(CLI::App& app, Common& common);  ///< script, help
/// bench, after its own verbs: rays, latency, photons, interiors, auto.
std::vector<Verb> add_bench_verbs(CLI::App& app, Common& common);
/// interiors, auto; of `bench`.
std::vector<Verb> add_rooms_benches(CLI::App& bench, Common& common);

}  // namespace lucerna::app
