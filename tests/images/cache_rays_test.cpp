// links: session
// Which records get how many rays: those that serve more of the picture stop at less noise, by the rule that
// cache.h states. Computed again here from what records tell.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "cache_support.h"
#include "support/rooms.h"

using namespace lucerna;

TEST_CASE("the more of the picture a record serves, the less noise it has when it is done") {
  constexpr float k_noise = 0.05f;
  const scene::Scene room = test::block_room();
  test::CacheRenderer shown(room, 64);
  shown.set(test::k_cached);
  shown.set({{"cache.noise", std::to_string(k_noise)},
             {"cache.min_radius", "1"},
             {"cache.max_rays", "16384"},
             {"samples", "1"}});
  shown.finish();
  REQUIRE(shown.status().stop == irradiance_cache::StopReason::covered);
  const std::vector<irradiance_cache::Record> records = shown.r.cache()->records().read();

  const auto light = [](const irradiance_cache::Record& r) {
    float sum = 0;
    for (const irradiance_cache::Irradiance& part : r.parts) sum += luminance(part.value);
    return sum;
  };
  double mean = 0;
  for (const irradiance_cache::Record& r : records) mean += double(light(r)) / double(records.size());
  const vec3 eye = room.cameras[0].to_world[3];
  const float tall = 2 * std::tan(room.cameras[0].yfov / 2);
  int narrower = 0, wider = 0;  // that one noise for all would stop later, sooner
  for (const irradiance_cache::Record& r : records) {
    // Dark records stop earlier, deep ones by another rule.
    if (double(light(r)) < 0.5 * mean || r.place.origin == shared::k_origin_recursive) continue;
    const float radius = r.radius / (tall * distance(r.place.position, eye));
    const int level = r.rays == 256 ? 0 : r.rays == 1280 ? 1 : r.rays == 5376 ? 2 : 3;
    if (level == 3) continue;  // there are no more rays to be had
    const float share = std::clamp(std::ldexp(0.03f, level) / radius, 0.25f, 4.0f);
    INFO("a radius of " << radius << " of the picture's height, " << r.rays << " rays");
    CHECK(r.error <= 1.001f * k_noise * share * light(r));
    narrower += r.error > k_noise * light(r);
    wider += r.rays > 256 && share < 1;
  }
  // Both sides of the rule are met.
  INFO(narrower << " narrower and " << wider << " wider ones, of " << records.size());
  CHECK(narrower > 5);
  CHECK(wider > 5);
}
