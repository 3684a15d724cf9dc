#pragma once
// Looks at what the picture's pixels show: rays through their centres, and the surfaces that these meet, as
// paths meet them. The film cannot say: its depths are means over a pixel, which lie off the plane of a floor
// seen at a slant, and its normals are those of normal maps. Shaders read it by
// shaders/overlay/lookup_place.glsl.
//
// One point a pixel, or every second, third ... pixel both ways where the picture has more than
// k_most_points.
#include <functional>

#include "shaders/shared/sight.h"
#include "transport/wavefront.h"

namespace lucerna::overlay {

/// Nobody has looked.
inline constexpr shared::SightGrid k_no_sight{0, 1};

class Sight {
 public:
  static constexpr uint32_t k_most_points = 1u << 22;

  /// `defines`: of the wavefront's kernels. The kernel is compiled when it is first called for. Both must
  /// outlive it.
  Sight(gpu::Device& device, gpu::ShaderCompiler& compiler, gpu::Defines defines = {});

  /// Forgets what was seen: the picture is to be that of `frame`. `texels`: that surfaces() hold of a point.
  /// Throws Error when there is no memory.
  void begin(const shared::Frame& frame, uint32_t texels = shared::k_surface_texels);
  /// Forgets what was seen; see() wants begin() again.
  void forget() { begun_ = false; }
  bool begun() const { return begun_; }
  /// Whether all points of the picture have been looked at.
  bool seen() const { return begun_ && done_ == points(); }
  /// Sends the next rays, as many as there are slots. The wavefront's frame is the picture's; `note` records
  /// what writes surfaces() of these points, by what the wavefront's kernels have kept of their paths. All is
  /// accounted as `stage`. False when it was cancelled. `vertex`: transport::PathEnds::vertex.
  bool see(transport::Wavefront& wavefront, const char* stage,
           const std::function<void(const shared::SeePush&)>& note, const std::function<bool()>& cancel = {},
           const gpu::Kernel* vertex = nullptr);
  /// As if all of it had been seen; for tests.
  void set(const std::vector<vec4>& surfaces);

  /// How the points lie over the picture; k_no_sight, and no buffer to be read, before all are seen.
  shared::SightGrid grid() const { return seen() ? shared::SightGrid{across_, stride_} : k_no_sight; }
  /// Of the points, as `note` has written them.
  const gpu::Buffer& surfaces() const { return surfaces_; }
  uint32_t width() const { return width_; }  ///< of the picture
  uint32_t height() const { return height_; }
  uint32_t across() const { return across_; }  ///< points
  uint32_t down() const { return down_; }
  uint32_t points() const { return across_ * down_; }
  uint32_t stride() const { return stride_; }  ///< pixels from one to the next
  float pixel() const {
    return pixel_;
  }  ///< width of what a point stands for at a depth of 1 m, or everywhere [m]
  bool parallel() const { return parallel_; }  ///< everywhere
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
