#pragma once
// What the picture's pixels show through glass and in mirrors: the first surface behind them that scatters
// light diffusely, where light that is stored on surfaces can lie. Each ray goes the way that most of the
// light goes (shaders/overlay/look.comp); what is seen in rough metal or through frosted glass is no surface.
// Shaders read it by shaders/overlay/lookup_place.glsl.
#include "overlay/canvas.h"
#include "overlay/sight.h"

namespace lucerna::overlay {

class LookThrough {
 public:
  /// `scene_defines`: of the kernels that know the scene's surfaces. Kernels are compiled when they are first
  /// called for. Both must outlive it.
  LookThrough(gpu::Device& device, gpu::ShaderCompiler& compiler, gpu::Defines scene_defines);

  /// Surfaces are others.
  void forget() { known_ = false; }
  /// Looks, unless that view is known. The wavefront's frame is `frame`, the picture's. False when the canvas
  /// cancels it: then nothing is known. Throws Error when there is no memory.
  bool look(const Canvas& canvas, const shared::Frame& frame);
  shared::SightGrid grid() const { return known_ ? sight_.grid() : k_no_sight; }
  /// Sets what asking.glsl reads, whether anything is known or not.
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
