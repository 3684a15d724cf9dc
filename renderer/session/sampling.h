#pragma once
// Uniform or adaptive sampling behind one interface: which pixels get samples next.
#include <algorithm>
#include <optional>
#include <vector>

#include "schedule/adaptive.h"
#include "schedule/region.h"
#include "schedule/uniform.h"

namespace lucerna::session {

class Sampling {
 public:
  /// `region`: blocks that get samples.
  void start(schedule::UniformSchedule schedule, const schedule::Rectangle& region) {
    uniform_ = std::move(schedule), adaptive_.reset();
    region_ = region;
  }
  void start(schedule::AdaptiveSchedule schedule) {
    adaptive_.emplace(std::move(schedule));
    region_ = adaptive_->options().region;
  }
  /// Blocks that get samples; without bounds: all. The numbers of samples below are of their pixels.
  const schedule::Rectangle& region() const { return region_; }
  bool whole() const { return region_ == schedule::Rectangle{}; }
  /// State of every tile; null in uniform sampling.
  const schedule::AdaptiveSchedule* adaptive() const { return adaptive_ ? &*adaptive_ : nullptr; }
  schedule::AdaptiveSchedule* adaptive() { return adaptive_ ? &*adaptive_ : nullptr; }
  schedule::UniformSchedule& uniform() { return uniform_; }

  bool done() const { return adaptive_ ? adaptive_->done() : uniform_.done(); }
  /// Number of samples that every pixel has.
  uint32_t samples() const { return adaptive_ ? adaptive_->least_samples() : uniform_.complete(); }
  /// Number of samples that some pixel has.
  uint32_t most_samples() const {
    if (!adaptive_) return uniform_.complete();
    if (!whole()) return adaptive_->most_samples();
    const std::vector<uint32_t> all = counts();
    return all.empty() ? 0 : *std::max_element(all.begin(), all.end());
  }
  /// Samples a pixel at which the image is finished; adaptive: maximum of any pixel.
  uint32_t max_samples() const { return adaptive_ ? adaptive_->options().max_samples : uniform_.samples(); }
  /// Complete passes over the picture, or over the active tiles.
  uint32_t passes() const { return adaptive_ ? adaptive_->rounds() : uniform_.passes(); }
  /// Samples of every block of the picture, in raster order.
  std::vector<uint32_t> counts() const { return adaptive_ ? adaptive_->counts() : uniform_.counts(); }

 private:
  schedule::UniformSchedule uniform_;
  std::optional<schedule::AdaptiveSchedule> adaptive_;  ///< replaces the uniform one
  schedule::Rectangle region_;
};

}  // namespace lucerna::session
