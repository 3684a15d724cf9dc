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
    for (Grid* grid : {&full_, &coarse_})
      if (grid->rays) grid->rays->forget();
  }
  /// Traces a part of it; complete when surfaces() is not null. Not counted as the picture's work. False if
  /// cancelled. The wavefront has the picture's frame before and after.
  bool see(Engine& engine, const PictureView& view, const std::function<bool()>& cancel);
  /// One texel per pixel, as in shaders/shared/preview.h; null unless complete.
  const gpu::Buffer* surfaces(const Engine& engine, const PictureView& view) const;
  /// Likewise, for a picture of that camera and size.
  const gpu::Buffer* surfaces(const film::PreviewCamera& camera, uint32_t width, uint32_t height) const;
  /// True if it is missing and can be traced.
  bool wanted(const Engine& engine, const PictureView& view) const;

  /// Surfaces of a moving camera, of fewer pixels than the picture has.
  struct Coarse {
    const gpu::Buffer* surfaces;
    uint32_t width, height;
  };
  /// Traces all of it: as many pixels, from half to a quarter along a side, as k_coarse_s permits at the pace
  /// so far. None if kernels would have to be compiled first.
  std::optional<Coarse> see_coarse(Engine& engine, const PictureView& view);
  static constexpr double k_coarse_s = 0.06;

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  struct Grid {
    std::optional<overlay::Sight> rays;
    film::PreviewCamera camera;  ///< of the stored points
  };
  bool see(Engine& engine, const PictureView& view, const shared::Frame& frame, Grid& grid,
           const std::function<bool()>& cancel);
  Grid full_, coarse_;
  gpu::Defines defines_;  ///< of the ray kernels
  gpu::Kernel look_, note_;
  gpu::Resources resources_;
  double point_s_ = 0;  ///< time per point of the coarse grid
};

}  // namespace lucerna::session
