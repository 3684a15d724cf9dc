// lucerna script: runs scripts as tests. lucerna help: explains their commands.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "app/interrupt.h"
#include "app/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "session/device_keeper.h"
#include "ui/runner.h"
#include "ui/state.h"
#include "ui/viewer.h"

namespace lucerna::app {
namespace {

/// Set for the program that runs in an X server of its own.
constexpr const char* k_own_display = "LUCERNA_OWN_DISPLAY";

constexpr int k_unreadable = 2;  // exit status

/// A program of that name in $PATH.
bool is_installed(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::string folders = path ? path : "";
  while (!folders.empty()) {
    const size_t end = folders.find(':');
    if (access((folders.substr(0, end) + "/" + program).c_str(), X_OK) == 0) return true;
    folders = end == std::string::npos ? "" : folders.substr(end + 1);
  }
  return false;
}

/// Runs this program again in an X server of its own. Returns only if that fails.
void start_display(const std::vector<std::string>& arguments) {
  std::error_code error;
  std::vector<std::string> words{"xvfb-run", "-a", "-s", "-screen 0 1920x1200x24 -noreset",
                                 std::filesystem::read_symlink("/proc/self/exe", error).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> list;
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  setenv(k_own_display, "1", 1);
  execvp(list[0], list.data());
}

struct Words {
  std::vector<std::string> files;
  commands::Variables variables;
};

Words sorted(const std::vector<std::string>& words) {
  Words result;
  for (const std::string& word : words)
    if (word.find('=') == std::string::npos || file_exists(word)) {
      result.files.push_back(word);
    } else {
      const auto [name, value] = commands::parse_variable(word, "script");
      if (!result.variables.emplace(name, value).second)
        throw_error("script", "the variable '{}' is given twice", name);
    }
  if (result.files.empty()) throw Error("script", "expected a script: lucerna script FILE [NAME=VALUE...]");
  return result;
}

ui::ViewerOptions options_of(const std::string& file, const Words& words, commands::ReportFolder& report) {
  ui::ViewerOptions options;
  options.script = commands::read_script(file);
  if (options.script.empty()) options.script.emplace_back();  // an empty script ends too
  options.script_name = file;
  options.variables = words.variables;
  options.report = &report;
  options.width = 1280, options.height = 800, options.scale = 1;
  options.remember = false;
  options.interrupted = [] { return Interrupt::signal() != 0; };
  return options;
}

/// Runs the scripts one after the other, each with a session of its own.
int run_all(const ScriptArguments& arguments, const Words& words, commands::ReportFolder& report,
            bool window) {
  const Interrupt interrupt;
  const session::DeviceKeeper keeper;
  std::vector<commands::ScriptResult> results;
  bool failed = false;
  for (const std::string& file : words.files) {
    const ui::ViewerOptions options = options_of(file, words, report);
    commands::ScriptResult result;
    {
      const auto made = session::start_session(
          {.device = arguments.device, .validation = false, .shaders = {}, .scenes = arguments.scenes});
      session::Session& session = *made;
      const int status =
          window ? ui::run_viewer(session, options, &result) : ui::run_headless(session, options, &result);
      failed = failed || status != 0 || !result.passed();
    }
    if (interrupt.signal()) return interrupt.status();
    std::fputs(commands::summary(result).c_str(), stdout);
    std::fflush(stdout);
    results.push_back(std::move(result));
  }
  if (results.size() > 1) std::fputs(commands::summary(results).c_str(), stdout);
  report.write(results);
  if (!report.path().empty()) std::printf("report: %s/report.html\n", report.path().c_str());
  return failed ? 1 : 0;
}

}  // namespace

int run_scripts(const ScriptArguments& arguments) {
  Words words;
  std::optional<commands::ReportFolder> report;
  bool needs_window = false;
  try {
    words = sorted(arguments.words);
    report.emplace(arguments.report);
    // Every script is read before the first one runs.
    const auto made = session::start_session(
        {.device = "", .validation = false, .shaders = {}, .scenes = {}, .idle = true});
    session::Session& idle = *made;
    for (const std::string& file : words.files)
      needs_window = ui::needs_window(idle, options_of(file, words, *report)) || needs_window;
  } catch (const Error& error) {
    std::fprintf(stderr, "lucerna: %s\n", error.what());
    return k_unreadable;
  }
  const bool own = std::getenv(k_own_display) != nullptr;
  const bool display = (own || !arguments.headless) && ui::display_available();
  if (needs_window && !display) {
    if (!own && is_installed("xvfb-run")) start_display(arguments.typed);
    std::fprintf(
        stderr, "lucerna: script: needs a window, and there is no display; install xvfb, or use a display\n");
    return k_unreadable;
  }
  return run_all(arguments, words, *report, display && (needs_window || !own));
}

int help(const std::string& topic) {
  const auto made =
      session::start_session({.device = "", .validation = false, .shaders = {}, .scenes = {}, .idle = true});
  session::Session& idle = *made;
  ui::Ui state(idle);
  commands::ReportFolder report;
  const ui::Runner runner(state.viewport, state.areas, state.log, state.requests, report);
  std::printf("%s\n", state.work.manual(topic).c_str());
  return 0;
}

}  // namespace lucerna::app
