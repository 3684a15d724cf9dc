#include "transport/first_hits.h"

#include <algorithm>
#include <array>

#include "transport/casters.h"

namespace lucerna::transport {

namespace {

constexpr double k_part = 0.95;  ///< part of the contribution inside the boxes; the rest is far away
/// Enlargement of boxes for positions between the recorded ones: over their largest size, and over that of
/// all positions together.
constexpr float k_wider = 0.05f, k_wider_of_all = 0.005f;

/// Parts of the weight within each of the nested boxes.
constexpr std::array k_nested_parts = {0.5, 0.8, 0.95};
/// Width of each further box over the one before.
constexpr float k_shell = 4;

float greatest(const vec3& v) { return std::max({v.x, v.y, v.z}); }

/// Enlarges a box by that much, and enough that rounding does not make it flat.
Box widened(const Box& b, float by) {
  const vec3 reach = glm::max(glm::abs(b.lo), glm::abs(b.hi));
  const vec3 wider(by + 1e-6f * greatest(reach));
  return {b.lo - wider, b.hi + wider};
}

}  // namespace

std::vector<Box> nested_boxes(std::vector<FirstHit> places, float extent) {
  double sum = 0;
  for (const FirstHit& p : places) sum += p.contribution;
  if (!(sum > 0)) return {};
  vec3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::sort(places.begin(), places.end(),
              [&](const FirstHit& a, const FirstHit& b) { return a.place[axis] < b.place[axis]; });
    double before = 0;
    for (const FirstHit& p : places)
      if ((before += p.contribution) >= 0.5 * sum) {
        middle[axis] = p.place[axis];
        break;
      }
  }
  std::vector<std::pair<float, size_t>> order;
  for (size_t i = 0; i < places.size(); ++i)
    order.emplace_back(greatest(glm::abs(places[i].place - middle)), i);
  std::sort(order.begin(), order.end());
  std::vector<Box> boxes;
  Box box;
  double before = 0;
  for (const auto& [distance, i] : order) {
    box.grow(places[i].place);
    before += places[i].contribution;
    if (before < k_nested_parts[boxes.size()] * sum) continue;
    boxes.push_back(widened(box, k_wider * greatest(box.size())));
    if (boxes.size() == k_nested_parts.size()) break;
  }
  // The rest comes from far away, with too few positions to be known.
  extent = std::max(extent, 2 * order.back().first);
  while (boxes.size() < k_most_nested_boxes && greatest(boxes.back().size()) < extent) {
    const Box& last = boxes.back();
    boxes.push_back(widened(last, 0.5f * (k_shell - 1) * greatest(last.size())));
  }
  return boxes;
}

std::vector<Box> first_hit_boxes(std::vector<FirstHit> hits) {
  std::stable_sort(hits.begin(), hits.end(),
                   [](const FirstHit& a, const FirstHit& b) { return a.contribution > b.contribution; });
  double sum = 0, before = 0;
  for (const FirstHit& h : hits) sum += h.contribution;
  std::vector<Box> places;
  Box all;
  for (const FirstHit& h : hits) {
    if (h.contribution <= 0 || before >= k_part * sum) break;
    before += h.contribution;
    places.push_back({h.place, h.place});
    all.grow(h.place);
  }
  std::vector<Box> boxes = cluster_boxes(places, k_most_first_hit_boxes);
  for (Box& b : boxes) b = widened(b, k_wider * greatest(b.size()) + k_wider_of_all * greatest(all.size()));
  return boxes;
}

}  // namespace lucerna::transport
