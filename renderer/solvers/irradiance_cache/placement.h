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
  /// [m]: a chosen point covers others as near as this, and clusters are four times as wide.
  float spacing = 0.1f;
  float spacing_beyond = 0;  ///< [m]: at least, of places that other records ask for (k_origin_recursive)
  /// At least: this share of the distance from `eye`, or of 1 m where the view is parallel.
  float spacing_of_distance = 0;
  vec3 eye{0};
  bool parallel = false;
  float normal_tolerance = 0.015f;  ///< ... whose normal differs by no more than that, as 1 - cos
  uint32_t seed = 1;
  uint32_t most = ~0u;  ///< points to choose at most; then every cluster gets its share in turn
};

/// In Morton order of the candidates; the same for the same candidates in any thread and on any machine. Ties
/// of the code go by the candidates' order. `cluster` is told the cluster of each candidate, for who watches.
std::vector<Place> choose_places(std::span<const Place> candidates, const PlacementOptions& options,
                                 std::vector<uint32_t>* cluster = nullptr);

struct ThinningOptions {
  /// Of its radius: where a record that is kept makes others superfluous. The less, the more overlap.
  float share = 0.6f;
  float normal_tolerance = 0.015f, behind = 0.05f;  ///< as the lookup has them
};

/// Of records whose radii are known those that are needed, the widest first: indices in rising order. A
/// record goes when another that is kept would serve its place with a weight of at least 1 - share.
std::vector<uint32_t> thin_out(std::span<const Place> places, std::span<const float> radii,
                               const ThinningOptions& options);

}  // namespace lucerna::irradiance_cache
