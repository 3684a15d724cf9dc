#pragma once
// Surfaces that the picture's pixels show through glass and in mirrors: the first diffuse surface, on which
// light can be stored. Each ray follows the strongest lobe (shaders/overlay/look.comp); rough metal and
// frosted glass show no surface. Shaders read it with shaders/overlay/lookup_place.glsl.
#include "overlay/canvas.h"
#include "overlay/sight.h"

namespace lucerna::overlay {

class LookThrough {
 public:
  /// `scene_defines`: those of kernels that use the scene's surfaces. Kernels are compiled on first use.
  /// Device and compiler must outlive it.
  LookThrough(gpu::Device& device, gpu::ShaderCompiler& compiler, gpu::Defines scene_defines);

  /// Drops the surfaces, after a change of the scene's.
  void forget() { known_ = false; }
  /// Traces the surfaces of that view, unless done. The wavefront must have `frame`, the picture's. False,
  /// and without data, if the canvas cancels it. Throws Error: out of memory.
  bool look(const Canvas& canvas, const shared::Frame& frame);
  shared::SightGrid grid() const { return known_ ? sight_.grid() : k_no_sight; }
  /// Binds what lookup_place.glsl reads, with or without data.
  void bind(gpu::Resources& resources) const;

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Defines scene_defines_;
  Sight sight_;
  gpu::Kernel look_, keep_;
  gpu::Buffer none_;
  gpu::Resources resources_;
  shared::Frame of_{};
  bool known_ = false;
};

}  // namespace lucerna::overlay
