// lucerna script, help: scripts as tests, and what their commands do.
#include "app/arguments.h"
#include "app/verbs.h"

namespace lucerna::app {
namespace {

Verb add_script(CLI::App& app, Common& common) {
  const auto arguments = std::make_shared<ScriptArguments>();
  ScriptArguments& a = *arguments;
  CLI::App* verb = app.add_subcommand(
      "script", "run scripts as tests: status 0 if all passed, 1 if one failed, 2 if one cannot be read");
  verb->add_option(
          "FILE", a.words,
          "scripts (.lucerna), and variables NAME=VALUE for ${NAME} in them; see 'lucerna help scripts'")
      ->required();
  verb->add_flag(
      "--headless", a.headless,
      "use no display: the session alone, or an X server of its own (xvfb-run) where a script needs "
      "the window");
  verb->add_option(
          "--report", a.report,
          "folder for junit.xml, report.html and pictures that differ [lucerna-report, made if a picture "
          "differs]")
      ->check(named());
  verb->add_option("--device", a.device, k_device_help);
  add_scene_options(*verb, common);
  const auto run = [arguments, &common] {
    common.complete(*arguments);
    arguments->typed = common.typed;
    return run_scripts(*arguments);
  };
  return {verb, run};
}

Verb add_help(CLI::App& app) {
  const auto topic = std::make_shared<std::string>();
  CLI::App* verb =
      app.add_subcommand("help", "explain a command of scripts and of the console, or list them");
  verb->add_option("COMMAND", *topic, "a command, a setting, or one of settings, values, scripts");
  return {verb, [topic] { return help(*topic); }};
}

}  // namespace

std::vector<Verb> add_script_verbs(CLI::App& app, Common& common) {
  return {add_script(app, common), add_help(app)};
}

}  // namespace lucerna::app
