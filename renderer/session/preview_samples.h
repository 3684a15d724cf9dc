#pragma once
// Preview samples of the window: what it shows of a picture until the film is filled.
#include <functional>
#include <optional>

#include "session/picture_output.h"
#include "solvers/prospect.h"
#include "stats/forecast.h"

namespace lucerna::session {

class PreviewSamples {
 public:
  /// All must outlive it.
  PreviewSamples(const SetupContext& context, Setup& setup, const Sampling& sampling, ImageProgress& progress,
                 PictureOutput& output)
      : context_(context), setup_(setup), sampling_(sampling), progress_(progress), output_(output) {}

  /// Traces a preview sample at lower resolution if it is time for one; the first comes at once, at a quarter
  /// of the resolution. Its paths, rays and time are not in the wavefront's statistics. False if nothing was
  /// traced; always in batch.
  bool draw(const std::function<bool()>& cancel = {});
  /// True if there is a sample of the present light; samples restart when that improves.
  bool begun() { return plan() && plan()->begun(); }
  /// DraftPlan::news() of the latest draw().
  bool news() { return plan() && plan()->news(); }
  /// Pace of pure path tracing, measured with samples before there was lookup data; nullopt without such
  /// samples.
  std::optional<stats::SamplePace> path_pace() const;
  /// What the preview samples at a quarter of the resolution say of path tracing, once they are complete: a
  /// pilot that comes sooner than the picture's own first samples. nullopt: not yet, or of too few paths.
  std::optional<solvers::Findings> findings();
  /// Call when another picture begins. `same_light`: its light is known from the former one.
  void restart(bool same_light);

 private:
  /// Null in batch.
  DraftPlan* plan() { return output_.display() ? &output_.display()->plan() : nullptr; }
  /// Call after a coarse sample, with its duration [s].
  void note_pace(double seconds);

  const SetupContext& context_;
  Setup& setup_;
  const Sampling& sampling_;
  ImageProgress& progress_;
  PictureOutput& output_;
  bool preparing_ = false;                 ///< state at the latest sample
  double coarse_s_ = 0;                    ///< of the coarse samples since they began
  std::optional<stats::SamplePace> pace_;  ///< for a picture of one pixel
};

}  // namespace lucerna::session
