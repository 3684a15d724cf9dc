#include "state.h"

#include <imgui_internal.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/timer.h"
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
            cards.notice(text + ". Ctrl+Z undoes it.", 8);
            log.print(log::Level::info, text);
          },
      .size_refused =
          [this](uint32_t width, uint32_t height) {
            if (picture_size) picture_size.emplace(width, height);
          },
      .written = [this](const std::string& name) { cards.notice("Saved " + name, 6); },
      .set_with = [this](const std::string& key,
                         const std::string& value) { return accuracy.set_with(key, value); },
      .exposes_at_load = [this] { return !scripted; },
  };
}

void Ui::follow_busy() {
  const uint64_t given = work.session.commands(), done = work.session.commands_done();
  const bool all_done = done >= given;
  const uint64_t shown_up_to = open.snapshot ? open.snapshot->commands : 0;
  const uint64_t current = !all_done ? done + 1 : shown_up_to < given ? given : 0;
  if (current == cards.busy.command && all_done == cards.busy.done) return;
  cards.busy.command = current, cards.busy.done = all_done, cards.busy.since = work.now;
  cards.busy.text = current == 0 || all_done ? "" : history.line_of(current);
  if (cards.busy.text.starts_with("inspect."))
    cards.busy.text.clear();  // follows the pointer; no one has typed it
}

void Ui::scene_changed() {
  flight = {};
  cards.errors.clear();
  scene_view.to_top = true;
  if (!open.scene->unknown_extensions.empty())
    cards.notice(
        fmt::format("Not supported and ignored: {}", fmt::join(open.scene->unknown_extensions, ", ")), 12);
  if (open.scene->file.empty()) return;
  const std::string file = absolute_path(open.scene->file).string();
  std::erase(recent, file);
  recent.insert(recent.begin(), file);
  if (recent.size() > k_recent_files) recent.resize(k_recent_files);
}

std::string next_side(const commands::OpenScene& open, const std::string& side, bool shown) {
  std::vector<std::string> sides;
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->has_panel() && open.uses(*solver)) sides.push_back(solver->name);
  // Without a solver in use a panel shows how to use one.
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->has_panel() && sides.empty()) sides.push_back(solver->name);
  if (sides.empty()) return k_scene_side;
  if (side == k_scene_side) return sides.front();
  if (!shown) return side;
  const auto at = std::find(sides.begin(), sides.end(), side);
  return at == sides.end() || at + 1 == sides.end() ? k_scene_side : *(at + 1);
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

void Ui::leave(const std::string& opens) {
  leaving = {Leaving::Step::asks, opens};
  if (!work.scene_file.unsaved()) finish_leaving();
}

void Ui::finish_leaving() {
  const std::string opens = std::exchange(leaving, {}).opens;
  if (opens.empty())
    requests.status = 0;
  else
    open_scene(opens);
}

void Ui::open_scene(const std::string& file) {
  act_line(commands::line("scene.open", file) + " choose=true");
}

void Ui::drop(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".gltf" || ending == ".glb")
    act("window.open", file);
  else if (ending == ".exr" || ending == ".hdr")
    act("environment.load", file);
  else
    log::error(
        "{}: cannot be opened; expected a scene (.gltf or .glb) or an image to light it with (.exr or .hdr)",
        file);
}

void Ui::fail(const std::string& message) {
  if (cards.errors.empty() || cards.errors.back() != message) cards.errors.push_back(message);
  if (cards.errors.size() > 3) cards.errors.erase(cards.errors.begin());
  wake();
}

}  // namespace lucerna::ui
