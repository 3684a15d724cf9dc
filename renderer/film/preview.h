#pragma once
// What the window shows of a picture until its samples are enough: their light filtered over surfaces that
// are alike, a draft of fewer pixels where there are none yet, and what was shown before an edit as far as
// the new light does not contradict it (shaders/film/preview_resolve.comp says how they are mixed). It is
// display only: the film, and what files get of it, know nothing of it.
//
// Filtering is done on a grid of half the picture's resolution, on light divided by the surface's colour: an
// edge-avoiding a-trous filter (H. Dammertz et al. 2010) that stops at differences of more than the noise (C.
// Schied et al. 2017), which the two halves of the samples tell of. A pixel whose samples have met several
// surfaces is shown as a mixture of what those around it that show each of them are.
#include <optional>

#include "film/film.h"
#include "film/shown_error.h"
#include "shaders/shared/preview.h"

namespace lucerna::film {

/// Of what is shown, 0..1.
struct PreviewShares {
  double stale = 0;     ///< light from before the last edit, by luminance
  double filtered = 0;  ///< filtered light of the present, by luminance
  /// Of the tiles, as samples have judged it that the pictures before had not used. None: no preview.
  std::optional<ShownError> error;
};

/// Of the film's pixels, which have samples.
enum class Sampled { none, some, all };

/// Where the picture was taken from.
struct PreviewCamera {
  shared::PreviewCamera axes{};
  bool orthographic = false;
  bool operator==(const PreviewCamera& o) const;
};

class Preview {
 public:
  /// Compiles its kernels; throws Error, located.
  Preview(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Whether pictures of that size can be previewed on this device.
  static bool fits(const gpu::Limits& limits, uint32_t width, uint32_t height);
  /// Nothing has been shown yet.
  void forget();
  /// The picture begins anew: what was shown last is what was there before. Its light is to be multiplied by
  /// `scale`, where an edit is known to do that to all light; `repainted`: surfaces may have other colours;
  /// `same_light`: light has not changed, no more than the camera or how light is computed.
  void keep(const vec3& scale = vec3(1), bool repainted = false, bool same_light = false);
  /// The picture begins anew with better light than it had so far. Of what was there before nothing has
  /// changed.
  void better();
  /// Film -> its picture, of the layers that show light (View::layer up to shared::k_layer_primary + 3).
  /// `draft`: a film of the same view with pixels of whole pixels, or null; `filtered`: noise is filtered,
  /// not only where there are no samples. `seen`: the surfaces that the film's pixels show, or null
  /// (shaders/film/preview_look.comp). Films must fit(). Throws Error when memory is short. The stream is
  /// run.
  PreviewShares develop(gpu::Stream& stream, const Film& film, const Film* draft, const View& view,
                        const PreviewCamera& camera, bool filtered, Sampled sampled = Sampled::some,
                        const gpu::Buffer* seen = nullptr);
  /// Whether anything is known from before the picture began anew.
  bool has_history() const { return history_.known; }
  /// Has the device compile what an edit needs – recall(), and develop() in other light –, which takes it
  /// seconds, so that the first one does not wait for it. After develop() or take(). The stream is run.
  void warm(gpu::Stream& stream, const Film& film);
  /// What was there before, as this camera sees it, becomes the film's picture: what can be shown at once,
  /// without any new light. has_history(). What comes into view is taken from what is beside it. Throws and
  /// runs as develop().
  void recall(gpu::Stream& stream, const Film& film, const View& view, const PreviewCamera& camera);
  /// The film's picture has been shown as it is, with that exposure: keep() is to know it. Every pixel has a
  /// sample. Throws as develop(). The stream is run.
  void take(gpu::Stream& stream, const Film& film, const View& view, const PreviewCamera& camera);
  /// The film has been filtered, and that is shown in place of a preview: `luminances` and their standard
  /// errors, one a pixel. What error is expected of it. Throws as develop(). The stream is run.
  ShownError show_filtered(gpu::Stream& stream, const Film& film, std::span<const float> luminances,
                           std::span<const float> errors, const View& view);
  /// Its error as the samples judge it that the film has got since; nothing if show_filtered() was not the
  /// last to show something. The stream is run.
  std::optional<ShownError> judge_filtered(gpu::Stream& stream, const Film& film);
  uint64_t bytes() const;  ///< of device memory

 private:
  struct Pixels {
    gpu::Buffer light, surfaces;
  };
  /// What was shown before, as it was seen then.
  struct History {
    Pixels pixels;
    bool known = false;
    PreviewCamera camera;
    float exposure = 1;
    vec3 scale{1};  ///< of its light, as far as edits since are known to do that
    /// Light is as it was; but what is seen of it can hang on the direction.
    bool same_light = true;
    bool recoloured = false;  ///< surfaces had other colours
    vec3 scale_for(const View& view) const { return scale * (view.exposure / exposure); }
  };
  void make_pixels(Pixels& to);
  void make_room(uint32_t width, uint32_t height, const Film* draft);
  void pack(gpu::Stream& stream, const Film& film, const Pixels& to, const View& view,
            const gpu::Buffer* guide, const gpu::Buffer& sums);
  /// Records; the tiles can be read when the stream has run. Whether the picture before is judged too.
  bool judge(gpu::Stream& stream, const Film& by, const View& view);
  void judge_tiles(gpu::Stream& stream, const Film& by, uint32_t step, const gpu::Buffer& shown);
  std::span<const shared::PreviewTile> tiles() const;
  void move(gpu::Stream& stream, shared::PreviewReprojectPush push);
  void show(gpu::Stream& stream, const Film& film, const Pixels& seen, shared::PreviewRecallPush push);
  const Pixels& history(gpu::Stream& stream, const PreviewCamera& now);
  uint32_t pixels() const { return width_ * height_; }

  gpu::Device& device_;
  gpu::Kernel pack_, halve_, change_, first_filter_, filter_, scatter_, gather_, recall_, resolve_, judge_;
  uint32_t width_ = 0, height_ = 0;
  Pixels now_, draft_;
  History history_;
  Pixels moved_;  ///< the history's as they are seen now, where that is from elsewhere
  gpu::Buffer grid_, grid_surfaces_, filtered_, before_[2], lost_[2], texture_[2], noise_, changes_, ratios_,
      shares_, depths_, nearest_;
  /// What was shown last and before, and what samples there were then.
  gpu::Buffer pixels_shown_[2], sums_[2], draft_sums_, tiles_;
  struct Judged {
    uint32_t step;  ///< of the film's pixels, in the picture's
    float exposure;
    uint32_t show;
    bool operator==(const Judged&) const = default;
  };
  std::optional<Judged> judged_;  ///< of pixels_shown_[1] and sums_[1]
  ShownJudge errors_;
  /// Of a filtered picture: how it is shown, and errors_ without its own measurements, which are made again
  /// from its beginning.
  struct FilteredShown {
    View view;
    ShownJudge before;
  };
  std::optional<FilteredShown> filtered_shown_;
  gpu::Resources resources_;
  PreviewCamera camera_;
  std::optional<PreviewCamera> moved_camera_;  ///< of `moved_`
  float exposure_ = 1;
  bool shown_ = false;  ///< `now_` is what was developed last, of light that `history_` knows nothing of
  bool repainted_ =
      false;  ///< surfaces that have no samples yet may have other colours than any that is known
};

}  // namespace lucerna::film
