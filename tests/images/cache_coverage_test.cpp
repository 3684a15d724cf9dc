// links: session
// How far records reach beside what is near, and how passes look for the gaps that they leave.
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "cache_support.h"
#include "support/rooms.h"

using namespace lucerna;

TEST_CASE("records reach no farther than the share of the nearest distance that is asked for") {
  const scene::Scene room = test::block_room();
  const auto records = [&](const char* nearest) {
    test::CacheRenderer shown(room, 64);
    shown.set(test::k_cached);
    // One level alone: later ones find nearer things, by which no radius changes.
    shown.set({{"cache.nearest", nearest},
               {"cache.error", "1"},
               {"cache.max_radius", "1"},
               {"cache.min_radius", "0"},
               {"cache.max_rays", "256"},
               {"cache.passes", "2"},
               {"samples", "1"}});
    shown.finish();
    return shown.r.cache()->records().read();
  };
  for (const float share : {1.0f, 0.4f}) {
    int beyond = 0, bounded = 0;
    const std::vector<irradiance_cache::Record> all = records(share < 1 ? "0.4" : "1");
    for (const irradiance_cache::Record& r : all) {
      beyond += r.radius > 1.001f * share * r.least_distance;
      bounded += r.radius > 0.999f * share * r.least_distance;
    }
    INFO("share " << share << ": of " << all.size() << " records " << bounded << " bounded, " << beyond
                  << " beyond");
    CHECK(beyond == 0);
    CHECK(bounded > int(all.size()) / 4);
  }
}

TEST_CASE("passes that find few gaps along one path a pixel look along more") {
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
    INFO("pass " << k << ": " << passes[k].asked << " asked, along " << looks << " paths a pixel");
    CHECK(looks >= 1);
    CHECK(looks <= most);
    // No more than are needed, and no fewer while they are allowed.
    CHECK((looks == most || double(passes[k].asked) >= 0.1 * k_side * k_side));
    CHECK((looks == 1 || double(passes[k].asked) < 0.25 * k_side * k_side));
  }
  CHECK(passes[6].paths == 16 * k_side * k_side);
  const auto share = [&](size_t k) { return double(passes[k].asked) / double(passes[k].paths); };
  INFO("gaps: " << share(2) << " of the paths in the third pass, " << share(passes.size() - 1)
                << " in the last");
  CHECK(share(passes.size() - 1) < 0.25 * share(2));
}
