#pragma once
// Renders of one scene in this session, current and earlier, for comparing settings.
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "session/session.h"

namespace lucerna::ui {

struct Run {
  std::shared_ptr<const session::Accuracy> accuracy;
  scene::Camera camera;
  std::shared_ptr<const scene::Scene> scene;
  uint32_t width = 0, height = 0;
};

/// Settings and edits in which another run differs, one line each: "sampling.mode uniform (now adaptive)".
/// Empty if none.
std::vector<std::string> differences(const Run& other, const Run& now);

class Runs {
 public:
  static constexpr size_t k_most = 6;
  /// Processes the newest snapshot. A finished run is kept if it is long enough to be drawn; another scene
  /// discards all.
  void follow(const session::Snapshot& snapshot, std::shared_ptr<const scene::Scene> scene);
  void clear() { earlier_.clear(); }
  const Run& current() const { return current_; }
  /// Newest first.
  const std::deque<Run>& earlier() const { return earlier_; }

 private:
  Run current_;
  std::deque<Run> earlier_;
};

}  // namespace lucerna::ui
