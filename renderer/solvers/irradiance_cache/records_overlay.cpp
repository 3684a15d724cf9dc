#include "solvers/irradiance_cache/records_overlay.h"

#include <algorithm>
#include <cmath>

namespace lucerna::irradiance_cache {

using namespace shared;

RecordsOverlay::RecordsOverlay(gpu::Device& device, gpu::ShaderCompiler& compiler,
                               const gpu::Defines& defines)
    : kernel_(device, compiler, "irradiance_cache/overlay.comp", defines) {}

void RecordsOverlay::set_scales(const std::vector<Records::Figures>& figures) {
  constexpr float Records::Figures::*k_scaled[] = {&Records::Figures::rays, &Records::Figures::mean_distance,
                                                   &Records::Figures::error};
  for (int k = 0; k < 3 && !figures.empty(); ++k) {
    std::vector<float> values;
    for (const Records::Figures& f : figures)
      if (f.*k_scaled[k] > 0 && std::isfinite(f.*k_scaled[k])) values.push_back(f.*k_scaled[k]);
    std::sort(values.begin(), values.end());
    const size_t n = values.size();
    const float lo = n ? values[n / 50] : 1, hi = n ? values[n - 1 - n / 50] : 2;
    scales_[k] = {lo, std::max(hi, 1.01f * lo)};
  }
}

std::pair<float, float> RecordsOverlay::scale(uint32_t color) const {
  return color < k_record_by_rays ? std::pair(1.0f, 2.0f) : scales_[color - k_record_by_rays];
}

void RecordsOverlay::draw(const overlay::Canvas& canvas, const Cache::Overlay& overlay,
                          const std::function<void(gpu::Resources&)>& bind,
                          const std::function<SightGrid(gpu::Resources&)>& bind_sight) {
  if (!overlay.discs && !overlay.overlap) return;
  canvas.bind(resources_);
  bind(resources_);
  const auto [lo, hi] = scale(overlay.color);
  const SightGrid sight = bind_sight(resources_);
  const OverlayPush push{canvas.width(), canvas.height(), overlay.discs, overlay.overlap, overlay.color, lo,
                         hi, k_overlap_scale,
                         // Discs are drawn on the surfaces of the sheet.
                         overlay.overlap ? sight : overlay::k_no_sight};
  canvas.stream().dispatch(kernel_, resources_, push, gpu::groups_for(canvas.pixels(), 64));
  canvas.finish();
}

}  // namespace lucerna::irradiance_cache
