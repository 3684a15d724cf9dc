#pragma once
// Selects the blocks of the picture that a pass probes. After a few passes most blocks have all their
// records, and more paths there find no gaps. Later passes therefore probe blocks where paths found gaps in
// the last pass, the blocks around those, and one in four of the rest, in turn. The probed fourth represents
// the rest, so the share of uncovered paths is estimated without bias. Pure state; no device.
#include <cstdint>
#include <vector>

namespace lucerna::irradiance_cache {

class ProbedBlocks {
 public:
  /// Passes that probe the whole picture, most of which is uncovered.
  static constexpr uint32_t k_all_over = 2;

  /// Starts that pass, over a picture of that many blocks.
  void begin(uint32_t across, uint32_t down, uint32_t pass);

  /// The probed blocks, in raster order.
  const std::vector<uint32_t>& list() const { return list_; }
  /// Number of blocks that the one at this place of the list represents: at least 1.
  double stands_for(uint32_t place) const { return quiet_[place] ? share_ : 1; }
  /// Marks a block with uncovered paths, for the next pass.
  void note(uint32_t block) { uncovered_[block] = true; }
  /// Ends the pass: the marks take effect.
  void end() { uncovered_before_ = uncovered_; }

 private:
  uint32_t across_ = 0, down_ = 0;
  std::vector<uint32_t> list_;
  std::vector<bool> quiet_;                         // by place in the list: one of the rest
  double share_ = 1;                                // blocks of the rest that each of these represents
  std::vector<bool> uncovered_, uncovered_before_;  // by block: in this pass, in the last one
};

}  // namespace lucerna::irradiance_cache
