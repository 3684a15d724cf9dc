#pragma once
// Renders of one scene in this session: the one in progress, and those before it, to compare settings by.
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

/// What another run was made with that this one was not, one line each: "sampling.mode uniform (now
/// adaptive)". Nothing when they are alike.
std::vector<std::string> differences(const Run& other, const Run& now);

class Runs {
 public:
  static constexpr size_t k_most = 6;
  /// Takes note of the newest snapshot. A run that ends is kept when it is long enough to be drawn; another
  /// scene forgets them all.
  void follow(const session::Snapshot& snapshot, std::shared_ptr<const scene::Scene> scene);
  void clear() { earlier_.clear(); }
  const Run& current() const { return current_; }
  /// The newest first.
  const std::deque<Run>& earlier() const { return earlier_; }

 private:
  Run current_;
  std::deque<Run> earlier_;
};

}  // namespace lucerna::ui
