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
  void restart() { first_.reset(); }
  /// Call after a work item: whole samples of the picture so far, and its time with preparation [s]. The cost
  /// once it is known, from the samples after the first, with which kernels are compiled; costs are in
  /// `sample_seconds`, the time of a path-traced sample (above 0).
  std::optional<solvers::Findings::Begun> note(uint32_t samples, double seconds, double sample_seconds) {
    if (samples == 0) return std::nullopt;
    if (!first_) first_ = First{samples, seconds};
    if (samples < first_->samples + k_measured) return std::nullopt;
    return solvers::Findings::Begun{
        .solvers = {},
        .samples = double(samples),
        .sample = (seconds - first_->seconds) / (samples - first_->samples) / sample_seconds,
        .spent = seconds / sample_seconds};
  }

 private:
  /// Samples that are measured: a single one may wait for a kernel.
  static constexpr uint32_t k_measured = 3;
  struct First {
    uint32_t samples;
    double seconds;
  };
  std::optional<First> first_;
};

}  // namespace lucerna::session
