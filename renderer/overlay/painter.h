#pragma once
// Draws points, segments and the rims of discs over a picture, hidden by what is in front of them: millions
// of them, in any order, with the same outcome. What they look like: shaders/shared/overlay.h.
#include <array>
#include <span>

#include "overlay/canvas.h"
#include "shaders/shared/overlay.h"

namespace lucerna::overlay {

/// The first `count` of an array in device memory.
struct Strokes {
  const gpu::Buffer* of = nullptr;  ///< not read where count is 0
  uint32_t count = 0;
};

/// What is drawn at once; no more than shared::k_most_strokes in all.
struct Drawing {
  Strokes points;    ///< shared::OverlayPoint
  Strokes segments;  ///< shared::OverlaySegment
  Strokes discs;     ///< shared::OverlayDisc
};

struct Style {
  bool dimmed = false;       ///< the picture under the strokes, so that they stand out on any ground
  float edge_alpha = 0.55f;  ///< of the dark edges
};

/// Kernels are compiled when they are first called for.
class Painter {
 public:
  /// Both must outlive it.
  Painter(gpu::Device& device, gpu::ShaderCompiler& compiler);

  /// Over the film's picture. Runs the stream, and with it what was recorded before, such as what fills these
  /// arrays. Throws Error: a kernel does not compile, there are too many.
  void draw(const Canvas& canvas, const Drawing& drawing, const Style& style = {});
  /// The same of arrays on the host.
  void draw(const Canvas& canvas, std::span<const shared::OverlayPoint> points,
            std::span<const shared::OverlaySegment> segments, std::span<const shared::OverlayDisc> discs,
            const Style& style = {});

 private:
  const gpu::Kernel& ready(gpu::Kernel& kernel, const char* file);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel points_, segments_, discs_, lay_;
  gpu::Buffer marks_, inks_;
  std::array<gpu::Buffer, 3> given_;  ///< arrays of the host's
  gpu::Resources resources_;
};

}  // namespace lucerna::overlay
