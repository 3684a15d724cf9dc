// links: irradiance_cache
// Which of the tested candidates become records.
#include "solvers/irradiance_cache/placement.h"

#include <catch2/catch.hpp>
#include <random>

#include "support/records.h"

namespace cache_placement_tests {

using namespace lucerna;
using namespace lucerna::irradiance_cache;

namespace {
constexpr float k_off_plane = 0.03f;
std::vector<float> off_planes(const std::vector<float>& radii) {
  std::vector<float> all;
  for (const float r : radii) all.push_back(k_off_plane * r);
  return all;
}
}  // namespace

TEST_CASE("thinning keeps what no wider record covers, and nothing else") {
  const std::vector<Place> points = test::box_points(3000);
  std::mt19937 random(9);
  std::vector<float> radii;
  for (size_t i = 0; i < points.size(); ++i)
    radii.push_back(0.02f * std::pow(50.0f, float(random() >> 8) / 16777216.0f));
  const ThinningOptions options{.share = 0.6f};
  const std::vector<uint32_t> kept = thin_out(points, radii, off_planes(radii), options);
  INFO(kept.size() << " of " << points.size());
  CHECK(std::is_sorted(kept.begin(), kept.end()));
  CHECK(kept.size() < points.size() / 2);
  const auto covers = [&](uint32_t k, uint32_t i) {
    const vec3 away = points[i].position - points[k].position;
    return distance(points[i].position, points[k].position) <= options.share * radii[k] &&
           1 - dot(points[i].normal, points[k].normal) <=
               options.share * options.share * options.normal_tolerance &&
           std::abs(dot(away, points[i].normal + points[k].normal)) <= 2 * k_off_plane * radii[k];
  };
  for (uint32_t i = 0; i < points.size(); ++i) {
    const bool stays = std::binary_search(kept.begin(), kept.end(), i);
    // Wider ones, or earlier ones of the same radius, have priority.
    const bool covered = std::any_of(kept.begin(), kept.end(), [&](uint32_t k) {
      return k != i && (radii[k] > radii[i] || (radii[k] == radii[i] && k < i)) && covers(k, i);
    });
    REQUIRE(stays == !covered);
  }
  CHECK(thin_out({}, {}, {}, options).empty());
}

TEST_CASE("thinning keeps a separate record for a panel above a ceiling") {
  // Both face down; the ceiling's record is as wide as a lamp.
  const std::vector<Place> points{{vec3(0), vec3(0, -1, 0)}, {vec3(0.2f, 0.03f, 0), vec3(0, -1, 0)}};
  const std::vector<float> radii{0.6f, 0.05f};
  CHECK(thin_out(points, radii, off_planes(radii), {}).size() == 2);
  // Also for a panel below the ceiling; but not in its plane.
  CHECK(thin_out(std::vector<Place>{points[0], {vec3(0.2f, -0.03f, 0), vec3(0, -1, 0)}}, radii,
                 off_planes(radii), {})
            .size() == 2);
  CHECK(thin_out(std::vector<Place>{points[0], {vec3(0.2f, 0.001f, 0), vec3(0, -1, 0)}}, radii,
                 off_planes(radii), {})
            .size() == 1);
}

}  // namespace cache_placement_tests
