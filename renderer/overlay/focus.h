#pragma once
// Display of a lens's depth of field over the picture.
#include "overlay/canvas.h"
#include "shaders/shared/overlay.h"

namespace lucerna::overlay {

/// Largest blur on the film that counts as sharp [m], for film 36 mm wide.
inline constexpr float k_sharp_blur = 3e-5f;
/// Encoded colours of the plane of focus, and of what is sharp.
inline constexpr vec3 k_focus_line{1, 0.93f, 0.45f}, k_sharp_tint{0.35f, 0.9f, 0.6f};

/// Depths along the view axis [m] between which a point's blur on the film is at most k_sharp_blur; infinity:
/// all beyond the first are sharp. Both are the whole range for a pinhole.
struct DepthOfField {
  float nearest = 0, farthest = k_infinity;
};
DepthOfField depth_of_field(const shared::Frame& frame);

class FocusPainter {
 public:
  /// The kernel is compiled on first use. Device and compiler must outlive it.
  FocusPainter(gpu::Device& device, gpu::ShaderCompiler& compiler) : device_(device), compiler_(compiler) {}
  /// `frame`: of the picture, with a lens. Runs the stream.
  void draw(const Canvas& canvas, const shared::Frame& frame);

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel kernel_;
  gpu::Resources resources_;
};

}  // namespace lucerna::overlay
