#include "state.h"

#include <imgui_internal.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/timer.h"
#include "plan/views.h"
#include "solvers/registry.h"

namespace lucerna::ui {
namespace {

const Timer& clock() {
  static const Timer timer;
  return timer;
}

}  // namespace

LogInbox::LogInbox() {
  clock();
  token_ = log::add_listener([this](log::Level level, const std::string& text) {
    std::lock_guard lock(mutex_);
    lines_.push_back({level, clock().seconds(), text});
  });
}

LogInbox::~LogInbox() { log::remove_listener(token_); }

std::vector<LogLine> LogInbox::take() {
  std::lock_guard lock(mutex_);
  return std::exchange(lines_, {});
}

double Ui::time() { return clock().seconds(); }

Ui::Ui(session::Session& session) : work(session, events()) { add_window_commands(*this); }

commands::WorkspaceEvents Ui::events() {
  return {
      .scene_changed = [this] { scene_changed(); },
      .measured =
          [this](const std::string& text) {
            notice(text + ". Ctrl+Z undoes it.", 8);
            print(log::Level::info, text);
          },
      .size_refused =
          [this](uint32_t width, uint32_t height) {
            if (picture_size) picture_size.emplace(width, height);
          },
      .written = [this](const std::string& name) { notice("Saved " + name, 6); },
      .set_with = [this](const std::string& key,
                         const std::string& value) { return accuracy.set_with(key, value); },
      .exposes_at_load = [this] { return !scripted; },
  };
}

bool Ui::reveals() {
  if (std::exchange(revealed_, camera.selection) == camera.selection) return false;
  return !std::exchange(chosen_in_list, false);
}

void Ui::place(const Viewpoint& to) { act_line(commands::Navigation::place_line(to)); }

void Ui::place_by_wheel(const Viewpoint& to) {
  if (work.now - wheeled_ > 0.8) wheel_gesture_ = actions.new_gesture();
  wheeled_ = work.now;
  actions.act_in(wheel_gesture_, commands::Navigation::place_line(to));
}

void Ui::notice(const std::string& text, double seconds) {
  note.text = text, note.until = work.now + seconds;
  wake(3);
}

void Ui::say_blocked() {
  if (work.now - blocked_said_ < 20) return;
  blocked_said_ = work.now;
  notice("A surface is in the way. Hold Alt to pass through it.", 4);
}

double Ui::busy_seconds() const {
  const double seconds = busy.command != 0 ? work.now - busy.since : 0;
  return seconds > 0.5 ? seconds : 0;
}

void Ui::follow_busy() {
  const uint64_t given = work.session.commands(), done = work.session.commands_done();
  const bool all_done = done >= given;
  const uint64_t shown_up_to = open.snapshot ? open.snapshot->commands : 0;
  const uint64_t current = !all_done ? done + 1 : shown_up_to < given ? given : 0;
  if (current == busy.command && all_done == busy.done) return;
  busy.command = current, busy.done = all_done, busy.since = work.now;
  busy.text = current == 0 || all_done ? "" : history.line_of(current);
  if (busy.text.starts_with("inspect.")) busy.text.clear();  // follows the pointer; no one has typed it
}

void Ui::scene_changed() {
  flight = {};
  errors.clear();
  scene_panel_to_top = true;
  if (!open.scene->unknown_extensions.empty())
    notice(fmt::format("Not supported and ignored: {}", fmt::join(open.scene->unknown_extensions, ", ")), 12);
  if (open.scene->file.empty()) return;
  const std::string file = absolute_path(open.scene->file).string();
  std::erase(recent, file);
  recent.insert(recent.begin(), file);
  if (recent.size() > k_recent_files) recent.resize(k_recent_files);
}

std::string Ui::next_side() const {
  std::vector<std::string> sides;
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->has_panel() && open.uses(*solver)) sides.push_back(solver->name);
  // Without a solver in use a panel shows how to use one.
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->has_panel() && sides.empty()) sides.push_back(solver->name);
  if (sides.empty()) return k_scene_side;
  if (side == k_scene_side) return sides.front();
  if (!shown.right_open) return side;
  const auto at = std::find(sides.begin(), sides.end(), side);
  return at == sides.end() || at + 1 == sides.end() ? k_scene_side : *(at + 1);
}

bool Ui::view_on(const solvers::ViewInfo& view) const {
  const std::string& value = open.setting(view.option);
  return value != "false" && value != "off";
}

void Ui::turn_view(const solvers::ViewInfo& view) {
  const OptionInfo* option = plan::find_option(view.option);
  if (!option) return;
  if (option->type != OptionType::choice) return toggle(view.option);
  const std::vector<std::string>& ring = view.ring.empty() ? option->choices : view.ring;
  // A value outside the ring counts as on: off is next.
  const auto at = std::find(ring.begin(), ring.end(), open.setting(view.option));
  act("set", view.option, at == ring.end() || at + 1 == ring.end() ? ring.front() : *(at + 1));
}

bool Ui::inspects_pointer() const {
  for (const solvers::ViewInfo& view : plan::views())
    if (view.inspects_pointer && view_on(view)) return true;
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const solvers::ViewInfo& view : solver->views)
      if (view.inspects_pointer && view_on(view) && open.uses(*solver)) return true;
  return false;
}

std::string panel_help(const solvers::SolverInfo& solver) {
  return capitalised(solver.title) + ": its state, its views over the picture, its options.";
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string uncapitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

void Ui::drop(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".gltf" || ending == ".glb")
    act("scene.open", file);
  else if (ending == ".exr" || ending == ".hdr")
    act("environment.load", file);
  else
    log::error(
        "{}: cannot be opened; expected a scene (.gltf or .glb) or an image to light it with (.exr or .hdr)",
        file);
}

void Ui::print(log::Level level, const std::string& text) {
  log.lines.push_back({level, work.now, text});
  wake();
}

void Ui::fail(const std::string& message) {
  if (errors.empty() || errors.back() != message) errors.push_back(message);
  if (errors.size() > 3) errors.erase(errors.begin());
  wake();
}

}  // namespace lucerna::ui
