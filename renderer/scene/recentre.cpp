#include "scene/recentre.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lucerna::scene {
namespace {

using glm::dvec3;

constexpr double k_camera_vote = 1e9;
constexpr int k_most_moves = 8;

struct Weighted {
  double value = 0, weight = 0;
};

double median(std::vector<Weighted>& values) {
  std::sort(values.begin(), values.end(),
            [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  double total = 0, sum = 0;
  for (const Weighted& v : values) total += v.weight;
  for (const Weighted& v : values)
    if ((sum += v.weight) >= 0.5 * total) return v.value;
  return values.empty() ? 0 : values.back().value;
}

struct Voter {
  Extent extent;
  bool seen = false;  // a camera is near
};

bool is_far(const dvec3& centre, const Extent& e) { return glm::length(centre) > k_far * e.radius; }

/// Translation of the scene, relative to the present origin.
dvec3 next_move(const std::vector<Voter>& voters) {
  dvec3 middle(0);
  std::vector<Weighted> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (const auto& [e, seen] : voters)
      if (is_far(e.centre, e)) values.push_back({e.centre[axis], e.weight});
    if (values.empty()) return dvec3(0);
    middle[axis] = median(values);
  }
  values.clear();
  double better = 0, worse = 0;
  bool better_seen = false, reached = false;
  for (const auto& [e, seen] : voters) {
    const double before = glm::length(e.centre), after = glm::length(e.centre - middle);
    if (is_far(e.centre, e)) {
      if (after > 0.1 * before) continue;
      better += e.weight;
      better_seen = better_seen || seen;
      values.push_back({after + e.radius, e.weight});
    } else if (is_far(e.centre - middle, e)) {
      worse += e.weight;
    } else {
      reached = true;
    }
  }
  if (better <= worse) return dvec3(0);
  const double radius = median(values);
  if (reached && glm::length(middle) <= (better_seen ? k_far * k_far : k_far * k_far * k_far) * radius)
    return dvec3(0);
  return round_origin(middle, radius);
}

}  // namespace

glm::dvec3 round_origin(const dvec3& centre, double radius) {
  dvec3 origin(0);
  if (!(radius > 0) || !(glm::length(centre) > k_far * radius)) return origin;
  const double step = std::pow(10.0, std::floor(std::log10(2 * radius)));
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(centre[axis]) > 0.1 * k_far * radius) origin[axis] = std::round(centre[axis] / step) * step;
  return origin;
}

glm::dvec3 choose_origin(std::span<const Extent> extents, std::span<const dvec3> cameras) {
  std::vector<Voter> voters;
  voters.reserve(extents.size());
  for (const Extent& e : extents) {
    const bool seen = std::any_of(cameras.begin(), cameras.end(),
                                  [&](const dvec3& camera) { return !is_far(camera - e.centre, e); });
    voters.push_back({{e.centre, e.radius, e.weight * (seen ? k_camera_vote : 1)}, seen});
  }
  dvec3 origin(0);
  for (int i = 0; i < k_most_moves; ++i) {
    const dvec3 by = next_move(voters);
    if (by == dvec3(0)) break;
    origin += by;
    for (Voter& v : voters) v.extent.centre -= by;
  }
  return origin;
}

}  // namespace lucerna::scene
