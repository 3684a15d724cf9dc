#pragma once
// Balanced sampling: samples go where they lower the squared error of the picture most.
//
// A block's squared error falls as v / n with n samples a pixel and variance v, so that a further sample
// lowers it by v / n^2. The sum over the picture is least for its number of samples where this gain is equal
// everywhere, n proportional to the root of v. (Adaptive sampling, which has a target, makes the errors equal
// instead.) All blocks first get some samples; then each round samples the blocks above the mean gain.
//
// The variance of a block is taken from the blocks around it, never from its own samples: more samples where
// these happened to meet rare light would bias its mean (scenes/glass at 64 samples a pixel: -.4 % so; -.08
// %, sd .02, by the neighbours', which depend a little on it in turn). So a single noisy block gets no more
// than its neighbours, and no block less than half of the mean number of samples. Pure functions of counts
// and errors: equal errors give equal schedules, whatever the machine's speed.
#include <cstdint>
#include <span>
#include <vector>

#include "schedule/region.h"
#include "schedule/work.h"

namespace lucerna::schedule {

struct BalancedOptions {
  uint32_t samples = 256;   ///< mean over the pixels of the region at which the picture is finished
  uint32_t first = 16;      ///< samples of every pixel before errors decide
  uint32_t slots = 131072;  ///< maximum number of paths at once, at least those of one block
  Rectangle region = {};    ///< blocks; others get no samples
};

class BalancedSchedule {
 public:
  /// Continues a picture whose blocks, in raster order, have these samples a pixel; no sample is repeated or
  /// left out.
  BalancedSchedule(uint32_t blocks_across, const BalancedOptions& options, std::vector<uint32_t> have);

  bool done() const { return round_.empty() && !waits_; }
  /// True if errors decide the next round: then call judge() before next().
  bool waits() const { return waits_; }
  /// `squares`: present squared error of every block of the picture, in raster order, in any unit.
  void judge(std::span<const float> squares);
  /// The next work item; empty when done, or while it waits.
  WorkItem next();
  /// Changes the wanted mean at any time; a round in progress is completed.
  void set_samples(uint32_t samples);

  /// Samples a pixel of every block, in raster order.
  const std::vector<uint32_t>& counts() const { return counts_; }
  /// Over the pixels of the region.
  uint32_t least_samples() const;
  uint32_t most_samples() const;
  double mean_samples() const;
  /// ... when the present round began. It does not depend on how rounds are cut into items.
  double mean_before_round() const { return mean_before_; }
  /// Complete rounds.
  uint32_t rounds() const { return rounds_; }
  const BalancedOptions& options() const { return options_; }

 private:
  /// Starts a round that needs no errors, or waits for them.
  void start_round();
  /// Estimated gain of each block of the region by one more sample.
  std::vector<double> gains(std::span<const float> squares) const;

  BalancedOptions options_;
  uint32_t across_ = 0;
  std::vector<uint32_t> counts_;  // of every block of the picture
  std::vector<uint32_t> blocks_;  // of the region, in raster order
  std::vector<uint32_t> round_;   // blocks of this round
  uint32_t pass_ = 1;             // samples a pixel in this round
  size_t at_ = 0;                 // in round_
  double mean_before_ = 0;
  uint32_t rounds_ = 0;
  bool waits_ = false;
};

}  // namespace lucerna::schedule
