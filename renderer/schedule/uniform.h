#pragma once
// Uniform sampling: the same number of samples for every pixel, cut into work items. Pure functions of
// counts.
#include <algorithm>

#include "schedule/work.h"

namespace lucerna::schedule {

/// Passes over the picture; in a pass every block gets the same samples. The image does not depend on how
/// items are cut.
class UniformSchedule {
 public:
  UniformSchedule() = default;
  UniformSchedule(uint32_t blocks, uint32_t samples, uint32_t slots_at_once)
      : blocks_(blocks), samples_(samples), slots_(slots_at_once) {
    start_pass();
  }
  bool done() const { return sample_ >= samples_ || blocks_ == 0; }
  /// Samples that every pixel has.
  uint32_t complete() const { return std::min(sample_, samples_); }
  /// More may be asked for (or fewer) at any time.
  void set_samples(uint32_t samples) { samples_ = samples; }
  uint32_t samples() const { return samples_; }
  /// Passes that are complete.
  uint32_t passes() const { return passes_; }

  WorkItem next() {
    const uint32_t blocks_at_once = std::max(1u, slots_ / (64 * pass_));
    WorkItem item{{}, pass_};
    for (uint32_t end = std::min(blocks_, block_ + blocks_at_once); block_ < end; ++block_)
      item.blocks.push_back({block_, sample_});
    if (block_ == blocks_) {
      block_ = 0;
      sample_ += pass_;
      ++passes_;
      start_pass();
    }
    return item;
  }

 private:
  static constexpr uint32_t k_least_pass = 16;
  void start_pass() {
    if (done()) return;
    // The first passes are single, so that something is seen at once; then as many samples as fill the
    // device, or twice as many as before: adding to the film costs the same for one sample as for several.
    const uint32_t fitting = std::max(k_least_pass, slots_ / std::max(1u, 64 * blocks_));
    pass_ = std::min({fitting, std::max(1u, sample_), samples_ - sample_});
  }
  uint32_t blocks_ = 0, samples_ = 0, slots_ = 64;
  uint32_t block_ = 0, sample_ = 0, pass_ = 1, passes_ = 0;
};

}  // namespace lucerna::schedule
