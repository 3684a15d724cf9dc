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
  /// Call after a work item of samples: whole samples of the picture so far, and the item's time [s] and
  /// rays.
  void note(uint32_t samples, double seconds, uint64_t rays) {
    all_ += seconds, pass_seconds_ += seconds, pass_rays_ += double(rays);
    if (samples == samples_) return;
    seconds_ = pass_seconds_ / (samples - samples_), rays_ = pass_rays_ / (samples - samples_);
    pass_seconds_ = pass_rays_ = 0, samples_ = samples;
  }
  /// Time of a sample [s], in the last pass: the first ones wait for kernels. 0: not known.
  double sample_seconds() const { return seconds_; }
  /// Rays of a sample, likewise.
  double sample_rays() const { return rays_; }
  /// True if the findings can be evaluated: at least k_least samples, and k_share of what the picture may
  /// cost, at most k_most. `most`: samples of the finished picture. Only whole passes are judged, which end
  /// at powers of two.
  bool complete(const plan::Goal& goal, std::optional<double> seconds, uint32_t most) const {
    const uint32_t least = most >= 2 ? std::min(k_least, most / 2 * 2) : most;
    if (samples_ < least) return false;
    return samples_ >= std::min(k_most, most) ||
           (seconds ? all_ >= k_share * *seconds : samples_ >= k_share * goal.samples);
  }

 private:
  static constexpr uint32_t k_least = 4, k_most = 32;
  static constexpr double k_share = 0.03;
  uint32_t samples_ = 0;
  double all_ = 0, pass_seconds_ = 0, pass_rays_ = 0, seconds_ = 0, rays_ = 0;
};

}  // namespace lucerna::session
