// links: irradiance_cache
// Which of the points that ask for a record get one: all are covered, few are chosen, the same every time.
#include "solvers/irradiance_cache/placement.h"

#include <catch2/catch.hpp>
#include <random>

using namespace lucerna;
using namespace lucerna::irradiance_cache;

namespace {

/// Points on the inner walls of a box, `offset` away from the origin.
std::vector<Place> box_points(size_t count, float offset) {
  std::mt19937 random(5);
  const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
  std::vector<Place> points;
  for (size_t i = 0; i < count; ++i) {
    const int axis = int(random() % 3);
    const bool upper = random() % 2;
    Place p;
    p.position = vec3(unit() * 4, unit() * 3, unit() * 5);
    p.position[axis] = upper ? (axis == 0 ? 4.0f : axis == 1 ? 3.0f : 5.0f) : 0.0f;
    p.position += vec3(offset);
    p.normal = vec3(0);
    p.normal[axis] = upper ? -1.0f : 1.0f;
    points.push_back(p);
  }
  return points;
}

bool same(const std::vector<Place>& a, const std::vector<Place>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Place& x, const Place& y) {
    return x.position == y.position && x.normal == y.normal;
  });
}

}  // namespace

TEST_CASE("every point that asked is near a chosen one that faces as it does") {
  for (const float offset : {0.0f, 10000.0f}) {
    const std::vector<Place> points = box_points(20000, offset);
    const PlacementOptions options{.spacing = 0.25f, .seed = 3};
    const std::vector<Place> chosen = choose_places(points, options);
    INFO(chosen.size() << " of " << points.size() << " at " << offset);
    size_t uncovered = 0;
    for (const Place& p : points)
      uncovered += std::none_of(chosen.begin(), chosen.end(), [&](const Place& c) {
        return distance(p.position, c.position) <= options.spacing && dot(p.normal, c.normal) > 0.98f;
      });
    CHECK(uncovered == 0);
    // 94 square metres; discs of that radius packed as densely as chance packs them, twice that across
    // clusters' borders.
    CHECK(chosen.size() > 94 / (3.14159 * 0.25 * 0.25));
    CHECK(chosen.size() < 6 * 94 / (3.14159 * 0.25 * 0.25));
    // Only what was asked for is chosen.
    for (const Place& c : chosen)
      REQUIRE(std::any_of(points.begin(), points.end(),
                          [&](const Place& p) { return p.position == c.position; }));
    CHECK(same(chosen, choose_places(points, options)));
    CHECK_FALSE(same(chosen, choose_places(points, {.spacing = 0.25f, .seed = 4})));
  }
}

TEST_CASE("too few places are shared out over the clusters") {
  const std::vector<Place> points = box_points(20000, 0);
  const std::vector<Place> few = choose_places(points, {.spacing = 0.1f, .most = 200});
  CHECK(few.size() <= 200);
  CHECK(few.size() > 150);
  // All over the box, not in a corner of it.
  for (int axis = 0; axis < 3; ++axis) {
    float lo = 1e9f, hi = -1e9f;
    for (const Place& p : few) lo = std::min(lo, p.position[axis]), hi = std::max(hi, p.position[axis]);
    CHECK(lo < 0.3f);
    CHECK(hi > 2.7f);
  }
  CHECK(choose_places({}, {}).empty());
  CHECK(choose_places(points, {.most = 0}).empty());
  // One place, asked for by many: chosen once for each way that it faces.
  std::vector<Place> one(50);
  for (size_t i = 0; i < one.size(); ++i) one[i].normal = vec3(0, i % 2 ? 1 : -1, 0);
  CHECK(choose_places(one, {}).size() == 2);
}

TEST_CASE("spacing grows with the distance from the eye") {
  std::vector<Place> points = box_points(20000, 0);
  const vec3 eye(0, 1.5f, 2.5f);
  const std::vector<Place> chosen =
      choose_places(points, {.spacing = 0.02f, .spacing_of_distance = 0.1f, .eye = eye, .seed = 3});
  size_t near_ones = 0;
  for (const Place& c : chosen) near_ones += distance(c.position, eye) < 2;
  CHECK(near_ones > chosen.size() / 2);
  for (const Place& p : points)
    REQUIRE(std::any_of(chosen.begin(), chosen.end(), [&](const Place& c) {
      return distance(p.position, c.position) <= std::max(0.02f, 0.1f * distance(c.position, eye)) &&
             dot(p.normal, c.normal) > 0.98f;
    }));
}

TEST_CASE("thinning keeps what nothing wider covers, and nothing else") {
  const std::vector<Place> points = box_points(3000, 0);
  std::mt19937 random(9);
  std::vector<float> radii;
  for (size_t i = 0; i < points.size(); ++i)
    radii.push_back(0.02f * std::pow(50.0f, float(random() >> 8) / 16777216.0f));
  const ThinningOptions options{.share = 0.6f};
  const std::vector<uint32_t> kept = thin_out(points, radii, options);
  INFO(kept.size() << " of " << points.size());
  CHECK(std::is_sorted(kept.begin(), kept.end()));
  CHECK(kept.size() < points.size() / 2);
  const auto covers = [&](uint32_t k, uint32_t i) {
    const vec3 away = points[i].position - points[k].position;
    return distance(points[i].position, points[k].position) <= options.share * radii[k] &&
           1 - dot(points[i].normal, points[k].normal) <=
               options.share * options.share * options.normal_tolerance &&
           dot(away, points[i].normal + points[k].normal) >= -2 * options.behind * radii[k];
  };
  for (uint32_t i = 0; i < points.size(); ++i) {
    const bool stays = std::binary_search(kept.begin(), kept.end(), i);
    // Wider ones, or as wide and earlier, go first.
    const bool covered = std::any_of(kept.begin(), kept.end(), [&](uint32_t k) {
      return k != i && (radii[k] > radii[i] || (radii[k] == radii[i] && k < i)) && covers(k, i);
    });
    REQUIRE(stays == !covered);
  }
  CHECK(thin_out({}, {}, options).empty());
}
