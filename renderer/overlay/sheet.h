#pragma once
// The sheet that overlays are drawn on: the picture, enlarged where the window shows each of its pixels as a
// square of several, and the first surface in the middle of each pixel of the sheet. Thus strokes are one
// pixel of the window wide and end at the edges of surfaces, however coarse the picture under them is.
#include <optional>

#include "film/film.h"
#include "overlay/sight.h"
#include "shaders/shared/sheet.h"

namespace lucerna::overlay {

class Sheet {
 public:
  /// Kernels are compiled on first use. Both must outlive it.
  Sheet(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Fits the sheet to a picture: `scale` pixels of the sheet per pixel of the film, along a side; `frame`:
  /// of the picture in the size of the sheet. Surfaces traced for another view are dropped. Throws Error if
  /// memory is short.
  void fit(const film::Film& film, uint32_t scale, const shared::Frame& frame);
  const shared::Frame& frame() const { return frame_; }
  /// Copies the film's picture to the sheet. Records on the stream.
  void enlarge(gpu::Stream& stream, const film::Film& film);

  /// The scene's surfaces have changed.
  void forget() { known_ = false; }
  bool surfaces_known() const { return known_; }
  /// False where the sheet has more pixels than surfaces are traced for (Sight::k_most_points).
  bool can_trace() const;
  /// Traces the surfaces, unless they are known. Sets the wavefront's frame to that of the sheet; the caller
  /// restores it. `defines`: of the wavefront's kernels. False if it was cancelled.
  bool trace(transport::Wavefront& wavefront, const film::Film& film, uint32_t enabled,
             const gpu::Defines& defines, const std::function<bool()>& cancel);

  uint32_t scale() const { return scale_; }
  /// The film's own picture where scale() is 1.
  const gpu::Buffer& picture(const film::Film& film) const { return scale_ == 1 ? film.picture() : picture_; }
  /// Sets what shaders/overlay/seen.glsl reads. `of_film`: at the resolution of the film.
  void bind(gpu::Resources& resources, bool of_film) const;

 private:
  void write_views(const film::Film& film);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  uint32_t scale_ = 1;
  shared::Frame frame_{};
  gpu::Defines defines_;  ///< that the kernels below were compiled with
  std::optional<Sight> sight_;
  gpu::Kernel first_, keep_, enlarge_;
  gpu::Buffer picture_, view_, film_view_, none_;
  gpu::Resources resources_;
  bool known_ = false;  ///< of frame_
};

}  // namespace lucerna::overlay
