// What the cache promises for a scene, before a record is built.
#include <cmath>

#include "paths/automaton.h"
#include "solvers/irradiance_cache/info.h"

namespace lucerna::irradiance_cache {

namespace {

// Measured with the default settings in pictures of k_pixels pixels, on the program's scenes and on others
// (lucerna bench auto, with kernels compiled before). Cost of building: k_building rays a pixel, within a
// factor of 1.5 on eight of nine scenes. Where interreflection has the variance V: error of the records,
// k_records V^k_records_power, and samples after which refinement has reduced it; share of V that lookups
// leave; error of interpolation.
constexpr double k_pixels = 320 * 180;
constexpr double k_building = 480, k_records = 0.04, k_records_power = 0.3;
constexpr double k_refined = 128, k_left = 0.02, k_interpolation = 0.02;

}  // namespace

std::optional<solvers::Prospect> prospect(const solvers::Findings& findings, uint32_t components) {
  constexpr uint32_t k_own = paths::k_secondary_bit | paths::k_tertiary_bit;
  if ((components & ~k_own) != 0) return std::nullopt;
  double variance = 0;
  for (size_t c = 0; c < findings.components.size(); ++c)
    if ((components >> c & 1u) != 0) variance += findings.components[c].variance;
  // In a large picture, records are as far apart in pixels, up to their largest radius: more of them, but
  // fewer for each pixel, and less is interpolated between them.
  const double size = std::sqrt(k_pixels / std::max(findings.pixels, 1.0));
  return solvers::Prospect{.preparation = k_building / std::max(findings.rays, 1.0) * size,
                           .variance = k_left * variance,
                           .prepared = k_records * std::pow(variance, k_records_power),
                           .refined = k_refined,
                           .floor = k_interpolation * size};
}

}  // namespace lucerna::irradiance_cache
