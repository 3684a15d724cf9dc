#include "film/overlay.h"

#include <algorithm>
#include <cmath>

namespace lucerna::film {

float tile_position(double error, double target) {
  if (!(error >= 0) || !(target > 0)) return -1;
  if (error <= target) return 1;
  return static_cast<float>(
      std::clamp(1 - std::log(error / target) / std::log(double{k_tiles_far}), 0.0, 1.0));
}

HeatScale sample_scale(uint32_t least, uint32_t most) {
  const auto hi = static_cast<float>(std::max(1u, most));
  if (least == 0 || least >= most) return {.ramp = shared::k_ramp_viridis, .lo = 0, .hi = hi};
  return {.ramp = shared::k_ramp_viridis, .logarithmic = true, .lo = static_cast<float>(least), .hi = hi};
}

HeatScale error_scale(double target) {
  const auto t = static_cast<float>(std::max(target, 1e-6));
  return {.ramp = shared::k_ramp_magma, .logarithmic = true, .lo = 0.1f * t, .hi = 10 * t};
}

HeatScale cost_scale(double ms, double vertices, double pixels, bool adaptive) {
  HeatScale scale{.ramp = shared::k_ramp_viridis, .logarithmic = true};
  const double mean = std::max(ms, 1e-9) / std::max(pixels, 1.0), reach = adaptive ? 10 : 5;
  scale.lo = static_cast<float>(mean / reach);
  scale.hi = static_cast<float>(mean * reach);
  scale.unit = static_cast<float>(std::max(ms, 1e-9) / std::max(vertices, 1.0));
  return scale;
}

}  // namespace lucerna::film
