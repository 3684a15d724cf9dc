#pragma once
// Draws points, segments and the rims of discs over a picture, hidden by surfaces in front of them: millions,
// with a result independent of their order. Definitions: shaders/shared/overlay.h.
#include <array>
#include <span>

#include "overlay/canvas.h"
#include "shaders/shared/overlay.h"

namespace lucerna::overlay {

/// The first `count` of an array in device memory.
struct Strokes {
  const gpu::Buffer* of = nullptr;  ///< not read if count is 0
  uint32_t count = 0;
};

/// The strokes of one call; at most shared::k_most_strokes in all.
struct Drawing {
  Strokes points;    ///< shared::OverlayPoint
  Strokes segments;  ///< shared::OverlaySegment
  Strokes discs;     ///< shared::OverlayDisc
};

struct Style {
  bool dimmed = false;       ///< dims the picture, so that strokes are visible on any background
  float edge_alpha = 0.55f;  ///< alpha of the dark edges
};

/// Kernels are compiled on first use.
class Painter {
 public:
  /// Device and compiler must outlive it.
  Painter(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Draws over the film's picture. Runs the stream with everything recorded before, such as commands that
  /// fill these arrays. Throws Error: a kernel does not compile, too many strokes.
  void draw(const Canvas& canvas, const Drawing& drawing, const Style& style = {});
  /// Likewise, from arrays on the host.
  void draw(const Canvas& canvas, std::span<const shared::OverlayPoint> points,
            std::span<const shared::OverlaySegment> segments, std::span<const shared::OverlayDisc> discs,
            const Style& style = {});

 private:
  const gpu::Kernel& ready(gpu::Kernel& kernel, const char* file);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel points_, segments_, discs_, lay_;
  gpu::Buffer marks_, inks_;
  std::array<gpu::Buffer, 3> given_;  ///< copies of the host's arrays
  gpu::Resources resources_;
};

}  // namespace lucerna::overlay
