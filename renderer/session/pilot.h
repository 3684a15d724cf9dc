#pragma once
// The pilot of a picture: its own first samples, by paths, from which the solvers of components with the
// setting auto are chosen (plan/choose.h). Where paths are chosen, the picture goes on; else it begins again.
#include <algorithm>
#include <cstdint>
#include <optional>

#include "plan/choose.h"

namespace lucerna::session {

class Pilot {
 public:
  /// Call when a picture begins.
  void restart() { *this = {}; }
  /// Call after a work item of samples: whole samples of the picture so far, and the item's time [s].
  void note(uint32_t samples, double seconds) {
    all_ += seconds;
    if (samples_ == 0 && samples > 0) first_ = all_;
    samples_ = samples;
  }
  /// Time of a sample [s]: of those after the first, which waits for kernels; 0: not known.
  double sample_seconds() const { return samples_ > 1 ? (all_ - first_) / (samples_ - 1) : 0; }
  /// True if the findings can be evaluated: at least k_least samples, and k_share of what the picture may
  /// cost, at most k_most. `most`: samples of the finished picture. Only whole passes are judged, which end
  /// at powers of two.
  bool complete(const plan::Goal& goal, std::optional<double> seconds, uint32_t most) const {
    const uint32_t least = std::min(k_least, most >= 2 ? most / 2 * 2 : most);
    if (samples_ < least) return false;
    return samples_ >= std::min(k_most, most) ||
           (seconds ? all_ >= k_share * *seconds : samples_ >= k_share * goal.samples);
  }

 private:
  static constexpr uint32_t k_least = 4, k_most = 32;
  static constexpr double k_share = 0.03;
  uint32_t samples_ = 0;
  double all_ = 0, first_ = 0;
};

}  // namespace lucerna::session
