// links: session
// How far records reach near surfaces, and how passes find the gaps between records.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "cache_support.h"
#include "solvers/irradiance_cache/build.h"
#include "support/rooms.h"

namespace cache_coverage_tests {

using namespace lucerna;

namespace {

/// True if the record would cover that place with a minimum radius of 0.
bool serves(const irradiance_cache::Record& record, const irradiance_cache::Place& at) {
  const vec3 away = at.position - record.place.position;
  return test::far_of(record, at.position) < 1 &&
         1 - dot(at.normal, record.place.normal) < irradiance_cache::k_normal_tolerance &&
         std::abs(dot(away, at.normal + record.place.normal)) <=
             2 * irradiance_cache::k_off_plane * record.lesser_radius;
}

}  // namespace

// For every record and every other record that it covers: by the triangle inequality, no ray of any level of
// the other record has hit a surface farther than allowed.
TEST_CASE(
    "records reach no farther than a share of the nearest distance seen by them or by a record they cover") {
  const scene::Scene room = test::block_room();
  const auto records = [&](const char* nearest, const char* metric) {
    test::CacheRenderer shown(room, 24, false);
    shown.set(test::k_cached);
    shown.set({{"cache.nearest", nearest},
               {"cache.metric", metric},
               {"cache.error", "1"},
               {"cache.max_radius", "1"},
               {"cache.min_radius", "0"},
               {"cache.max_rays", "1024"},
               {"cache.noise", "0.05"},
               {"cache.passes", "2"},
               {"samples", "1"}});
    shown.finish();
    return test::cache(shown.r)->records().read();
  };
  for (const char* metric : {"split-sphere", "hessian"}) {
    size_t count = 0;
    for (const char* share : {"1", "0.4"}) {
      const std::vector<irradiance_cache::Record> all = records(share, metric);
      const float of_nearest = std::stof(share);
      int beyond = 0, bounded = 0;
      for (const irradiance_cache::Record& r : all) {
        float bound = of_nearest * r.least_distance;
        for (const irradiance_cache::Record& other : all)
          if (serves(r, other.place))
            bound = std::min(bound, of_nearest * (other.least_distance +
                                                  distance(other.place.position, r.place.position)));
        beyond += r.lesser_radius > 1.001f * bound;
        bounded += r.lesser_radius > 0.999f * bound;
      }
      INFO(metric << ", share " << share << ": of " << all.size() << " records " << bounded << " bounded, "
                  << beyond << " beyond");
      CHECK(beyond == 0);
      // Ellipses are limited by their own rays and by the bend of the irradiance.
      CHECK((metric == std::string("hessian") || bounded > int(all.size()) / 4));
      CHECK(double(all.size()) > 1.5 * double(count));
      count = all.size();
    }
  }
}

TEST_CASE("passes that find few gaps with one path per pixel trace more paths per pixel") {
  constexpr uint32_t k_side = 32;
  test::CacheRenderer shown(test::block_room(), k_side);
  shown.set(test::k_cached);
  shown.set({{"cache.min_radius", "0.2"},
             {"cache.max_rays", "256"},
             {"cache.stop", "0"},
             {"cache.passes", "8"},
             {"samples", "1"}});
  shown.finish();
  const auto& passes = shown.status().passes;
  REQUIRE(passes.size() >= 7);
  for (size_t k = 0; k < 8 && k < passes.size(); ++k) {
    const auto looks = double(passes[k].paths) / (k_side * k_side);
    const double most = k < 3 ? 1 : std::min(16.0, double(2 << (k - 3)));
    INFO("pass " << k << ": " << passes[k].uncovered << " gaps, with " << looks << " paths per pixel");
    CHECK(looks >= 1);
    CHECK(looks <= most);
    // No more paths than needed, and no fewer while more are allowed.
    CHECK((looks == most || double(passes[k].uncovered) >= 0.1 * k_side * k_side));
    CHECK((looks == 1 || double(passes[k].uncovered) < 0.25 * k_side * k_side));
  }
  CHECK(passes[6].paths == 16 * k_side * k_side);
  const auto share = [&](size_t k) { return double(passes[k].uncovered) / double(passes[k].paths); };
  INFO("gaps: " << share(2) << " of the paths in the third pass, " << share(passes.size() - 1)
                << " in the last");
  CHECK(share(passes.size() - 1) < 0.25 * share(2));
}

}  // namespace cache_coverage_tests
