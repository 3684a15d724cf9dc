#pragma once
// The photons of the last round as a person looks at them: how dense they lie over the picture, and those
// that count at one pixel.
#include <optional>

#include "overlay/look_through.h"
#include "overlay/painter.h"
#include "shaders/shared/photons/inspect.h"
#include "solvers/photons/photon_map.h"

namespace lucerna::photons {

/// What a heat map shows, up to which value.
struct DensityScale {
  uint32_t of = 0;       ///< shared::k_density_of_*; 0: nothing is shown
  float lo = 0, hi = 0;  ///< logarithmic; hi 0: there are no photons
};

struct Inspected {
  shared::PhotonInspectHeader at;
  std::vector<shared::PhotonInspected> photons;  ///< those that bring most first
};

class PhotonInspector {
 public:
  /// `scene_defines`: of the kernels that know the scene's surfaces. Kernels are compiled when they are first
  /// called for. Both must outlive it.
  PhotonInspector(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& scene_defines);
  /// Looks at what the pixels show, through glass and in mirrors, unless that is known; without it what comes
  /// first counts. False when the canvas cancels it.
  bool look(const overlay::Canvas& canvas, const shared::Frame& frame) {
    return through_.look(canvas, frame);
  }
  /// Surfaces are others.
  void forget() { through_.forget(); }
  /// Over the film's picture. `of`: shared::k_density_of_*. `bind`: what the hook reads. `photons`: of the
  /// round; where they are few for the picture's pixels what is drawn of photons and irradiance is a mean
  /// over pixels around. `version` of the photons: what is known of one is not looked up again.
  DensityScale draw_density(const overlay::Canvas& canvas, const std::function<void(gpu::Resources&)>& bind,
                            uint32_t of, uint32_t photons, uint64_t version);
  /// Looks all of it up and keeps it: shared::k_density_of_*, or k_photons_in_disc. False when the canvas
  /// cancels it.
  bool look_up(const overlay::Canvas& canvas, const std::function<void(gpu::Resources&)>& bind, uint32_t of);
  /// What was looked up last, by pixel; shared::k_density_none where nothing is seen. For tests.
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
  DensityScale drawn_;          ///< what is known ...
  uint64_t drawn_version_ = 0;  ///< ... of these photons
  overlay::Painter painter_;
  overlay::LookThrough through_;
};

}  // namespace lucerna::photons
