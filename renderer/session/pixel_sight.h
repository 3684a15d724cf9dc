#pragma once
// Primary-visibility buffer: the surfaces that pixels show, also in mirrors and through glass
// (film/preview_look.comp), by one ray through each pixel's centre. Used to filter light over surfaces.
#include <functional>
#include <optional>

#include "film/preview.h"
#include "overlay/sight.h"
#include "session/engine.h"

namespace lucerna::session {

film::PreviewCamera preview_camera(const shared::Frame& frame);

class PixelSight {
 public:
  PixelSight(gpu::Device& device, gpu::ShaderCompiler& compiler) : device_(device), compiler_(compiler) {}

  /// Call when surfaces have changed.
  void forget() {
    if (rays_) rays_->forget();
  }
  /// Traces a part of it; complete when surfaces() is not null. Not counted as the picture's work. False if
  /// cancelled. The wavefront has the picture's frame before and after.
  bool see(Engine& engine, const PictureView& view, const std::function<bool()>& cancel);
  /// One texel per pixel, as in shaders/shared/preview.h; null unless complete.
  const gpu::Buffer* surfaces(const Engine& engine, const PictureView& view) const;
  /// True if it is missing and can be traced.
  bool wanted(const Engine& engine, const PictureView& view) const;

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  std::optional<overlay::Sight> rays_;
  gpu::Defines defines_;  ///< of the ray kernels
  gpu::Kernel look_, note_;
  gpu::Resources resources_;
  film::PreviewCamera camera_;  ///< camera of the stored points
};

}  // namespace lucerna::session
