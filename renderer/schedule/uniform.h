#pragma once
// Uniform sampling: the same number of samples for every pixel, cut into work items. Pure functions of
// counts.
#include <algorithm>
#include <cstdint>

namespace lucerna::schedule {

/// A work item: all pixels of consecutive 8x8 tiles, consecutive samples.
struct WorkItem {
  uint32_t first_tile = 0, tile_count = 0;
  uint32_t first_sample = 0, sample_count = 0;
  uint32_t slots() const { return tile_count * 64 * sample_count; }
};

/// Passes over the picture; in a pass every tile gets the same samples. The image does not depend on how
/// items are cut.
class UniformSchedule {
 public:
  UniformSchedule() = default;
  UniformSchedule(uint32_t tiles, uint32_t samples, uint32_t slots_at_once)
      : tiles_(tiles), samples_(samples), slots_(slots_at_once) {
    start_pass();
  }
  bool done() const { return sample_ >= samples_ || tiles_ == 0; }
  /// Samples that every pixel has.
  uint32_t complete() const { return std::min(sample_, samples_); }
  /// More may be asked for (or fewer) at any time.
  void set_samples(uint32_t samples) { samples_ = samples; }
  uint32_t samples() const { return samples_; }

  WorkItem next() {
    const uint32_t tiles_at_once = std::max(1u, slots_ / (64 * pass_));
    WorkItem item{tile_, std::min(tiles_at_once, tiles_ - tile_), sample_, pass_};
    tile_ += item.tile_count;
    if (tile_ == tiles_) {
      tile_ = 0;
      sample_ += pass_;
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
    const uint32_t fitting = std::max(k_least_pass, slots_ / std::max(1u, 64 * tiles_));
    pass_ = std::min({fitting, std::max(1u, sample_), samples_ - sample_});
  }
  uint32_t tiles_ = 0, samples_ = 0, slots_ = 64;
  uint32_t tile_ = 0, sample_ = 0, pass_ = 1;
};

}  // namespace lucerna::schedule
