// Parses the command line and runs the verb, or opens the window.
#include "app/program.h"

#include <algorithm>
#include <cstdio>

#include "app/arguments.h"
#include "app/interrupt.h"
#include "base/huge_pages.h"
#include "base/log.h"
#include "commands/script.h"
#include "ui/viewer.h"

namespace lucerna::app {
namespace {

constexpr double k_gib = 1024.0 * 1024 * 1024;

struct WindowArguments {
  std::string scene, script;
  std::vector<std::string> set;
  bool stay = false;
};

void add_window(CLI::App& app, WindowArguments& window) {
  app.add_option("SCENE", window.scene, "glTF scene (.gltf or .glb) to open in the window");
  app.add_option("--set", window.set, "window: KEY=VALUE; see below")->allow_extra_args(false);
  app.add_option("--script", window.script,
                 "window: file with commands, one per line; 'help' in the console lists them. After its "
                 "last line the program ends, with 1 after an error")
      ->check(named());
  app.add_flag("--stay", window.stay, "window: keep it open after the script");
}

int open_window(const WindowArguments& window, const Common& common) {
  // From here on, so that saves in progress finish and the window's state is saved.
  const Interrupt interrupt;
  ui::ViewerOptions options;
  options.scene = window.scene;
  options.set = window.set;
  options.stay = window.stay;
  if (!window.script.empty()) {
    options.script = commands::read_script(window.script);
    if (options.script.empty()) options.script.emplace_back();  // an empty script ends too
    options.script_name = window.script;
  }
  // A script does not depend on the time that anything takes.
  const auto made = session::start_session(
      {.device = common.device,
       .validation = false,
       .shaders = {},
       .scenes = common.scenes,
       .patience = options.script.empty() ? std::optional(session::k_patience) : std::nullopt});
  session::Session& session = *made;
  options.interrupted = [&] { return interrupt.signal() != 0; };
  const int status = ui::run_viewer(session, options);
  return interrupt.signal() ? interrupt.status() : status;
}

/// The verbs' own verbs before their parents: that is the order in which they are looked for.
std::vector<Verb> add_verbs(CLI::App& app, Common& common) {
  std::vector<Verb> verbs{add_render(app, common)};
  for (const auto& more : {add_scene_verbs(app, common), add_result_verbs(app), add_script_verbs(app, common),
                           add_bench_verbs(app, common)})
    verbs.insert(verbs.end(), more.begin(), more.end());
  app.require_subcommand(0, 1);
  // Footers come last: a new verb inherits the footer of its parent.
  app.footer(settings_help());
  for (const Verb& verb : verbs)
    if (!verb.footer.empty()) verb.app->footer(verb.footer);
  return verbs;
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"Lucerna: interactive lookdev viewer for global illumination, component by component",
               "lucerna"};
  Common common;
  common.scene_gib = double(scene::k_scene_bytes) / k_gib;
  WindowArguments window;
  bool verbose = false;
  app.set_version_flag("--version", LUCERNA_VERSION);
  add_window(app, window);
  app.add_option("--device", common.device, k_device_help);
  app.add_flag("-v,--verbose", verbose, "print debug messages to standard error");
  add_scene_options(app, common);
  const std::vector<Verb> verbs = add_verbs(app, common);

  common.typed.assign(argv + 1, argv + argc);
  // Benches are also accepted in the form of built-in matrices.
  std::vector<std::string> words = common.typed;
  for (const char* bench : {"latency", "photons", "interiors", "auto"})
    if (words.size() > 1 && words[0] == "bench" && words[1] == "--" + std::string(bench)) words[1] = bench;
  std::reverse(words.begin(), words.end());  // CLI11 takes them from the end
  try {
    app.parse(words);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 1;
  }
  if (verbose) log::set_console_level(log::Level::debug);
  common.scenes.most_bytes = uint64_t(common.scene_gib * k_gib);
  for (const Verb& verb : verbs)
    if (*verb.app) return verb.run();
  return open_window(window, common);
}

}  // namespace

int run(int argc, char** argv) {
  separate_large_allocations();
  try {
    return parse_and_run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "lucerna: %s\n", e.what());
    return 1;
  }
}

}  // namespace lucerna::app
