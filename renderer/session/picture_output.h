#pragma once
// The present picture for display and files: developed with the settings' view, filtered, previewed in the
// window, held, saved. A pending mix of light groups is settled first, unless stated otherwise.
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "film/exposure.h"
#include "film/io/image_file.h"
#include "session/display.h"
#include "session/filtered.h"
#include "session/group_mix.h"
#include "session/held_picture.h"
#include "session/ocio_table.h"
#include "session/overlays.h"
#include "session/window_filter.h"

namespace lucerna::session {

class PictureOutput {
 public:
  /// All must outlive it.
  PictureOutput(const SetupContext& context, Setup& setup, const Sampling& sampling,
                const ImageProgress& progress, GroupMix& mix, Overlays& overlays)
      : context_(context),
        setup_(setup),
        sampling_(sampling),
        progress_(progress),
        mix_(mix),
        overlays_(overlays) {}

  /// Layer, components, exposure and tone curve by the settings.
  film::View view() const;
  /// Tone-mapped picture with that view, or a heat map on view().heat's scale, with tiles if overlay.tiles is
  /// on. `cancel` is called while solvers draw overlays; true: the picture is already out of date. With
  /// overlays it is larger by Overlays::scale().
  std::vector<uint8_t> picture(bool with_coarse, const std::function<bool()>& cancel = {});
  /// Likewise, as shown in the window during rendering (Display), with the setting preview.filter; without a
  /// preview, picture(with_coarse). A mix may be shown before it is settled.
  std::vector<uint8_t> shown_picture(bool with_coarse, const std::function<bool()>& cancel = {});
  /// True if shown_picture() would return the same as before, provided settings and scene are unchanged: no
  /// new samples, and no changed overlay.
  bool shows_the_same() const;
  /// True if shown_picture() can show the former picture before there is new light.
  bool remembers() const;
  /// True if the window shows a preview in that view.
  bool previewed(const film::View& view) const;
  /// Shares of the latest shown_picture().
  film::PreviewShares preview_shares() const;
  /// Display::former_is_preview
  bool former_is_preview() const { return display_ && display_->former_is_preview(); }

  /// Brightness of the picture, or at a point (0..1 to the right and down): of the coarse image while there
  /// is no other. Throws Error if there is none. Settles no mix.
  film::Brightness measure(std::optional<vec2> at) const;
  /// The light of the shown picture: of the layer and the components that view() shows. Throws Error if it
  /// has no sample, or shows a layer that is no light.
  HeldPicture held_picture();
  /// The image with its layers and metadata (including its noise), as in EXR files.
  film::FilmImage film_image();
  /// film_image() with add_noise_layers(). Throws Error if there is no sample.
  film::FilmImage film_image_with_halves();
  /// Writes film_image() as EXR, or the picture with exposure and tone curve as PNG; `as_shown`: including
  /// the preview's filter, if on. Throws Error located at `file`.
  void save(const std::filesystem::path& file, bool as_shown = false);

  /// Filters the present picture (film/filter/): until its next sample, film_image() contains the filtered
  /// layers too, and save() writes the filtered picture as PNG. Throws Error if there is no picture, or not
  /// enough memory.
  const Filtered& filter();
  /// Result of filter() for the present picture; null: none.
  const Filtered* filtered() const;
  /// True if step_filter() has work: it filters the picture for the window (WindowFilter).
  bool filter_due() const;
  void step_filter(const std::function<bool()>& cancel);
  /// True if shown_picture() has a new filtered picture since the last call.
  bool filter_news() { return window_filter_ && window_filter_->news(); }
  void forget_filtered();
  /// Call when there may be enough memory again.
  void retry_filter() {
    if (window_filter_) window_filter_->retry();
  }

  /// Null in batch.
  Display* display() { return display_.get(); }
  /// What only the window needs, made with its kernels.
  struct WindowParts {
    std::unique_ptr<Display> display;
    std::unique_ptr<WindowFilter> filter;
  };
  /// Those that are missing; `again`: those whose kernels must be compiled again. Throws Error.
  WindowParts make_window_parts(bool again) const;
  void adopt(WindowParts parts) noexcept;
  /// Table for the settings, for set_ocio(). Throws Error like session::ocio_table.
  std::shared_ptr<const OcioTable> ocio_for(const plan::Settings& settings) const {
    return ocio_table(context_.device, settings, ocio_);
  }
  void set_ocio(std::shared_ptr<const OcioTable> table) noexcept {
    ocio_ = std::move(table);
    setup_.ocio_white = ocio_ ? ocio_->white : 0;
  }

  /// Call when the mix has changed.
  void mixed();
  /// Call before another picture begins, while the film still holds samples of every pixel: the window then
  /// shows it as the former picture. `factors`: known factors of the edit on the groups' light, which differ;
  /// null: none. True if it is shown.
  bool keep_former(const std::vector<vec3>* factors);
  /// Call when the picture begins (Display::restart).
  bool restart(const scene::Changes& changes, const vec3& scale, bool same_light, float doubt, uint64_t light,
               uint64_t now);
  /// Estimates the error of the window's filtered picture again, from the samples added since.
  void judge_filtered();
  /// Call after a work item that took that time [s].
  void worked(double seconds);

 private:
  PictureView picture_view() const { return setup_.view(context_.automaton); }
  const transport::TransportStats& stats() const { return setup_.engine->wavefront().stats(); }
  /// film_image() of the film's image.
  film::FilmImage layers_of(const film::Image& image) const;
  std::vector<uint8_t> picture_of(const Filtered& filtered, const film::View& view,
                                  const std::function<bool()>& cancel);
  HeldPicture described() const;  ///< a held picture without its light
  FilterJob filter_job() const;
  WindowFilter::Progress filter_progress() const;
  /// True if the window filters pictures in that view.
  bool filters(const film::View& view) const;
  /// The window's filtered picture, if that view shows it; else null.
  const Filtered* shown_filtered(const film::View& view) const;
  void mark_tiles(const film::View& view);
  film::HeatScale heat_scale(uint32_t layer) const;

  const SetupContext& context_;
  Setup& setup_;
  const Sampling& sampling_;
  const ImageProgress& progress_;
  GroupMix& mix_;
  Overlays& overlays_;
  std::optional<Filtered> filtered_;             ///< by filter()
  std::unique_ptr<WindowFilter> window_filter_;  ///< null in batch
  std::unique_ptr<Display> display_;             ///< null in batch
  struct {
    uint64_t version = ~uint64_t{0}, paths = 0;
    bool filtered = false;
  } shown_;                                ///< Display::version() and paths of the latest shown preview
  std::shared_ptr<const OcioTable> ocio_;  ///< null: the tone curve
};

}  // namespace lucerna::session
