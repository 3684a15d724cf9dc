#pragma once
// Which blocks of the picture a pass looks along. Most of it has all its records after a few passes, and
// paths sent there again find nothing: so later passes look where paths have asked in the last one, at the
// blocks around those, and at one of four of the rest, which takes turns. What is not looked at is stood for
// by that fourth, so that how much of the picture asks is estimated without bias. No device: pure state.
#include <cstdint>
#include <vector>

namespace lucerna::irradiance_cache {

class ProbedBlocks {
 public:
  /// Passes that look all over the picture: most of it asks in them.
  static constexpr uint32_t k_all_over = 2;

  /// The pass of that number begins, over a picture of that many blocks.
  void begin(uint32_t across, uint32_t down, uint32_t pass);

  /// Those looked at, in raster order.
  const std::vector<uint32_t>& list() const { return list_; }
  /// How many blocks the one at this place of the list stands for: at least 1.
  double stands_for(uint32_t place) const { return quiet_[place] ? share_ : 1; }
  /// Paths have asked there, in what is the last pass when the next begins.
  void note(uint32_t block) { uncovered_[block] = true; }
  /// The pass is over: what was noted counts from now on.
  void end() { uncovered_before_ = uncovered_; }

 private:
  uint32_t across_ = 0, down_ = 0;
  std::vector<uint32_t> list_;
  std::vector<bool> quiet_;                         // by place in the list: one of the rest
  double share_ = 1;                                // blocks of the rest that each of these stands for
  std::vector<bool> uncovered_, uncovered_before_;  // by block: in this pass, in the last
};

}  // namespace lucerna::irradiance_cache
