#pragma once
// The sheet for overlays: the picture, enlarged if the window shows each of its pixels as a square of
// several, and the first surface at the centre of each pixel of the sheet. Strokes are thus one pixel of the
// window wide and end at the edges of surfaces, however coarse the picture is.
#include <optional>

#include "film/film.h"
#include "overlay/sight.h"
#include "shaders/shared/sheet.h"

namespace lucerna::overlay {

class Sheet {
 public:
  /// Kernels are compiled on first use. Device and compiler must outlive it.
  Sheet(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Fits the sheet to a picture: `scale` pixels of the sheet per pixel of the film, along a side; `frame`:
  /// the picture's, in the size of the sheet. Drops surfaces traced for another view. Throws Error if memory
  /// is short.
  void fit(const film::Film& film, uint32_t scale, const shared::Frame& frame);
  const shared::Frame& frame() const { return frame_; }
  /// Copies the film's picture to the sheet. Records on the stream.
  void enlarge(gpu::Stream& stream, const film::Film& film);

  /// Drops the surfaces, after a change of the scene's.
  void forget() { known_ = false; }
  bool surfaces_known() const { return known_; }
  /// False if the sheet has too many pixels for tracing (Sight::k_most_points).
  bool can_trace() const;
  /// Traces the surfaces, unless they are known. Sets the wavefront's frame to that of the sheet; the caller
  /// restores it. `defines`: those of the wavefront's kernels. False if cancelled.
  bool trace(transport::Wavefront& wavefront, const film::Film& film, uint32_t enabled,
             const gpu::Defines& defines, const std::function<bool()>& cancel);

  uint32_t scale() const { return scale_; }
  /// The picture under the overlays; the film's own one if scale() is 1.
  const gpu::Buffer& picture(const film::Film& film) const { return scale_ == 1 ? film.picture() : picture_; }
  /// Binds the resources of shaders/overlay/seen.glsl. `of_film`: at the resolution of the film.
  void bind(gpu::Resources& resources, bool of_film) const;

 private:
  void write_views(const film::Film& film);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  uint32_t scale_ = 1;
  shared::Frame frame_{};
  gpu::Defines defines_;  ///< defines of the kernels below
  std::optional<Sight> sight_;
  gpu::Kernel first_, keep_, enlarge_;
  gpu::Buffer picture_, view_, film_view_, none_;
  gpu::Resources resources_;
  bool known_ = false;  ///< surfaces are those of frame_
};

}  // namespace lucerna::overlay
