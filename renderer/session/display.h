#pragma once
// What the window shows of the picture while it is made (film/preview.h), and the drafts that this needs.
// Batch rendering has none of it.
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

  /// The picture begins anew, of other light or as seen from elsewhere. `scale`: what an edit is known to
  /// multiply all light by. `same_light`: it changes none of it, only how it is computed or seen.
  void restart(const scene::Changes& changes, const vec3& scale, bool same_light);
  /// Before that, and before the film is cleared of which every pixel has samples: it is what has been shown,
  /// where plain() has been told so. Whether it is.
  bool take(gpu::Stream& stream, const film::Film& film);
  /// What was looked up so far is not the light any more that will be, or that comes from now on: drafts
  /// begin anew, and what they have shown stays until the new is better.
  void light_changed();
  /// Groups of lights are mixed otherwise: what has been shown is not what is to be seen.
  void mixed();

  DraftPlan& plan() { return plan_; }
  /// Whether it is not known yet, and can be, what surfaces the pixels show of a picture that is previewed.
  bool sight_wanted(const Engine& engine, const PictureView& view) const {
    return sight_.wanted(engine, view);
  }
  PixelSight& sight() { return sight_; }
  /// Another sample of a draft, or a piece of what pixels show. `coarse`: the film of a quarter of the
  /// resolution. False when it was cancelled.
  bool draw(DraftPlan::Next what, Engine& engine, const PictureView& view, film::Film& coarse,
            const std::function<bool()>& cancel);
  /// Whether pictures of that layer and size are previewed at all.
  bool shows(const film::View& view, const film::Film& film) const;
  /// Film -> its picture; what was there before, where neither the film nor a draft has new light. `samples`:
  /// that every pixel has; `begun`: some have one.
  void develop(Engine& engine, const PictureView& view, const film::Film& film, const film::Film& coarse,
               const film::View& shown, uint32_t samples, bool begun);
  /// What the first edit will need is made ready; a thing to do once there is a picture.
  void warm(gpu::Stream& stream, const film::Film& film);
  /// Whether what was there before can be shown at once.
  bool remembers() const { return preview_.has_history(); }
  /// Grows with all that changes what develop() brings, but samples of the film and how it is shown.
  uint64_t version() const { return version_; }
  /// Of the picture developed last.
  film::PreviewShares shares() const { return shares_; }
  /// The film has been filtered, and that is shown.
  void show_filtered(gpu::Stream& stream, const film::Film& film, const film::FilterError& error,
                     const film::View& shown);
  /// The error of that picture is estimated again, by the samples that the film has got since.
  void judge_filtered(gpu::Stream& stream, const film::Film& film);
  std::optional<film::ShownError> filtered_error() const { return filtered_error_; }
  /// It was developed without a preview.
  void plain(const Engine& engine, const PictureView& view, const film::View& shown);

 private:
  gpu::Device& device_;
  film::Preview preview_;
  std::unique_ptr<film::Film> fine_;  ///< of half the resolution; made when it is called for
  DraftPlan plan_;
  PixelSight sight_;
  film::PreviewShares shares_;
  std::optional<film::ShownError> filtered_error_;
  bool developed_ = false, warm_ = false;
  uint64_t version_ = 0;
  /// How the picture was shown that is not a preview.
  struct Plain {
    film::PreviewCamera camera;
    film::View shown;
  };
  std::optional<Plain> plain_;
};

}  // namespace lucerna::session
