#pragma once
// How far a record needs to reach for the records around it, plainly on the host.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/math.h"
#include "shaders/shared/irradiance_cache/neighbours.h"

namespace lucerna::test {

/// One that a record would serve, as the record sees it.
struct Neighbour {
  double far = 0;    ///< of its radius
  double angle = 0;  ///< of the direction, in its plane [degrees]
};

/// The angle of a direction in the plane of that normal, in degrees.
inline double angle_in_plane(const vec3& away, const vec3& normal) {
  const vec3 side = std::abs(normal.y) > 0.9f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  const vec3 t = normalize(cross(side, normal)), b = cross(normal, t);
  return std::atan2(double(dot(away, b)), double(dot(away, t))) * 180 / std::numbers::pi;
}

/// The share of its radius that a record keeps; 1 where they do not stand all around.
inline double share_by_neighbours(std::vector<Neighbour> served) {
  // As neighbours.cpp has them, in degrees.
  const double k_apart = std::acos(0.866) * 180 / std::numbers::pi, k_gap = 3.0 * 180 / std::numbers::pi;
  std::stable_sort(served.begin(), served.end(),
                   [](const Neighbour& a, const Neighbour& b) { return a.far < b.far; });
  std::vector<double> around;
  for (const Neighbour& n : served) {
    if (around.size() == shared::k_neighbours) break;
    const auto close = [&](double angle) {
      const double d = std::abs(angle - n.angle);
      return std::min(d, 360 - d) < k_apart;
    };
    if (std::any_of(around.begin(), around.end(), close)) continue;
    around.push_back(n.angle);
    std::vector<double> sorted = around;
    std::sort(sorted.begin(), sorted.end());
    double gap = sorted.front() + 360 - sorted.back();
    for (size_t k = 1; k < sorted.size(); ++k) gap = std::max(gap, sorted[k] - sorted[k - 1]);
    if (gap <= k_gap) return n.far;
  }
  return 1;
}

}  // namespace lucerna::test
