#pragma once
// Photons as points over the picture.
#include "overlay/painter.h"
#include "solvers/photons/photon_map.h"

namespace lucerna::photons {

class PointsView {
 public:
  /// Kernels are compiled when they are first called for. Both must outlive it.
  PointsView(gpu::Device& device, gpu::ShaderCompiler& compiler);
  /// The photons of the last round, one in so many where there are more than can be drawn. `by`: 0 nothing,
  /// shared::k_photons_by_*.
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
