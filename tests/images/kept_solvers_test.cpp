// links: session
// Work of solvers that are deselected and later selected again: changes in between decide how much of it
// stays valid.
#include <catch2/catch.hpp>

#include "images/cache_support.h"
#include "support/rooms.h"

using namespace lucerna;
using test::begins_with, test::identical, test::Settings;

namespace {

const Settings k_base = test::dense_records({{"components.tertiary", "cache"},
                                             {"cache.rays", "64"},
                                             {"cache.max_rays", "256"},
                                             {"cache.error", "0.6"},
                                             {"cache.max_records", "5000"},
                                             {"cache.irradiance_weight", "0"},
                                             {"cache.metric", "split-sphere"},
                                             {"samples", "2"}});
const Settings k_path{{"components.tertiary", "path"}}, k_cache{{"components.tertiary", "cache"}};

}  // namespace

TEST_CASE("a cache that is switched off is reused when it is switched on") {
  test::CacheRenderer bed(test::block_room(true), 24);
  bed.set(k_base);
  const film::Image first = bed.finish();
  const irradiance_cache::RawRecords records = bed.records();
  const uint64_t rays = bed.status().rays;
  REQUIRE(records.size() > 20);

  bed.set(k_path);
  REQUIRE(bed.r.solver("cache") == nullptr);
  bed.finish();
  bed.set({{"film.ev", "1"}, {"samples", "3"}});
  bed.set({{"film.ev", "0"}, {"samples", "2"}});
  bed.set(k_cache);
  CHECK_FALSE(bed.r.preparing());
  CHECK(identical(bed.records(), records));
  const film::Image second = bed.finish();
  CHECK(bed.status().rays == rays);
  for (int c = 0; c < film::k_components; ++c) CHECK(second.components[c] == first.components[c]);
}

TEST_CASE("changes made while a cache is off invalidate the same parts as always") {
  test::CacheRenderer bed(test::block_room(true), 24);
  bed.set(k_base);
  bed.finish();
  const irradiance_cache::RawRecords records = bed.records();

  // Other light: positions stay, and the light is that of a new cache.
  bed.set(k_path);
  scene::Light lamp = bed.r.scene()->lights[0];
  lamp.intensity = {9, 2, 1};
  bed.r.set_light(0, lamp);
  bed.set(k_cache);
  CHECK(bed.r.preparing());
  const film::Image relit = bed.finish();
  CHECK(test::keeps_places(test::lit(bed.records()), test::lit(records)));
  {
    test::CacheRenderer fresh(test::block_room(true), 24);
    fresh.r.set_light(0, lamp);
    fresh.set(k_base);
    const film::Image expected = fresh.finish();
    CHECK(test::mean(relit.components[2]) == Approx(test::mean(expected.components[2])).epsilon(0.02));
  }
  // Another seed gives another cache.
  bed.set(k_path);
  bed.set({{"seed", "7"}});
  bed.set(k_cache);
  bed.finish();
  CHECK_FALSE(identical(bed.records(), records));
  // Shader reloads and scenes.
  for (const bool scene : {false, true}) {
    bed.set(k_path);
    if (scene)
      bed.r.set_scene(std::make_shared<scene::Scene>(test::block_room(true)));
    else
      bed.r.reload_shaders();
    bed.set(k_base);
    CHECK(bed.r.preparing());
    CHECK(bed.records().size() == 0);
  }
}
