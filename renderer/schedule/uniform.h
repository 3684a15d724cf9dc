#pragma once
// Uniform sampling: the same number of samples for every pixel, cut into work items. Pure functions of
// counts.
#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "schedule/work.h"

namespace lucerna::schedule {

/// Passes over the picture; in a pass every block gets the same samples. The image does not depend on how
/// items are cut.
class UniformSchedule {
 public:
  UniformSchedule() = default;
  /// `one_sample`: passes are of one sample a pixel, which all items of a pass share.
  UniformSchedule(uint32_t blocks, uint32_t samples, uint32_t slots_at_once, bool one_sample = false)
      : blocks_(blocks), samples_(samples), slots_(slots_at_once), one_sample_(one_sample) {
    start_pass();
  }
  /// Continues a picture whose blocks have these samples a pixel, in raster order: those with the fewest
  /// catch up first. No sample is repeated or left out.
  UniformSchedule(std::vector<uint32_t> have, uint32_t samples, uint32_t slots_at_once,
                  bool one_sample = false)
      : blocks_(static_cast<uint32_t>(have.size())),
        samples_(samples),
        slots_(slots_at_once),
        one_sample_(one_sample),
        have_(std::move(have)) {
    start_pass();
  }
  /// Likewise, but only `blocks` (in raster order) get samples; the others keep those they have.
  UniformSchedule(std::vector<uint32_t> have, std::vector<uint32_t> blocks, uint32_t samples,
                  uint32_t slots_at_once, bool one_sample = false)
      : blocks_(static_cast<uint32_t>(blocks.size())),
        samples_(samples),
        slots_(slots_at_once),
        one_sample_(one_sample),
        all_(std::move(have)),
        index_(std::move(blocks)) {
    for (const uint32_t b : index_) have_.push_back(all_[b]);
    start_pass();
  }
  bool done() const { return sample_ >= samples_ || blocks_ == 0; }
  /// Minimum number of samples of a pixel of these blocks; above samples() if that was reduced later.
  uint32_t complete() const { return sample_; }
  /// Changes the wanted number at any time. A pass in progress is completed unchanged.
  void set_samples(uint32_t samples) {
    samples_ = samples;
    if (block_ == 0) start_pass();
  }
  uint32_t samples() const { return samples_; }
  /// Number of complete passes.
  uint32_t passes() const { return passes_; }

  /// Samples a pixel of every block of the picture, in raster order.
  std::vector<uint32_t> counts() const {
    std::vector<uint32_t> counts = have_;
    if (counts.empty()) {
      counts.assign(blocks_, complete());
      for (uint32_t b = 0; b < block_; ++b) counts[b] += pass_;
    }
    if (index_.empty()) return counts;
    std::vector<uint32_t> all = all_;
    for (size_t i = 0; i < index_.size(); ++i) all[index_[i]] = counts[i];
    return all;
  }

  WorkItem next() {
    const uint32_t blocks_at_once = std::max(1u, slots_ / (64 * pass_));
    WorkItem item{{}, pass_};
    const auto ahead = [&] { return !have_.empty() && have_[block_] != sample_; };
    for (; block_ < blocks_ && (item.blocks.size() < blocks_at_once || ahead()); ++block_) {
      if (ahead()) continue;
      item.blocks.push_back({index_.empty() ? block_ : index_[block_], sample_});
      if (!have_.empty()) have_[block_] += pass_;
    }
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
    uint32_t level = samples_;  // maximum samples of the pass
    uint32_t behind = blocks_;
    if (!have_.empty()) {
      sample_ = *std::min_element(have_.begin(), have_.end());
      behind = static_cast<uint32_t>(std::count(have_.begin(), have_.end(), sample_));
      for (const uint32_t n : have_)
        if (n > sample_) level = std::min(level, n);
      if (behind == blocks_) have_.clear();
    }
    if (done()) return;
    // The first passes have one sample, so that a picture appears soon; then as many samples as fill the
    // device, or twice as many as before: adding to the film costs the same for one sample as for several.
    const uint32_t fitting = std::max(k_least_pass, slots_ / std::max(1u, 64 * behind));
    // Passes end at every power of two, whatever fits.
    const uint32_t next_power = sample_ > 0 ? 2 * std::bit_floor(sample_) : 1;
    pass_ = one_sample_ ? 1 : std::min({fitting, next_power - sample_, level - sample_});
  }
  uint32_t blocks_ = 0, samples_ = 0, slots_ = 64;
  uint32_t block_ = 0, sample_ = 0, pass_ = 1, passes_ = 0;
  bool one_sample_ = false;
  std::vector<uint32_t> have_;  // samples of every block, while they differ; sample_ the least of them
  // Of a region: samples that all blocks of the picture had, and its blocks, which are counted from 0 above.
  std::vector<uint32_t> all_, index_;
};

}  // namespace lucerna::schedule
