#include "transport/first_hits.h"

#include <algorithm>

#include "transport/casters.h"

namespace lucerna::transport {

namespace {

constexpr double k_part = 0.95;  ///< of the worth; who brings the rest lies far off
/// By which boxes are wider than what has been found in them, for what lies between: of their greatest size,
/// and of that of all places together.
constexpr float k_wider = 0.05f, k_wider_of_all = 0.005f;

float greatest(const vec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

std::vector<Box> first_hit_boxes(std::vector<FirstHit> hits) {
  std::stable_sort(hits.begin(), hits.end(),
                   [](const FirstHit& a, const FirstHit& b) { return a.worth > b.worth; });
  double sum = 0, before = 0;
  for (const FirstHit& h : hits) sum += h.worth;
  std::vector<Box> places;
  Box all;
  for (const FirstHit& h : hits) {
    if (h.worth <= 0 || before >= k_part * sum) break;
    before += h.worth;
    places.push_back({h.place, h.place});
    all.grow(h.place);
  }
  std::vector<Box> boxes = cluster_boxes(places, k_most_first_hit_boxes);
  for (Box& b : boxes) {
    const vec3 reach = glm::max(glm::abs(b.lo), glm::abs(b.hi));
    const float wider =
        k_wider * greatest(b.size()) + k_wider_of_all * greatest(all.size()) + 1e-6f * greatest(reach);
    b.lo -= vec3(wider), b.hi += vec3(wider);
  }
  return boxes;
}

}  // namespace lucerna::transport
