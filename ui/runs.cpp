#include "runs.h"

#include <fmt/format.h>

#include "commands/camera_control.h"
#include "solvers/registry.h"

namespace lucerna::ui {
namespace {

constexpr size_t k_least_lines = 8;    // of the ledger
constexpr double k_least_seconds = 1;  // of rendering

bool should_keep(const Run& run) {
  const auto& lines = run.accuracy->ledger.entries();
  return lines.size() >= k_least_lines && lines.back().wall_s >= k_least_seconds && lines.back().error[0] > 0;
}

/// Settings that change the display, not the computation.
bool only_shown(const std::string& key) {
  for (const char* head : {"film.", "show.", "overlay.", "camera", "about"})
    if (key.starts_with(head)) return true;
  const OptionInfo* option = plan::find_option(key);
  return option && !option->restarts && solvers::owner_of(key);
}

bool same_lights(const scene::Scene& a, const scene::Scene& b) {
  if (a.environment.scale != b.environment.scale || a.environment.rotation != b.environment.rotation ||
      a.lights.size() != b.lights.size())
    return false;
  for (size_t i = 0; i < a.lights.size(); ++i)
    if (a.lights[i].intensity != b.lights[i].intensity || a.lights[i].enabled != b.lights[i].enabled)
      return false;
  return true;
}

}  // namespace

std::vector<std::string> differences(const Run& other, const Run& now) {
  std::vector<std::string> list;
  for (const auto& [key, value] : other.accuracy->settings) {
    const auto found = now.accuracy->settings.find(key);
    if (found != now.accuracy->settings.end() && found->second != value && !only_shown(key))
      list.push_back(fmt::format("{} {} (now {})", key, value, found->second));
  }
  if (other.width != now.width || other.height != now.height)
    list.push_back(fmt::format("{} \xC3\x97 {} pixels (now {} \xC3\x97 {})", other.width, other.height,
                               now.width, now.height));
  if (!commands::same_view(other.camera, now.camera)) list.push_back("another view");
  if (other.scene && now.scene && other.scene != now.scene && !same_lights(*other.scene, *now.scene))
    list.push_back("other lights");
  return list;
}

void Runs::follow(const session::Snapshot& s, std::shared_ptr<const scene::Scene> scene) {
  if (!s.accuracy) return;
  if (current_.accuracy && current_.accuracy->scene_id != s.accuracy->scene_id) {
    earlier_.clear();
  } else if (current_.accuracy && current_.accuracy->run != s.accuracy->run && should_keep(current_)) {
    earlier_.push_front(current_);
    if (earlier_.size() > k_most) earlier_.pop_back();
  }
  current_ = {s.accuracy, s.camera, std::move(scene), s.width, s.height};
}

}  // namespace lucerna::ui
