#include "solvers/irradiance_cache/probed_blocks.h"

#include <algorithm>

namespace lucerna::irradiance_cache {

void ProbedBlocks::begin(uint32_t across, uint32_t down, uint32_t pass) {
  const bool all = pass < k_all_over || across != across_ || down != down_;
  across_ = across, down_ = down;
  const auto near_uncovered = [&](uint32_t x, uint32_t y) {
    for (uint32_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, down - 1); ++v)
      for (uint32_t u = x > 0 ? x - 1 : 0; u <= std::min(x + 1, across - 1); ++u)
        if (uncovered_before_[v * across + u]) return true;
    return false;
  };
  list_.clear(), quiet_.clear();
  uint32_t rest = 0, seen = 0;
  for (uint32_t y = 0; y < down; ++y)
    for (uint32_t x = 0; x < across; ++x) {
      const bool quiet = !all && !near_uncovered(x, y);
      rest += quiet;
      // One of each 2x2 blocks; all within four passes.
      if (quiet && (x % 2 + 2 * (y % 2)) != pass % 4) continue;
      seen += quiet;
      list_.push_back(y * across + x);
      quiet_.push_back(quiet);
    }
  if (list_.empty()) list_ = {0}, quiet_ = {true}, seen = 1;  // a picture of few blocks
  share_ = seen > 0 ? double(rest) / seen : 1;
  uncovered_.assign(size_t{across} * down, false);
}

}  // namespace lucerna::irradiance_cache
