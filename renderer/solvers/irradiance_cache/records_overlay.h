#pragma once
// Draws records over the film's picture: Cache::draw().
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "solvers/irradiance_cache/cache.h"

namespace lucerna::irradiance_cache {

class RecordsOverlay {
 public:
  /// `defines`: Cache::defines().
  RecordsOverlay(gpu::Device& device, gpu::ShaderCompiler& compiler, const gpu::Defines& defines);
  /// Sets the colour scales to the range of nearly all of these values.
  void set_scales(const std::vector<Records::Figures>& figures);
  /// As Cache::scale().
  std::pair<float, float> scale(uint32_t color) const;
  /// `bind`: binds lookup.glsl; `bind_sight`: as Cache::bind_sight().
  void draw(const overlay::Canvas& canvas, const Cache::Overlay& overlay,
            const std::function<void(gpu::Resources&)>& bind,
            const std::function<shared::SightGrid(gpu::Resources&)>& bind_sight);

 private:
  gpu::Kernel kernel_;
  gpu::Resources resources_;
  std::array<std::pair<float, float>, 3> scales_{{{1, 2}, {1, 2}, {1, 2}}};  // rays, distance, error
};

}  // namespace lucerna::irradiance_cache
