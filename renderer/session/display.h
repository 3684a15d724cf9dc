#pragma once
// The window's picture during rendering (film/preview.h), and its preview samples. Not used in batch
// rendering.
#include <memory>
#include <optional>

#include "film/filter/filter_error.h"
#include "film/preview.h"
#include "scene/change.h"
#include "session/draft_plan.h"
#include "session/engine.h"
#include "session/pixel_sight.h"

namespace lucerna::session {

class Display {
 public:
  Display(gpu::Device& device, gpu::ShaderCompiler& compiler)
      : device_(device), preview_(device, compiler), sight_(device, compiler) {}

  /// Call when the picture begins with other light or another view. `scale`: known factor of the edit on all
  /// light. `same_light`: only the computation or the view has changed. `doubt`, `light`: as in
  /// film::Preview::keep. `now`: number of the new light. True if the former picture has that light.
  bool restart(const scene::Changes& changes, const vec3& scale, bool same_light, float doubt, uint64_t light,
               uint64_t now);
  /// Call before that, while the film still holds samples of every pixel: keeps it as the shown picture, if
  /// plain() says so. `noise`: factor on the standard errors of its halves. True if taken.
  bool take(gpu::Stream& stream, const film::Film& film, double noise = 1);
  /// Cached lighting changed: restarts preview accumulation. The old preview stays until the new one is
  /// better.
  void light_changed();
  /// Call when the mix of light groups changes: the shown picture is out of date.
  void mixed();

  DraftPlan& plan() { return plan_; }
  /// True if the primary-visibility buffer is missing and can be traced.
  bool sight_wanted(const Engine& engine, const PictureView& view) const {
    return sight_.wanted(engine, view);
  }
  /// Call after restart() if the former light is this picture's, whose solvers have been chosen meanwhile.
  void goes_on() { former_is_preview_ = true; }
  PixelSight& sight() { return sight_; }
  /// Rays of the preview samples at a quarter of the resolution so far.
  uint64_t coarse_rays() const { return coarse_rays_; }
  /// Traces another preview sample, or a part of the visible surfaces. `coarse`: film of a quarter of the
  /// resolution. False if cancelled.
  bool draw(DraftPlan::Next what, Engine& engine, const PictureView& view, film::Film& coarse,
            const std::function<bool()>& cancel);
  /// True if pictures of that layer and size have a preview.
  bool shows(const film::View& view, const film::Film& film) const;
  /// Film -> its picture; the former picture, where neither film nor preview samples have new light.
  /// `samples`: of every pixel; `begun`: some pixels have one.
  void develop(Engine& engine, const PictureView& view, const film::Film& film, const film::Film& coarse,
               const film::View& shown, uint32_t samples, bool begun);
  /// Prepares for the first edit; call once there is a picture.
  void warm(gpu::Stream& stream, const film::Film& film);
  /// True if the former picture can be shown at once.
  bool remembers() const { return preview_.has_history(); }
  /// Changes whenever the result of develop() does, apart from film samples and display settings.
  uint64_t version() const { return version_; }
  /// film::Preview::shown_light of the latest developed picture.
  std::vector<vec3> shown_light(uint32_t components) const { return preview_.shown_light(components); }
  /// Shares of the latest developed picture.
  film::PreviewShares shares() const { return shares_; }
  /// True if the former light is of this picture's preview, from before light_changed() or goes_on(); false:
  /// from before an edit.
  bool former_is_preview() const { return former_is_preview_; }
  /// Call when the film has been filtered and that is shown.
  void show_filtered(gpu::Stream& stream, const film::Film& film, const film::FilterError& error,
                     const film::View& shown);
  /// Estimates the error of that picture again, from the samples added since.
  void judge_filtered(gpu::Stream& stream, const film::Film& film);
  std::optional<film::ShownError> filtered_error() const { return filtered_error_; }
  /// Marks a picture developed without a preview.
  void plain(const Engine& engine, const PictureView& view, const film::View& shown);

 private:
  gpu::Device& device_;
  film::Preview preview_;
  std::unique_ptr<film::Film> fine_;  ///< of half the resolution; made at the first use
  DraftPlan plan_;
  PixelSight sight_;
  film::PreviewShares shares_;
  std::optional<film::ShownError> filtered_error_;
  bool developed_ = false, warm_ = false, former_is_preview_ = false;
  uint64_t version_ = 0, coarse_rays_ = 0;
  /// Display settings of a picture without a preview.
  struct Plain {
    film::PreviewCamera camera;
    film::View shown;
  };
  std::optional<Plain> plain_;
};

}  // namespace lucerna::session
