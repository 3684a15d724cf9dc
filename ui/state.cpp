#include "state.h"

#include <imgui_internal.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/timer.h"

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

Ui::Ui(session::Session& s) : Workspace(s) { add_window_commands(*this); }

void Ui::act_line(const std::string& line) {
  try {
    run(line, gesture);
  } catch (const Error& error) {
    log::error("{}", error.what());
  }
  wake();
}

void Ui::follow_gesture() {
  const unsigned held = ImGui::GetActiveID();
  const bool flying = flight.moving();
  if (held != held_ || flying != flying_) gesture = held != 0 || flying ? ++gestures_ : 0;
  held_ = held, flying_ = flying;
}

bool Ui::reveals() { return std::exchange(revealed_, selection) != selection; }

void Ui::place(const Viewpoint& to) { act_line(place_line(to)); }

void Ui::scene_changed() {
  flight = {};
  errors.clear();
  if (scene->file.empty()) return;
  std::erase(recent, scene->file);
  recent.insert(recent.begin(), scene->file);
  if (recent.size() > 8) recent.resize(8);
}

void Ui::drop(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".gltf" || ending == ".glb")
    act("scene.open", file);
  else
    log::error("{}: cannot be opened; expected a .gltf or .glb file", file);
}

void Ui::print(log::Level level, const std::string& text) {
  log.push_back({level, now, text});
  wake();
}

void Ui::fail(const std::string& message) {
  if (errors.empty() || errors.back() != message) errors.push_back(message);
  if (errors.size() > 3) errors.erase(errors.begin());
  wake();
}

}  // namespace lucerna::ui
