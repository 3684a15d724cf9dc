// links: irradiance_cache
// Radii bounded by neighbours in different directions, against the same done plainly on the host.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "kernels/cache_records_support.h"
#include "solvers/irradiance_cache/neighbours.h"
#include "support/neighbours.h"

using namespace lucerna;
using irradiance_cache::Metric;
using irradiance_cache::Neighbours;
using irradiance_cache::Place;
using Disc = test::RecordDisc;

namespace {

constexpr float k_normal_tolerance = 0.06f, k_off_plane = 0.03f, k_least = 0.06f;

struct Bed : test::RecordBed {
  Neighbours neighbours{device, compiler, irradiance_cache::Cache::defines({}, Metric::split_sphere)};

  /// Radii of all.
  std::vector<float> bound(const std::vector<Disc>& discs) {
    shared::CacheFrame frame{};
    frame.normal_tolerance = k_normal_tolerance;
    frame.off_plane = frame.off_plane_least = k_off_plane;
    std::vector<float> radii;
    for (const irradiance_cache::Record& r : change(discs, k_least, frame, [&](const auto& bind) {
           neighbours.bound(stream, bind, uint32_t(discs.size()));
         })) {
      CHECK(r.lesser_radius == r.radius);
      radii.push_back(r.radius);
    }
    return radii;
  }
};

double bounded_plainly(const std::vector<Disc>& discs, size_t i) {
  const Disc& own = discs[i];
  std::vector<test::Neighbour> served;
  for (size_t j = 0; j < discs.size(); ++j) {
    const vec3 away = discs[j].place.position - own.place.position;
    const vec3 &n = own.place.normal, &m = discs[j].place.normal;
    const double far = double(length(away)) / double(own.radius);
    if (j != i && far < 1 && 1 - dot(n, m) < k_normal_tolerance &&
        std::abs(dot(away, n + m)) <= 2 * k_off_plane * own.radius)
      served.push_back({far, test::angle_in_plane(away, n)});
  }
  const double share = test::share_by_neighbours(served);
  return std::min(double(own.radius), std::max(share * double(own.radius), double(k_least)));
}

}  // namespace

TEST_CASE("a record in a lattice reaches its neighbours, one at the border as far as it did") {
  Bed bed;
  constexpr int k_side = 9;
  constexpr float k_spacing = 0.1f, k_radius = 0.29f;
  std::vector<Disc> discs;
  for (int y = 0; y < k_side; ++y)
    for (int x = 0; x < k_side; ++x)
      discs.push_back(
          {{vec3(k_spacing * (float(x) + 0.5f * float(y % 2)), 1, k_spacing * std::sqrt(0.75f) * float(y)),
            vec3(0, 1, 0)},
           k_radius});
  const std::vector<float> radii = bed.bound(discs);
  for (int y = 0; y < k_side; ++y)
    for (int x = 0; x < k_side; ++x) {
      INFO(x << ", " << y);
      const bool inside = x > 0 && y > 0 && x + 1 < k_side && y + 1 < k_side;
      const bool edge = y == 0 || y + 1 == k_side;
      if (inside) CHECK(radii[size_t(y * k_side + x)] == Approx(k_spacing).epsilon(1e-4));
      if (edge) CHECK(radii[size_t(y * k_side + x)] == k_radius);
    }
}

TEST_CASE("neighbours on other surfaces do not count, and radii are as the host finds them") {
  Bed bed;
  std::mt19937 random(7);
  const auto uniform = [&] { return float(random() >> 8) / 16777216.0f; };
  std::vector<Disc> discs;
  // A floor, a shelf 5 cm above it, and a wall; radii over one decade.
  for (int i = 0; i < 3000; ++i) {
    const float u = 2 * uniform(), v = 2 * uniform(), radius = 0.05f * std::pow(10.0f, uniform());
    const bool wall = i % 3 == 2;
    const Place place{wall ? vec3(0, u, v) : vec3(u, i % 3 == 1 ? 0.05f : 0.0f, v),
                      wall ? vec3(1, 0, 0) : vec3(0, 1, 0)};
    discs.push_back({place, radius});
  }
  const std::vector<float> radii = bed.bound(discs);
  size_t shrunk = 0, least = 0, wrong = 0;
  for (uint32_t i = 0; i < discs.size(); ++i) {
    const double expected = bounded_plainly(discs, i);
    wrong += std::abs(double(radii[i]) - expected) > 1e-4 * expected;
    shrunk += radii[i] < discs[i].radius;
    least += radii[i] == k_least;
  }
  CHECK(wrong == 0);
  CHECK(shrunk > 1000);
  CHECK(least > 0);
  CHECK(shrunk < discs.size());  // some stand alone
  CHECK(bed.bound(discs) == radii);
}
