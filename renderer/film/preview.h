#pragma once
// Preview in the window until there are enough samples: the samples' light filtered over similar surfaces,
// preview samples at lower resolution before the first samples, and the picture from before an edit where the
// new light does not contradict it (mixing: shaders/film/preview_resolve.comp). Display only: film and files
// do not contain it.
//
// Filtering works on a grid of half the picture's resolution, on light divided by the surface's colour: an
// edge-avoiding a-trous filter (H. Dammertz et al. 2010) that stops at differences above the noise (C. Schied
// et al. 2017), which the two halves of the samples estimate. A pixel whose samples have met several surfaces
// is a mixture of nearby pixels that show one of them each.
#include <optional>

#include "film/film.h"
#include "film/shown_error.h"
#include "shaders/shared/preview.h"

namespace lucerna::film {

/// Shares of the shown picture, 0..1.
struct PreviewShares {
  double stale = 0;     ///< light from before the last edit or improvement, by luminance
  double filtered = 0;  ///< filtered light of the present, by luminance
  /// Error of the tiles, calibrated by samples that earlier pictures had not used. None: no preview.
  std::optional<ShownError> error;
};

/// Which of the film's pixels have samples.
enum class Sampled { none, some, all };

/// The camera of a picture.
struct PreviewCamera {
  shared::PreviewCamera axes{};
  uint32_t projection = 0;  ///< shared::k_projection_*
  vec4 section{0};          ///< plane that cuts the view: normal, offset
  bool operator==(const PreviewCamera& o) const;
};

class Preview {
 public:
  /// Compiles its kernels; throws Error, located.
  Preview(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// True if pictures of that size can have a preview on this device.
  static bool fits(const gpu::Limits& limits, uint32_t width, uint32_t height);
  /// Resets: no picture has been shown yet.
  void forget();
  /// Starts a new picture: the last one becomes the history. `scale`: known factor of the edit on all light;
  /// `repainted`: surfaces may have other colours; `same_light`: only the camera or the computation of light
  /// has changed; `doubt`: expected relative change of light whose change is not known; `light`: number of
  /// the light of the shown picture, if that is good enough for put_back(), else 0.
  void keep(const vec3& scale = vec3(1), bool repainted = false, bool same_light = false, float doubt = 0,
            uint64_t light = 0);
  /// Call after keep() if the new picture has the light of that number: makes the last picture that was kept
  /// with it the history, if it is one of the last two such pictures besides the present one. False, and
  /// nothing is done, if not.
  bool put_back(uint64_t light);
  /// Starts a new picture with better light. The history stays unchanged.
  void better();
  /// Makes the film's picture, for layers with shared::is_component_layer().
  /// `draft`: a preview sample, a film of the same view whose pixels cover whole pixels, or null. `filtered`:
  /// filters pixels with samples too. `seen`: visible surfaces of the film's pixels, or null
  /// (shaders/film/preview_look.comp). Films must fit(). Throws Error if memory is short. Runs the stream.
  PreviewShares develop(gpu::Stream& stream, const Film& film, const Film* draft, const View& view,
                        const PreviewCamera& camera, bool filtered, Sampled sampled = Sampled::some,
                        const gpu::Buffer* seen = nullptr);
  /// True if there is a history.
  bool has_history() const { return history_.known; }
  /// Makes the device compile the kernels of edits (recall(), and develop() in changed light), which takes
  /// seconds, so that the first edit does not wait. After develop() or take(). Runs the stream.
  void warm(gpu::Stream& stream, const Film& film);
  /// Makes the history, reprojected to this camera, the film's picture: it can be shown without new light.
  /// Requires has_history(). Newly visible parts are filled from their surroundings. Throws and runs the
  /// stream like develop().
  void recall(gpu::Stream& stream, const Film& film, const View& view, const PreviewCamera& camera);
  /// True if recall_on() can show a picture from this camera: the history has another one, and its surfaces
  /// are known.
  bool recalls_on(const PreviewCamera& camera) const {
    return history_.known && history_.surfaces && history_.camera != camera;
  }
  /// Likewise, on surfaces of that camera seen by rays, `width` times `height` over the picture, at most half
  /// of its pixels along a side: newly visible parts have their colours, and light from their surroundings.
  void recall_on(gpu::Stream& stream, const Film& film, const View& view, const PreviewCamera& camera,
                 const gpu::Buffer& seen, uint32_t width, uint32_t height);
  /// Takes the film's picture, shown unfiltered with that exposure, as the last shown picture for keep().
  /// Requires a sample in every pixel. Throws and runs the stream like develop().
  /// `noise`: factor on the standard errors of its halves; `seen`: as for develop().
  void take(gpu::Stream& stream, const Film& film, const View& view, const PreviewCamera& camera,
            float noise = 1, const gpu::Buffer* seen = nullptr);
  /// Takes a filtered picture that is shown in place of a preview: `luminances` and their standard `errors`,
  /// one a pixel. Returns its expected error. Throws and runs the stream like develop().
  ShownError show_filtered(gpu::Stream& stream, const Film& film, std::span<const float> luminances,
                           std::span<const float> errors, const View& view);
  /// Error of that picture, measured by samples added to the film since; none if show_filtered() was not the
  /// last call that showed a picture. Runs the stream.
  std::optional<ShownError> judge_filtered(gpu::Stream& stream, const Film& film);
  /// The light of the picture that develop() or take() showed last, before exposure: the sum of these
  /// components (bits), rounded to half floats. Throws Error if there is none.
  std::vector<vec3> shown_light(uint32_t components) const;
  uint64_t bytes() const;  ///< of device memory

 private:
  struct Pixels {
    gpu::Buffer light, surfaces;
  };
  /// The previous picture, from its own camera.
  struct History {
    Pixels pixels;
    bool known = false;
    bool surfaces = false;  ///< the surfaces of all pixels are known
    PreviewCamera camera;
    float exposure = 1;
    vec3 scale{1};  ///< known factor on its light by edits since
    /// Light is unchanged, but its appearance may depend on the direction.
    bool same_light = true;
    bool recoloured = false;  ///< surfaces had other colours
    float doubt = 0;          ///< expected relative change of its light by edits since
    uint64_t light = 0;       ///< number of its light when it was shown, as in keep()
    vec3 scale_for(const View& view) const { return scale * (view.exposure / exposure); }
  };
  void make_pixels(Pixels& to);
  void make_room(uint32_t width, uint32_t height, const Film* draft);
  void pack(gpu::Stream& stream, const Film& film, const Pixels& to, const View& view,
            const gpu::Buffer* guide, const gpu::Buffer& sums, float noise = 1, bool taken = false);
  /// Records; the tiles can be read after the stream has run. Returns whether the previous picture is
  /// measured too.
  bool judge(gpu::Stream& stream, const Film& by, const View& view);
  void judge_tiles(gpu::Stream& stream, const Film& by, uint32_t step, const gpu::Buffer& shown);
  std::span<const shared::PreviewTile> tiles() const;
  void move(gpu::Stream& stream, shared::PreviewReprojectPush push);
  void fetch(gpu::Stream& stream, const PreviewCamera& now, const gpu::Buffer& seen, uint32_t width,
             uint32_t height, const Pixels& to, bool keep);
  /// `lut`: of the view; null: none.
  void show(gpu::Stream& stream, const Film& film, const Pixels& seen, shared::PreviewRecallPush push,
            const gpu::Buffer* lut);
  /// The kernel, or the one that shows its result by the view's table.
  gpu::Kernel& by_lut(const gpu::Buffer* lut, gpu::Kernel& kernel, gpu::Kernel& with_lut, const char* file);
  const Pixels& history(gpu::Stream& stream, const PreviewCamera& now, const gpu::Buffer* seen = nullptr);
  uint32_t pixels() const { return width_ * height_; }

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel pack_, halve_, change_, first_filter_, filter_, scatter_, gather_, fetch_, recall_, resolve_,
      judge_;
  gpu::Kernel recall_by_lut_, resolve_by_lut_;  ///< for views with a display_lut; compiled at the first use
  uint32_t width_ = 0, height_ = 0;
  Pixels now_, draft_;
  History history_;
  std::array<History, 2> aside_;  ///< earlier pictures, for put_back(); the newest first
  Pixels moved_;                  ///< the history's pixels from the present camera, if it has moved
  gpu::Buffer grid_, grid_surfaces_, filtered_, before_[2], lost_[2], texture_[2], noise_, changes_, ratios_,
      shares_, depths_, nearest_;
  /// The last two shown pictures, and the sums of samples at their time.
  gpu::Buffer pixels_shown_[2], sums_[2], draft_sums_, tiles_;
  struct Judged {
    uint32_t step;  ///< width of the film's pixels in those of the picture
    float exposure;
    uint32_t show;
    bool operator==(const Judged&) const = default;
  };
  std::optional<Judged> judged_;  ///< belongs to pixels_shown_[1] and sums_[1]
  ShownJudge errors_;
  /// A shown filtered picture: its view, and errors_ before its own measurements, which are repeated from its
  /// beginning.
  struct FilteredShown {
    View view;
    ShownJudge before;
  };
  std::optional<FilteredShown> filtered_shown_;
  gpu::Resources resources_;
  PreviewCamera camera_;
  std::optional<PreviewCamera> moved_camera_;  ///< camera of `moved_`
  bool moved_by_surfaces_ = false;             ///< `moved_` was fetched by seen surfaces
  float exposure_ = 1;
  bool surfaces_known_ = false;  ///< surfaces of all pixels of `now_`
  bool shown_ = false;  ///< `now_` is the last developed picture, with light that `history_` does not include
  bool repainted_ = false;  ///< surfaces without samples may have colours other than the known ones
};

}  // namespace lucerna::film
