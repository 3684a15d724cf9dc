#pragma once
// Measures what the solvers chosen by a pilot really cost, once a picture with a limit of time has its first
// samples: the choice is then made again (plan/choose.h).
#include <cstdint>
#include <optional>

#include "solvers/prospect.h"

namespace lucerna::session {

class ChoiceReview {
 public:
  /// Call when a picture begins, and when solvers have been chosen for it.
  void restart() { *this = {}; }
  /// Call after a work item: whole samples of the picture so far, and its time with preparation [s]. The cost
  /// once it is known, from the last pass: kernels are compiled during the first ones. Costs are in
  /// `sample_seconds`, the time of a path-traced sample (above 0).
  std::optional<solvers::Findings::Begun> note(uint32_t samples, double seconds, double sample_seconds) {
    if (samples == samples_) return std::nullopt;
    const double each = (seconds - seconds_) / (samples - samples_);
    samples_ = samples, seconds_ = seconds;
    if (samples < k_measured) return std::nullopt;
    return solvers::Findings::Begun{.solvers = {},
                                    .samples = double(samples),
                                    .sample = each / sample_seconds,
                                    .spent = seconds / sample_seconds};
  }

 private:
  static constexpr uint32_t k_measured = 8;
  uint32_t samples_ = 0;  ///< after the last complete pass
  double seconds_ = 0;
};

}  // namespace lucerna::session
