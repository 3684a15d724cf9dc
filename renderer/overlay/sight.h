#pragma once
// Finds the visible surfaces of the picture's pixels by rays through their centres, as paths hit them. The
// film is not exact: its depths are means over a pixel, which lie off the plane of a slanted floor, and its
// normals include normal maps. Shaders read the surfaces by shaders/overlay/lookup_place.glsl.
//
// One point a pixel, or every second, third ... pixel in both directions if the picture has more than
// k_most_points pixels.
#include <functional>

#include "shaders/shared/sight.h"
#include "transport/wavefront.h"

namespace lucerna::overlay {

/// No traced points.
inline constexpr shared::SightGrid k_no_sight{0, 1};

class Sight {
 public:
  static constexpr uint32_t k_most_points = 1u << 22;

  /// `defines`: those of the wavefront's kernels. The kernel is compiled on first use. Device and compiler
  /// must outlive it.
  Sight(gpu::Device& device, gpu::ShaderCompiler& compiler, gpu::Defines defines = {});

  /// Starts a picture with that frame. `texels`: texels of surfaces() per point. Throws Error: out of memory.
  void begin(const shared::Frame& frame, uint32_t texels = shared::k_surface_texels);
  /// Discards the surfaces; begin() must precede see().
  void forget() { begun_ = false; }
  bool begun() const { return begun_; }
  /// True once all points have been traced.
  bool seen() const { return begun_ && done_ == points(); }
  /// Traces the next rays, one per path slot. The wavefront's frame is the picture's. `note` records the
  /// kernel that writes surfaces() of these points from their paths. The time is accounted to `stage`.
  /// `vertex`: transport::PathEnds::vertex. False if cancelled.
  bool see(transport::Wavefront& wavefront, const char* stage,
           const std::function<void(const shared::SeePush&)>& note, const std::function<bool()>& cancel = {},
           const gpu::Kernel* vertex = nullptr);
  /// Sets the surfaces of all points; for tests.
  void set(const std::vector<vec4>& surfaces);

  /// Grid of the points over the picture; k_no_sight, without a readable buffer, until all are traced.
  shared::SightGrid grid() const { return seen() ? shared::SightGrid{across_, stride_} : k_no_sight; }
  /// Surfaces of the points, as written by `note`.
  const gpu::Buffer& surfaces() const { return surfaces_; }
  uint32_t width() const { return width_; }  ///< of the picture [pixels]
  uint32_t height() const { return height_; }
  uint32_t across() const { return across_; }  ///< points per row
  uint32_t down() const { return down_; }
  uint32_t points() const { return across_ * down_; }
  uint32_t stride() const { return stride_; }  ///< pixels from one to the next
  /// Width of a point's cell, at a depth of 1 m unless parallel() [m].
  float pixel() const { return pixel_; }
  bool parallel() const { return parallel_; }  ///< orthographic: cells have one width at all depths
  uint64_t bytes() const { return surfaces_ ? surfaces_.bytes() : 0; }

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Defines defines_;
  gpu::Kernel centre_;
  gpu::Buffer surfaces_;
  gpu::Resources resources_;
  uint32_t width_ = 0, height_ = 0, stride_ = 1, across_ = 0, down_ = 0, done_ = 0;
  float pixel_ = 1;
  bool parallel_ = false, begun_ = false;
};

}  // namespace lucerna::overlay
