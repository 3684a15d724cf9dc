#pragma once
// Draws photons as points over the picture.
#include "overlay/painter.h"
#include "solvers/photons/photon_map.h"

namespace lucerna::photons {

class PointsView {
 public:
  /// Kernels are compiled at the first use. Both must outlive it.
  PointsView(gpu::Device& device, gpu::ShaderCompiler& compiler);
  /// Draws the photons of the latest round, every n-th if there are too many. `by`: shared::k_photons_by_*;
  /// 0: none.
  void draw(const overlay::Canvas& canvas, const PhotonMap& map, uint32_t by);

 private:
  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel kernel_;
  gpu::Buffer points_;
  gpu::Resources resources_;
  overlay::Painter painter_;
};

}  // namespace lucerna::photons
