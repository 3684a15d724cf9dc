#pragma once
// Which of the points that asked for a record get one (METHODS 3.2, world space): candidates in Morton order,
// cut into clusters, of which points are drawn until each is covered. On the host: some ten thousand points a
// pass.
#include <cstdint>
#include <span>
#include <vector>

#include "solvers/irradiance_cache/records.h"

namespace lucerna::irradiance_cache {

struct PlacementOptions {
  float spacing =
      0.1f;  ///< [m]: a chosen point covers others as near as this, and clusters are four times as wide
  float normal_tolerance = 0.015f;  ///< ... whose normal differs by no more than that, as 1 - cos
  uint32_t seed = 1;
  uint32_t most = ~0u;  ///< points to choose at most; then every cluster gets its share in turn
};

/// In Morton order of the candidates; the same for the same candidates in any thread and on any machine. Ties
/// of the code go by the candidates' order.
std::vector<Place> choose_places(std::span<const Place> candidates, const PlacementOptions& options);

}  // namespace lucerna::irradiance_cache
