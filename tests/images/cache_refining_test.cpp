// links: session
// Records get more rays as a picture's number of samples grows, where that reduces its error more than as
// many samples do. Positions and radii stay, noise falls, and the picture does not depend on the size of work
// items.
#include <catch2/catch.hpp>

#include <cmath>

#include "cache_support.h"
#include "support/rooms.h"

namespace cache_refining_tests {

using namespace lucerna;

namespace {

/// Indirect light alone, with the minimum number of initial rays.
test::Settings noisy_records(const char* samples) {
  test::Settings settings = test::k_cached;
  for (const auto& [key, value] : test::Settings{{"components.primary", "off"},
                                                 {"components.caustic", "off"},
                                                 {"cache.gather", "false"},
                                                 {"cache.rays", "64"},
                                                 {"cache.noise", "0.3"},
                                                 {"samples", samples}})
    settings[key] = value;
  return settings;
}

}  // namespace

TEST_CASE("records are refined once more rays reduce the error more than further samples do") {
  const scene::Scene room = test::block_room();
  test::CacheRenderer shown(room, 48, false);
  shown.set(noisy_records("8"));
  shown.finish();
  const irradiance_cache::RawRecords before = shown.records();
  const uint64_t rays = shown.status().rays;
  const double noise = shown.r.image_error().relative_lookup_noise();
  REQUIRE(noise > 0);
  shown.set({{"samples", "256"}});
  const film::Image picture = shown.finish();
  CHECK(shown.r.film().lookup_errors_complete());
  const irradiance_cache::RawRecords after = shown.records();
  INFO(rays << " rays, then " << shown.status().rays << "; noise of records " << noise << ", then "
            << shown.r.image_error().relative_lookup_noise());
  CHECK(shown.status().rays > rays + rays / 4);
  CHECK(shown.r.image_error().relative_lookup_noise() < 0.8 * noise);
  // Radii and positions are unchanged.
  REQUIRE(after.size() == before.size());
  CHECK(after.spheres == before.spheres);

  // Other work items, and an interruption.
  test::CacheRenderer other(room, 48, false);
  other.r.settings().set("path.batch", "32768");
  other.set(noisy_records("256"));
  int calls = 0;
  while (!other.r.done()) other.r.step([&] { return ++calls % 97 == 0; });
  CHECK(test::identical(other.r.image(), picture));
  CHECK(other.records().lights == after.lights);
}

TEST_CASE("refinement continues until records and samples gain equally, or cost as much as the picture") {
  test::CacheRenderer shown(test::block_room(), 48, false);
  test::Settings settings = noisy_records("128");
  settings["cache.noise"] = "10";  // nothing above the first rays before
  shown.set(settings);
  while (shown.r.samples() == 0) REQUIRE(shown.r.step());
  const uint64_t rays = shown.status().rays;
  shown.finish();
  const film::ImageError error = shown.r.image_error();
  const double read = std::pow(error.seen_lookup_noise, 2), sampled = std::pow(error.seen_rms[0], 2);
  const double now = double(shown.status().rays), paths = double(shown.r.stats().paths);
  INFO(rays << " rays, then " << now << "; " << paths << " paths; noise of records "
            << error.seen_lookup_noise << ", of samples " << error.seen_rms[0]);
  CHECK(shown.r.film().lookup_errors_current());
  CHECK(now > 2.0 * double(rays));
  CHECK((2 * read * paths <= sampled * now || now - double(rays) >= paths / 2));
}

TEST_CASE("records whose noise does not matter keep their rays") {
  const scene::Scene room = test::block_room();
  test::CacheRenderer shown(room, 32, false);
  test::Settings settings = noisy_records("16");
  settings["cache.rays"] = "1024", settings["cache.noise"] = "0.02", settings["components.primary"] = "path";
  shown.set(settings);
  while (shown.r.samples() == 0) REQUIRE(shown.r.step());
  const uint64_t rays = shown.status().rays;
  shown.finish();
  CHECK(shown.status().rays == rays);
}

}  // namespace cache_refining_tests
