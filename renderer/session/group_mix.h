#pragma once
// A new mix of light groups: the window shows it at once, the film's sums follow.
#include <vector>

#include "base/timer.h"
#include "session/image_progress.h"
#include "session/sampling.h"
#include "session/setup.h"

namespace lucerna::session {

class GroupMix {
 public:
  /// All must outlive it.
  GroupMix(Setup& setup, Sampling& sampling, ImageProgress& progress)
      : setup_(setup), sampling_(sampling), progress_(progress) {}

  /// Call when Relight::weights have changed. The film's sums do not contain the mix until settle().
  void change();
  bool pending() const { return pending_; }
  /// True if the latest changes are those of a slider or of a pointer dragged over presets.
  bool dragged() const { return dragged_; }
  /// Applies a pending mix to the film's sums. Errors and adaptive sampling follow.
  void settle();
  /// Call when a picture begins: its samples have the present mix.
  void restart() { pending_ = false; }

 private:
  Setup& setup_;
  Sampling& sampling_;
  ImageProgress& progress_;
  bool pending_ = false, dragged_ = false;
  std::vector<vec3> mixed_;  ///< weights of the last mix
  Timer since_mix_;
};

}  // namespace lucerna::session
