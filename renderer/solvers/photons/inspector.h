#pragma once
// Inspection of the photons of the latest round: density views, and the photons that count at one pixel.
#include <optional>

#include "overlay/look_through.h"
#include "overlay/painter.h"
#include "shaders/shared/photons/inspect.h"
#include "solvers/photons/photon_map.h"

namespace lucerna::photons {

/// Quantity and range of the heat map.
struct DensityScale {
  uint32_t of = 0;       ///< shared::k_density_of_*; 0: none
  float lo = 0, hi = 0;  ///< logarithmic; hi 0: there are no photons
};

struct Inspected {
  shared::PhotonInspectHeader at;
  std::vector<shared::PhotonInspected> photons;  ///< largest contribution first
};

class PhotonInspector {
 public:
  /// `scene_defines`: of kernels that read surfaces. Kernels are compiled at the first use. Both must outlive
  /// it.
  PhotonInspector(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines);
  /// Traces what the pixels show, through glass and in mirrors, if not done; without it the first hit is
  /// used. False if the canvas cancels it.
  bool look(const overlay::Canvas& canvas, const shared::Frame& frame) {
    return through_.look(canvas, frame);
  }
  /// Call when surfaces have changed.
  void forget() { through_.forget(); }
  /// Draws over the film's picture. `of`: shared::k_density_of_*. `bind`: binds the hook's data. `photons`:
  /// number in the round; if there are few, density and irradiance are averaged over nearby pixels.
  /// `version`: of the photons; results for one version are reused.
  DensityScale draw_density(const overlay::Canvas& canvas, const std::function<void(gpu::Resources&)>& bind,
                            uint32_t of, uint32_t photons, uint64_t version);
  /// Computes and stores all values: shared::k_density_of_*, or k_photons_in_disc. False if the canvas
  /// cancels it.
  bool look_up(const overlay::Canvas& canvas, const std::function<void(gpu::Resources&)>& bind, uint32_t of);
  /// The stored values by pixel; shared::k_density_none without a surface. For tests.
  std::vector<float> densities() const;
  /// Of a place of the picture, 0..1 to the right and down; nothing where no surface is seen. Draws the disc
  /// and its photons.
  std::optional<Inspected> inspect(const overlay::Canvas& canvas,
                                   const std::function<void(gpu::Resources&)>& bind, const vec2& place);

 private:
  const gpu::Kernel& ready(gpu::Kernel& kernel, const char* file);
  void smooth(const overlay::Canvas& canvas, uint32_t photons);
  void draw_disc(const overlay::Canvas& canvas, const Inspected& found);

  gpu::Device& device_;
  gpu::ShaderCompiler& compiler_;
  gpu::Kernel density_, smooth_, heat_, inspect_;
  gpu::Buffer densities_, halfway_, smoothed_, most_, inspection_;
  gpu::Resources resources_;
  DensityScale drawn_;          ///< of the stored values ...
  uint64_t drawn_version_ = 0;  ///< ... and their photons
  overlay::Painter painter_;
  overlay::LookThrough through_;
};

}  // namespace lucerna::photons
