// What the cache promises for a scene, before a record is built.
#include <cmath>

#include "paths/automaton.h"
#include "solvers/irradiance_cache/info.h"

namespace lucerna::irradiance_cache {

namespace {

// Measured with the default settings in pictures of k_pixels pixels, on the program's interiors and others
// (lucerna bench auto): cost of building, in samples; share of the interreflection's variance that lookups
// leave; and the error of records and interpolation.
constexpr double k_building = 90, k_pixels = 320 * 180, k_left = 0.02, k_floor = 0.06;

}  // namespace

std::optional<solvers::Prospect> prospect(const solvers::Findings& findings, uint32_t components) {
  constexpr uint32_t k_own = paths::k_secondary_bit | paths::k_tertiary_bit;
  if ((components & ~k_own) != 0) return std::nullopt;
  double variance = 0;
  for (size_t c = 0; c < findings.components.size(); ++c)
    if ((components >> c & 1u) != 0) variance += findings.components[c].variance;
  // Records are as far apart in pixels in a large picture as in a small one, up to their largest radius.
  return solvers::Prospect{.preparation = k_building * std::sqrt(k_pixels / std::max(findings.pixels, 1.0)),
                           .variance = k_left * variance,
                           .floor = k_floor};
}

}  // namespace lucerna::irradiance_cache
