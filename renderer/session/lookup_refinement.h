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
  void restart() { errors_of_ = nullptr, weighing_ = {}; }
  /// Runs one work item, if there is one: then true, or false if cancelled. Requires an engine.
  std::optional<bool> step(const std::function<bool()>& cancel);

 private:
  std::optional<bool> refine(const PictureView& view, const std::function<bool()>& cancel);
  /// Begins to refine if that pays at this number of samples.
  bool begin(solvers::Refinement& refinement);
  /// Factor on the `paths` spent on lookup data at which a further path reduces the picture's squared error
  /// as much there as in the picture; 1: not more than now.
  double balanced(uint64_t paths) const;

  /// Refinement at one number of samples.
  struct Weighing {
    uint32_t samples = 0;
    uint64_t most_paths = 0;    ///< at which it ends
    uint64_t paths_before = 0;  ///< at the beginning of the latest refinement
    uint32_t idle = 0;          ///< consecutive refinements that needed no path
    bool over = false;
  };

  const SetupContext& context_;
  Setup& setup_;
  const Sampling& sampling_;
  const ImageProgress& progress_;
  const solvers::Solver* errors_of_ = nullptr;  ///< solver whose errors were being estimated
  Weighing weighing_;
};

}  // namespace lucerna::session
