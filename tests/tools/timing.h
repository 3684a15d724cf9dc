#pragma once
// Repeated timings of single parts.
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "base/timer.h"

namespace lucerna::tools {

/// Seconds of several repeats.
struct Timing {
  double median = 0, low = 0, high = 0;
};

/// Requires at least one value.
inline Timing timing_of(std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  const size_t n = seconds.size();
  return {n % 2 ? seconds[n / 2] : 0.5 * (seconds[n / 2 - 1] + seconds[n / 2]), seconds.front(),
          seconds.back()};
}

/// A timed function; `before` is not timed.
struct Timed {
  std::function<void()> before, run;
};

/// Runs the candidates alternately, `repeats` times, after one untimed round (kernels compile at their first
/// dispatch on software devices), so a machine that slows down affects all equally.
inline std::vector<Timing> take_turns(const std::vector<Timed>& candidates, int repeats) {
  std::vector<std::vector<double>> seconds(candidates.size());
  for (int round = 0; round <= repeats; ++round)
    for (size_t i = 0; i < candidates.size(); ++i) {
      if (candidates[i].before) candidates[i].before();
      const Timer timer;
      candidates[i].run();
      if (round > 0) seconds[i].push_back(timer.seconds());
    }
  std::vector<Timing> timings;
  for (auto& s : seconds) timings.push_back(timing_of(std::move(s)));
  return timings;
}

}  // namespace lucerna::tools
