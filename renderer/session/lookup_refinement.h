#pragma once
// Work on the lookup data of a picture that has samples: estimates of its errors, and refinement where that
// reduces the picture's error more than as many samples.
#include <functional>
#include <optional>

#include "session/image_progress.h"
#include "session/sampling.h"
#include "session/transaction.h"

namespace lucerna::session {

class LookupRefinement {
 public:
  /// All must outlive it.
  LookupRefinement(const SetupContext& context, Setup& setup, const Sampling& sampling,
                   const ImageProgress& progress)
      : context_(context), setup_(setup), sampling_(sampling), progress_(progress) {}

  /// Call when another picture begins.
  void restart() { errors_of_ = nullptr, weighed_at_ = balanced_at_ = 0; }
  /// Runs one work item, if there is one: then true, or false if cancelled. Requires an engine.
  std::optional<bool> step(const std::function<bool()>& cancel);

 private:
  std::optional<bool> refine(const PictureView& view, const std::function<bool()>& cancel);
  /// Factor on the `paths` spent on lookup data at which a further path reduces the picture's squared error
  /// as much there as in the picture; 1: not more than now.
  double balanced(uint64_t paths) const;

  const SetupContext& context_;
  Setup& setup_;
  const Sampling& sampling_;
  const ImageProgress& progress_;
  const solvers::Solver* errors_of_ = nullptr;  ///< solver whose errors were being estimated
  uint64_t most_paths_ = 0;                     ///< where refinement ends at that number of samples
  uint64_t paths_before_ = 0;                   ///< at the begin of the latest refinement
  uint32_t idle_ = 0;                           ///< consecutive refinements that needed no path
  uint32_t balanced_at_ = 0;                    ///< samples at which nothing was left to refine
  uint32_t weighed_at_ = 0;                     ///< samples at the latest balanced()
};

}  // namespace lucerna::session
