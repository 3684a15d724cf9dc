#include "runner.h"

#include <GLFW/glfw3.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "film/io/image_file.h"

namespace lucerna::ui {

using commands::Arguments;
using commands::Type;

namespace {

constexpr double k_longest_wait = 300;   // seconds
constexpr double k_between_moves = 1.5;  // seconds
const std::vector<std::string> k_buttons{"left", "right", "middle"};

/// Checks that a picture of the window may be written to `file`. Throws Error if it would replace any other
/// file.
std::string checked_target(const std::string& file) {
  if (is_plain_file(file)) {
    bool ours = false;
    try {
      ours = film::read_metadata(file).count(k_window_mark) > 0;
    } catch (const Error&) {
    }
    if (!ours) throw Error(file, "exists and is no picture of the window: choose another name");
  }
  return file;
}

/// An unused file name in the working folder.
std::string free_name() {
  const std::string name = fmt::format("lucerna-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
  std::string file = name + ".png";
  std::error_code error;
  for (int n = 2; std::filesystem::exists(file, error); ++n) file = fmt::format("{}-{}.png", name, n);
  return file;
}

int button_of(const commands::Arguments& a) {
  const std::string name = a.has("button") ? a.text("button") : "left";
  return static_cast<int>(std::find(k_buttons.begin(), k_buttons.end(), name) - k_buttons.begin());
}

/// The GLFW key of a held key, which can be a modifier. Throws Error if there is none.
int held_key_of(const std::string& name) {
  if (name == "ctrl") return GLFW_KEY_LEFT_CONTROL;
  if (name == "shift") return GLFW_KEY_LEFT_SHIFT;
  if (name == "alt") return GLFW_KEY_LEFT_ALT;
  const auto [key, mods] = key_of(name);
  if (mods != 0) throw Error("", fmt::format("'{}': expected one key", name));
  return key;
}

/// The first script in the chain of calls.
const Call& root(const Call& call) {
  const Call* at = &call;
  while (at->by) at = at->by.get();
  return *at;
}

std::string one_form(const std::string& file) {
  std::error_code error;
  return std::filesystem::weakly_canonical(file, error).string();
}

}  // namespace

Runner::Runner(Ui& ui, const std::vector<std::string>& lines, const std::string& name, bool stay) : ui_(ui) {
  add_commands();
  if (lines.empty()) return;
  const auto call = std::make_shared<const Call>(Call{.file = one_form(name), .by = {}, .own = true});
  for (Step& step : parse_script(ui_.work.registry, lines, name)) steps_.push_back(std::move(step));
  if (!stay) steps_.push_back({"quit", name + ": end"});
  for (Step& step : steps_) step.call = call;
}

void Runner::add_commands() {
  add_script_commands();
  add_mouse_commands();
  add_key_commands();
}

void Runner::add_script_commands() {
  auto& registry = ui_.work.registry;
  registry.add(
      {.name = "quit",
       .help = "Ends the program. In a script: after all commands are done; without a status with 1 after an "
               "error, otherwise with 0.",
       .parameters = {{.name = "status", .type = Type::integer, .lo = 0, .hi = 255, .optional = true}},
       .run =
           [this](const Arguments& a) {
             settled_ = 0;
             if (!in_script_)
               ui_.requests.status = a.has("status") ? static_cast<int>(a.integer("status")) : 0;
           },
       .done =
           [this](const Arguments& a) {
             ui_.wake();
             // Errors of the last command are read one frame after it is done.
             const bool settled =
                 ui_.open.snapshot ? ui_.open.up_to_date() : ui_.work.session.commands() == 0;
             settled_ = settled ? settled_ + 1 : 0;
             if (settled_ < 2) return false;
             const bool complains = ui_.work.error_count > root(*steps_.front().call).errors;
             ui_.requests.status = a.has("status") ? static_cast<int>(a.integer("status"))
                                   : complains     ? 1
                                                   : 0;
             return true;
           },
       .recorded = false});
  registry.add(
      {.name = "screenshot",
       .help = "Saves the window with its panels as PNG; without a name under an unused name in the working "
               "folder. An existing file is replaced only if it is such a picture.",
       .parameters =
           {{.name = "file", .type = Type::file, .choices = {".png"}, .optional = true, .writes = true}},
       .run =
           [this](const Arguments& a) {
             ui_.requests.shot = {a.has("file") ? checked_target(a.text("file")) : free_name(), 3};
             ui_.wake(4);
           },
       .done =
           [this](const Arguments&) {
             if (ui_.requests.shot.failed) throw Error("", "nothing was written");
             return ui_.requests.shot.file.empty();
           },
       .recorded = false});
  registry.add(
      {.name = "measure",
       .help = "In a script: measures frame times and response times to camera moves; prints one JSON line.",
       .parameters = {{.name = "time", .type = Type::real, .lo = 0.1, .hi = 3600, .unit = "seconds"}},
       .run = [this](const Arguments& a) { measure(a.real("time")); },
       .done = [this](const Arguments&) { return measured(); },
       .recorded = false});
  registry.add({.name = "script.run",
                .help = "Runs the commands of a file.",
                .parameters = {{.name = "file", .type = Type::file, .choices = {".lucerna"}}},
                .run = [this](const Arguments& a) { run_script(a.text("file")); },
                .recorded = false});
}

std::function<bool(const commands::Arguments&)> Runner::drawn() {
  return [this](const Arguments&) { return ui_.wake(2), frames_ >= 2; };
}

void Runner::add_mouse_commands() {
  auto& registry = ui_.work.registry;
  registry.add({.name = "drop",
                .help = "Acts as if the file were dropped on the window.",
                .parameters = {{.name = "file", .type = Type::file}},
                .run = [this](const Arguments& a) { ui_.requests.drops.push_back(a.text("file")); },
                .done = drawn(),
                .recorded = false});
  registry.add({.name = "mouse.move",
                .help = "In a script: moves the pointer.",
                .parameters = {{.name = "x", .type = Type::real, .unit = "pixels"},
                               {.name = "y", .type = Type::real, .unit = "pixels"}},
                .run =
                    [this](const Arguments& a) {
                      ui_.requests.inputs.push_back({a.number("x"), a.number("y")});
                    },
                .done = drawn(),
                .recorded = false});
  for (const bool down : {true, false})
    registry.add(
        {.name = down ? "mouse.down" : "mouse.up",
         .help = down ? "In a script: presses a mouse button." : "In a script: releases a mouse button.",
         .parameters = {{.name = "button", .type = Type::choice, .choices = k_buttons, .optional = true}},
         .run =
             [this, down](const Arguments& a) {
               ui_.requests.inputs.push_back({.button = button_of(a), .down = down});
             },
         .done = drawn(),
         .recorded = false});
  registry.add({.name = "mouse.wheel",
                .help = "In a script: turns the wheel.",
                .parameters = {{.name = "notches", .type = Type::real, .lo = -100, .hi = 100}},
                .run = [this](const Arguments& a) { ui_.requests.wheel += a.number("notches"); },
                .done = drawn(),
                .recorded = false});
}

void Runner::add_key_commands() {
  auto& registry = ui_.work.registry;
  registry.add(
      {.name = "key",
       .help = "In a script: presses a key, such as f, f12, tab, ctrl+z.",
       .parameters = {{.name = "name"}},
       .check = [](const Arguments& a) { key_of(a.text("name")); },
       .run = [this](const Arguments& a) { ui_.requests.key_strokes.push_back(key_of(a.text("name"))); },
       .done = drawn(),
       .recorded = false});
  registry.add({.name = "key.hold",
                .help = "In a script: holds a key down, such as w or ctrl, shift, alt; or releases it.",
                .parameters = {{.name = "name"}, {.name = "down", .type = Type::boolean}},
                .check = [](const Arguments& a) { held_key_of(a.text("name")); },
                .run =
                    [this](const Arguments& a) {
                      ui_.requests.key_holds.emplace_back(held_key_of(a.text("name")), a.boolean("down"));
                    },
                .done = drawn(),
                .recorded = false});
  registry.add({.name = "type",
                .help = "In a script: types a text.",
                .parameters = {{.name = "text"}},
                .run = [this](const Arguments& a) { ui_.requests.keyboard += a.text("text"); },
                .done = drawn(),
                .recorded = false});
}

void Runner::advance() {
  for (const std::string& line : std::exchange(ui_.log.typed, {})) console(line);
  while (running() && !ui_.requests.status) {
    // A script may insert steps behind the one that is running.
    const Step step = steps_.front();
    if (!current_.command && waits_for_earlier(step)) {
      ui_.wake();
      return;
    }
    const bool failed = [&] {
      try {
        if (carry_out(step)) return false;
        const commands::Arguments& a = current_.arguments;
        const double limit = a.has("limit") ? a.real("limit") : k_longest_wait;
        if (ui_.work.now - began_ > limit && !measure_ && current_.command->name != "wait")
          throw_error(step.where, "{}: gave up after {:.0f} s", current_.command->name, limit);
        return false;
      } catch (const std::exception& error) {
        log::error("{}", error.what());
        give_up(step);
        return true;
      }
    }();
    if (failed || current_.command) return;
    steps_.pop_front();
    ui_.wake(3);
  }
}

bool Runner::waits_for_earlier(const Step& step) const {
  const commands::Command* next = ui_.work.registry.parse(step.line, step.where).command;
  if (!next) return false;
  if (next->needs_outcome && ui_.open.snapshot && !ui_.open.up_to_date() && !ui_.open.loading()) return true;
  // The panels' own commands need no picture.
  return ui_.camera.resizing && !next->name.starts_with("window.") && !next->name.starts_with("view.");
}

bool Runner::carry_out(const Step& step) {
  if (!current_.command) {
    began_ = ui_.work.now, frames_ = 0;
    in_script_ = true;
    try {
      current_ = ui_.work.run(step.line, 0, step.where);
    } catch (...) {
      in_script_ = false;
      throw;
    }
    in_script_ = false;
    ui_.wake();
    if (current_.command->done) return false;
  } else {
    try {
      if (!current_.command->done(current_.arguments)) return false;
    } catch (const Error& error) {
      throw_error(step.where, "{}: {}", current_.command->name, error.what());
    }
  }
  current_ = {};
  return true;
}

void Runner::give_up(const Step& step) {
  const Call& script = root(*step.call);
  if (script.own) ui_.requests.status = 1;
  current_ = {};
  measure_.reset();
  std::erase_if(steps_, [&, script = &script](const Step& s) { return &root(*s.call) == script; });
}

void Runner::run_script(const std::string& file) {
  const std::shared_ptr<const Call> by = in_script_ ? steps_.front().call : nullptr;
  const std::string form = one_form(file);
  for (const Call* call = by.get(); call; call = call->by.get())
    if (call->file == form) throw Error(file, "is already running: a script cannot run itself");
  const auto call = std::make_shared<const Call>(
      Call{.file = form, .by = by, .own = false, .errors = ui_.work.error_count});
  auto steps = parse_script(ui_.work.registry, read_script(file), file);
  for (Step& step : steps) step.call = call;
  // After the running step, which is at the front.
  steps_.insert(steps_.begin() + (steps_.empty() ? 0 : 1), steps.begin(), steps.end());
}

/// A line at the console runs immediately; its failures are shown there, not in the error strip.
void Runner::console(const std::string& line) {
  ui_.print(log::Level::info, "\xE2\x80\xBA " + line);
  try {
    const commands::Line parsed = ui_.work.registry.parse(line);
    if (!parsed.command) return;
    if (parsed.command->name == "help")
      ui_.print(log::Level::info,
                ui_.work.manual(parsed.arguments.has("command") ? parsed.arguments.text("command") : ""));
    else
      ui_.work.run(line);
  } catch (const std::exception& error) {
    ui_.print(log::Level::error, error.what());
  }
}

void Runner::measure(double seconds) {
  if (!ui_.camera.view) throw Error("", "there is no picture yet; wait_scene first");
  measure_.emplace();
  measure_->start = ui_.work.now, measure_->end = ui_.work.now + seconds,
  measure_->next_move = ui_.work.now + 0.5 * k_between_moves;
}

bool Runner::measured() {
  if (!measure_) return true;
  Measure& m = *measure_;
  const bool answered = m.moved_at < 0;
  if (ui_.work.now >= m.next_move && answered && ui_.work.now < m.end) {
    ui_.act("camera.orbit", m.moves % 2 ? -0.1 : 0.1, 0);
    m.target = ui_.camera.view->camera;
    m.moved_at = ui_.work.now;
    m.next_move = ui_.work.now + k_between_moves;
    ++m.moves;
  }
  // Waits for the response to the last move, for a limited time.
  if (ui_.work.now < m.end || (!answered && ui_.work.now < m.end + 10)) return false;
  std::fputs(
      fmt::format("{{\"measure\": {{\"seconds\": {:.2f}, \"frames\": {}, \"frame_ms_p50\": {:.2f}, "
                  "\"frame_ms_p95\": {:.2f}, \"frame_ms_max\": {:.2f}, "
                  "\"coarse_ms_median\": {:.1f}, \"coarse_ms_max\": {:.1f}, \"moves\": {}, \"answered\": {}, "
                  "\"picture\": [{}, {}]}}}}\n",
                  ui_.work.now - m.start, m.frames.size(), percentile(m.frames, 0.5),
                  percentile(m.frames, 0.95), percentile(m.frames, 1), percentile(m.coarse, 0.5),
                  percentile(m.coarse, 1), m.moves, m.coarse.size(), ui_.texture_width, ui_.texture_height)
          .c_str(),
      stdout);
  std::fflush(stdout);
  measure_.reset();
  return true;
}

void Runner::presented(double interval_ms) {
  ++frames_;
  if (!measure_) return;
  Measure& m = *measure_;
  // Before the first frame the window may have slept without anything to draw.
  if (std::exchange(m.begun, true)) m.frames.push_back(interval_ms);
  // The first picture on the screen with the new camera.
  if (m.moved_at >= 0 && ui_.open.snapshot && commands::same_view(ui_.open.snapshot->camera, m.target)) {
    m.coarse.push_back(1e3 * (ui_.time() - m.moved_at));
    m.moved_at = -1;
  }
}

}  // namespace lucerna::ui
