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
#include "state.h"
#include "window_expectations.h"

namespace lucerna::ui {

using commands::Arguments;
using commands::Type;

namespace {

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

}  // namespace

Runner::Runner(Viewport& viewport, const Areas& areas, LogView& log, Requests& requests,
               commands::ReportFolder& report)
    : scripts(viewport.work, report,
              {.wake = [&actions = viewport.controls.actions](int frames) { actions.wake(frames); },
               .quit = [&requests](int status) { requests.status = status; },
               .waits =
                   [&work = viewport.work](const commands::Command& next) {
                     // The panels' own commands need no picture.
                     return work.camera.resizing && !next.name.starts_with("window.") &&
                            !next.name.starts_with("view.");
                   },
               .patient = [this] { return measuring(); },
               .add_kinds =
                   [&actions = viewport.controls.actions, &requests, &areas](commands::Expectations& kinds) {
                     add_window_expectations(actions, requests, areas, kinds);
                   }}),
      work_(viewport.work),
      actions_(viewport.controls.actions),
      viewport_(viewport),
      log_(log),
      requests_(requests) {
  add_picture_commands();
  add_mouse_commands();
  add_key_commands();
}

namespace {
bool always(const Arguments&) { return true; }
}  // namespace

void Runner::add_picture_commands() {
  auto& registry = work_.registry;
  registry.add(
      {.name = "screenshot",
       .help = "Saves the window with its panels as PNG; without a name under an unused name in the working "
               "folder. An existing file is replaced only if it is such a picture.",
       .parameters =
           {{.name = "file", .type = Type::file, .choices = {".png"}, .optional = true, .writes = true}},
       .run =
           [this](const Arguments& a) {
             requests_.shot = {a.has("file") ? checked_target(a.text("file")) : free_name(), 3};
             actions_.wake(4);
           },
       .done =
           [this](const Arguments&) {
             if (requests_.shot.failed) throw Error("", "nothing was written");
             return requests_.shot.file.empty();
           },
       .recorded = false,
       .needs_window = always});
  registry.add(
      {.name = "measure",
       .help = "In a script: measures frame times and response times to camera moves; prints one JSON line.",
       .parameters = {{.name = "time", .type = Type::real, .lo = 0.1, .hi = 3600, .unit = "seconds"}},
       .run = [this](const Arguments& a) { measure(a.real("time")); },
       .done = [this](const Arguments&) { return measured(); },
       .recorded = false,
       .needs_window = always});
}

std::function<bool(const commands::Arguments&)> Runner::drawn() {
  return [this](const Arguments&) { return actions_.wake(2), scripts.frames() >= 2; };
}

void Runner::add_mouse_commands() {
  auto& registry = work_.registry;
  registry.add({.name = "drop",
                .help = "Acts as if the file were dropped on the window.",
                .parameters = {{.name = "file", .type = Type::file}},
                .run = [this](const Arguments& a) { requests_.drops.push_back(a.text("file")); },
                .done = drawn(),
                .recorded = false,
                .needs_window = always});
  registry.add({.name = "mouse.move",
                .help = "In a script: moves the pointer.",
                .parameters = {{.name = "x", .type = Type::real, .unit = "pixels"},
                               {.name = "y", .type = Type::real, .unit = "pixels"}},
                .run =
                    [this](const Arguments& a) {
                      requests_.inputs.push_back({a.number("x"), a.number("y")});
                    },
                .done = drawn(),
                .recorded = false,
                .needs_window = always});
  for (const bool down : {true, false})
    registry.add(
        {.name = down ? "mouse.down" : "mouse.up",
         .help = down ? "In a script: presses a mouse button." : "In a script: releases a mouse button.",
         .parameters = {{.name = "button", .type = Type::choice, .choices = k_buttons, .optional = true}},
         .run =
             [this, down](const Arguments& a) {
               requests_.inputs.push_back({.button = button_of(a), .down = down});
             },
         .done = drawn(),
         .recorded = false,
         .needs_window = always});
  registry.add({.name = "mouse.wheel",
                .help = "In a script: turns the wheel.",
                .parameters = {{.name = "notches", .type = Type::real, .lo = -100, .hi = 100}},
                .run = [this](const Arguments& a) { requests_.wheel += a.number("notches"); },
                .done = drawn(),
                .recorded = false,
                .needs_window = always});
}

void Runner::add_key_commands() {
  auto& registry = work_.registry;
  registry.add(
      {.name = "key",
       .help = "In a script: presses a key, such as f, f12, tab, ctrl+z.",
       .parameters = {{.name = "name"}},
       .check = [](const Arguments& a) { key_of(a.text("name")); },
       .run = [this](const Arguments& a) { requests_.key_strokes.push_back(key_of(a.text("name"))); },
       .done = drawn(),
       .recorded = false,
       .needs_window = always});
  registry.add({.name = "key.hold",
                .help = "In a script: holds a key down, such as w or ctrl, shift, alt; or releases it.",
                .parameters = {{.name = "name"}, {.name = "down", .type = Type::boolean}},
                .check = [](const Arguments& a) { held_key_of(a.text("name")); },
                .run =
                    [this](const Arguments& a) {
                      requests_.key_holds.emplace_back(held_key_of(a.text("name")), a.boolean("down"));
                    },
                .done = drawn(),
                .recorded = false,
                .needs_window = always});
  registry.add({.name = "type",
                .help = "In a script: types a text.",
                .parameters = {{.name = "text"}},
                .run = [this](const Arguments& a) { requests_.keyboard += a.text("text"); },
                .done = drawn(),
                .recorded = false,
                .needs_window = always});
}

void Runner::advance() {
  for (const std::string& line : std::exchange(log_.typed, {})) console(line);
  if (!requests_.status) scripts.advance();
}

/// A line at the console runs immediately; its failures are shown there, not in the error strip.
void Runner::console(const std::string& line) {
  log_.print(log::Level::info, "\xE2\x80\xBA " + line);
  try {
    const commands::Line parsed = work_.registry.parse(line);
    if (!parsed.command) return;
    if (parsed.command->answer)
      log_.print(log::Level::info, parsed.command->answer(parsed.arguments));
    else
      work_.run(line);
  } catch (const std::exception& error) {
    log_.print(log::Level::error, error.what());
  }
}

void Runner::measure(double seconds) {
  if (!work_.camera.view) throw Error("", "there is no picture yet; wait_scene first");
  measure_.emplace();
  measure_->start = work_.now, measure_->end = work_.now + seconds,
  measure_->next_move = work_.now + 0.5 * k_between_moves;
}

bool Runner::measured() {
  if (!measure_) return true;
  Measure& m = *measure_;
  const bool answered = m.moved_at < 0;
  if (work_.now >= m.next_move && answered && work_.now < m.end) {
    actions_.act("camera.orbit", m.moves % 2 ? -0.1 : 0.1, 0);
    m.target = work_.camera.view->camera;
    m.moved_at = work_.now;
    m.next_move = work_.now + k_between_moves;
    ++m.moves;
  }
  // Waits for the response to the last move, for a limited time.
  if (work_.now < m.end || (!answered && work_.now < m.end + 10)) return false;
  std::fputs(
      fmt::format("{{\"measure\": {{\"seconds\": {:.2f}, \"frames\": {}, \"frame_ms_p50\": {:.2f}, "
                  "\"frame_ms_p95\": {:.2f}, \"frame_ms_max\": {:.2f}, "
                  "\"coarse_ms_median\": {:.1f}, \"coarse_ms_max\": {:.1f}, \"moves\": {}, \"answered\": {}, "
                  "\"picture\": [{}, {}]}}}}\n",
                  work_.now - m.start, m.frames.size(), percentile(m.frames, 0.5), percentile(m.frames, 0.95),
                  percentile(m.frames, 1), percentile(m.coarse, 0.5), percentile(m.coarse, 1), m.moves,
                  m.coarse.size(), viewport_.texture_width, viewport_.texture_height)
          .c_str(),
      stdout);
  std::fflush(stdout);
  measure_.reset();
  return true;
}

void Runner::presented(double interval_ms) {
  scripts.drawn();
  if (!measure_) return;
  Measure& m = *measure_;
  // Before the first frame the window may have slept without anything to draw.
  if (std::exchange(m.begun, true)) m.frames.push_back(interval_ms);
  // The first picture on the screen with the new camera.
  if (m.moved_at >= 0 && work_.open.snapshot && commands::same_view(work_.open.snapshot->camera, m.target)) {
    m.coarse.push_back(1e3 * (Ui::time() - m.moved_at));
    m.moved_at = -1;
  }
}

double percentile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double at = std::clamp(p, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace lucerna::ui
