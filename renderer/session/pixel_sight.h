#pragma once
// What surfaces the pixels of a picture show, in mirrors and through glass too (film/preview_look.comp): one
// ray through the centre of each. For what filters light over surfaces.
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

  /// Surfaces have changed.
  void forget() {
    if (rays_) rays_->forget();
  }
  /// A piece of it; all of it is done when surfaces() is not null. Its work is not counted as the picture's.
  /// False when it was cancelled. The wavefront's frame is the picture's, before and afterwards.
  bool see(Engine& engine, const PictureView& view, const std::function<bool()>& cancel);
  /// Of each pixel a texel, as shaders/shared/preview.h says; null while it is not known, or not for each.
  const gpu::Buffer* surfaces(const Engine& engine, const PictureView& view) const;
  /// Whether it is not known yet, and can be.
  bool wanted(const Engine& engine, const PictureView& view) const;

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  std::optional<overlay::Sight> rays_;
  gpu::Defines defines_;  ///< that the rays were made with
  gpu::Kernel look_, note_;
  gpu::Resources resources_;
  film::PreviewCamera camera_;  ///< for which it was asked
};

}  // namespace lucerna::session
