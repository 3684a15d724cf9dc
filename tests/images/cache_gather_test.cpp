// links: session
// Paths gather light along edges. The picture there agrees with path tracing without bias and has less noise
// where the light comes from a small part of the visible scene. Records are added where the camera comes
// nearer.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "cache_support.h"
#include "support/rooms.h"

namespace cache_gather_tests {

using namespace lucerna;
using test::Settings;

namespace {

constexpr uint32_t k_size = 32;

/// The minimum radius is so large that every pixel of a small picture lies along an edge.
const Settings k_all_gathered = test::dense_records({{"cache.min_radius", "100"},
                                                     {"cache.max_radius", "1"},
                                                     {"cache.rays", "256"},
                                                     {"cache.max_records", test::k_room}});

uint32_t crowded(const irradiance_cache::RawRecords& all) {
  uint32_t count = 0;
  for (uint32_t r = 0; r < all.size(); ++r) count += all.crowded(r);
  return count;
}

struct Light {
  double mean = 0, error = 0;  ///< of a component over the picture, over seeds; and its standard error
  double noise = 0;            ///< of a pixel, over seeds: standard deviation over the mean
};
Light light(const std::vector<film::Image>& seeds, int component) {
  const size_t pixels = seeds[0].components[component].size();
  const auto n = double(seeds.size());
  Light l;
  double squares = 0, of_pixels = 0;
  for (const film::Image& image : seeds) {
    double sum = 0;
    for (const vec3& p : image.components[component]) sum += double(luminance(p)) / double(pixels);
    l.mean += sum / n, squares += sum * sum / n;
  }
  for (size_t p = 0; p < pixels; ++p) {
    double mean = 0, square = 0;
    for (const film::Image& image : seeds) {
      const auto y = double(luminance(image.components[component][p]));
      mean += y / n, square += y * y / n;
    }
    of_pixels += (square - mean * mean) * n / (n - 1);
  }
  l.error = std::sqrt(std::max(0.0, squares - l.mean * l.mean) / (n - 1));
  l.noise = std::sqrt(of_pixels / double(pixels)) / l.mean;
  return l;
}

/// Pictures of eight seeds with the cache and of eight others by path tracing, and the records of the last
/// cache.
struct Seeds {
  std::vector<film::Image> cached, traced;
  irradiance_cache::RawRecords records;
};
std::vector<film::Image> traced_of(const scene::Scene& room, const char* samples) {
  std::vector<film::Image> all;
  test::CacheRenderer by_paths(room, k_size, false);
  for (int seed = 101; seed <= 108; ++seed) {
    by_paths.set({{"seed", std::to_string(seed)}, {"samples", samples}});
    all.push_back(by_paths.finish());
  }
  return all;
}
Seeds seeds_of(const scene::Scene& room, const Settings& cache, std::vector<film::Image> traced) {
  Seeds seeds{.cached = {}, .traced = std::move(traced), .records = {}};
  test::CacheRenderer by_cache(room, k_size, false);
  by_cache.set(test::k_cached);
  by_cache.set(cache);
  for (int seed = 1; seed <= 8; ++seed) {
    by_cache.set({{"seed", std::to_string(seed)}, {"samples", "16"}});
    seeds.cached.push_back(by_cache.finish());
  }
  seeds.records = by_cache.records();
  return seeds;
}

/// Checks that a component's means agree within 4.2 standard errors and `bias` of the component, and that the
/// standard error is at most `error` of it.
void check_alike(const Seeds& seeds, int component, double bias, double error) {
  const Light a = light(seeds.cached, component), b = light(seeds.traced, component);
  INFO("component " << component << ": " << a.mean << " +- " << a.error << ", path tracing " << b.mean
                    << " +- " << b.error);
  CHECK(std::abs(a.mean - b.mean) < 4.2 * std::hypot(a.error, b.error) + bias * b.mean);
  CHECK(a.error < error * a.mean);
  CHECK(b.error < error * b.mean);
}

}  // namespace

// Independent seeds, each with its own cache. Two components of two rooms: 4.2 standard errors of the
// difference are significant at 1e-4 for all four together.
TEST_CASE("a picture gathered by paths alone agrees with path tracing and has less noise") {
  for (const bool environment : {false, true}) {
    INFO((environment ? "with a sky" : "with a lamp alone"));
    const scene::Scene room = test::block_room(environment);
    const Seeds seeds = seeds_of(room, k_all_gathered, traced_of(room, "64"));
    INFO(crowded(seeds.records) << " of " << seeds.records.size() << " records crowd");
    CHECK(crowded(seeds.records) == seeds.records.size());
    for (const int c : {1, 2}) check_alike(seeds, c, 0, 0.03);
  }
}

// At the point that such a path hits, the lookup gives the light of further vertices; the path itself samples
// and hits the lights at this vertex, mostly the environment.
TEST_CASE("paths that gather and then read records include environment light") {
  // Paths gather along edges, which is half of the picture; at the points that their rays hit records are
  // read.
  const scene::Scene room = test::block_room(true);
  const Seeds seeds =
      seeds_of(room, {{"cache.min_radius", "2"}, {"cache.rays", "256"}, {"cache.error", "0.15"}},
               traced_of(room, "32"));
  const size_t count = seeds.records.size();
  INFO(crowded(seeds.records) << " of " << count << " records crowd");
  CHECK(crowded(seeds.records) > count / 4);
  CHECK(crowded(seeds.records) < count * 3 / 4);
  // Tolerance for the interpolation error.
  for (const int c : {1, 2}) check_alike(seeds, c, 0.01, 0.01);
}

// Gloss, direct light and transmitted light at such a vertex are counted once. Eight branches remove most of
// the noise except that of the positions of paths in a pixel.
TEST_CASE("a sample that gathers with several paths gives the same picture with less noise") {
  scene::Scene room = test::block_room(true);
  room.materials[0].specular = 1, room.materials[0].roughness = 0.4f;
  room.materials[1].alpha_mode = scene::AlphaMode::blend, room.materials[1].base_color.w = 0.6f;
  const std::vector<film::Image> traced = traced_of(room, "64");
  const auto with = [&](const char* branches) {
    Settings settings = k_all_gathered;
    settings["cache.branches"] = branches;
    return seeds_of(room, settings, traced);
  };
  const Seeds one = with("1"), many = with("8");
  for (const int c : {0, 1, 2}) check_alike(one, c, 0, 0.03);
  for (const int c : {0, 1, 2}) check_alike(many, c, 0, 0.03);
  const double ratio = light(many.cached, 1).noise / light(one.cached, 1).noise;
  INFO("noise of secondary light " << light(one.cached, 1).noise << ", by eight branches " << ratio
                                   << " of that");
  CHECK(ratio < 0.6);
}

TEST_CASE("paths that gather find light from a small part of the hemisphere") {
  // A lamp twelve centimetres above the floor: the ceiling is lit mostly by a small spot of the floor.
  scene::Scene s;
  s.name = s.file = "spot";
  s.materials = {test::diffuse(vec3(0.6f))};
  s.environment.given = true;
  test::add_box(s, {-1, 0, -1}, {1, 1, 1});
  s.lights.push_back({.name = "lamp", .intensity = vec3(1), .position = {0.4f, 0.12f, 0.4f}});
  // Every visible point is near the edge between ceiling and wall.
  scene::Camera up;
  up.yfov = 0.2f;
  up.to_world = glm::inverse(glm::lookAt(vec3(0, 0.5f, 0), vec3(0, 1, -1), vec3(0, 1, 0)));
  s.cameras = {up};
  const auto noise = [&](const char* gather) {
    test::CacheRenderer shown(s, k_size, false);
    shown.set(test::k_cached);
    shown.set(k_all_gathered);
    shown.set({{"cache.max_radius", "0.05"}});
    std::vector<film::Image> seeds;
    for (int seed = 1; seed <= 8; ++seed) {
      shown.set({{"seed", std::to_string(seed)}, {"samples", "16"}, {"components.secondary", gather}});
      seeds.push_back(shown.finish());
    }
    return light(seeds, 1);
  };
  const Light guided = noise("cache"), traced = noise("path");
  INFO("guided " << guided.mean << ", noise " << guided.noise << "; path traced " << traced.mean << ", noise "
                 << traced.noise);
  CHECK(std::abs(guided.mean - traced.mean) < 4 * std::hypot(guided.error, traced.error));
  CHECK(guided.noise < 0.6 * traced.noise);
}

TEST_CASE("records store light once the camera has come near enough") {
  test::CacheRenderer shown(test::block_room(), k_size);
  shown.set(test::k_cached);
  shown.set({{"samples", "1"}});
  shown.finish();
  const irradiance_cache::RawRecords far = shown.records();
  REQUIRE(crowded(far) > 20);
  scene::Camera near = shown.r.camera();
  near.yfov *= 0.2f;
  shown.r.set_camera(near);
  shown.finish();
  const irradiance_cache::RawRecords now = shown.records();
  INFO(far.size() << " records, " << crowded(far) << " crowd; then " << now.size() << ", " << crowded(now));
  // Records that already have light do not change.
  CHECK(test::keeps_places(test::lit(now), test::lit(far)));
  // Records with room beyond the present minimum radius are no longer crowded.
  const irradiance_cache::Cache& cache = *test::cache(shown.r);
  int roomy = 0, of_before = 0;
  for (const irradiance_cache::Record& r : cache.records().read()) {
    if (!r.crowded) continue;
    const float least =
        3 * 2 * std::tan(near.yfov / 2) / k_size * distance(r.place.position, vec3(near.to_world[3]));
    roomy += r.lesser_radius > 2.02f * least && r.least_distance > 4.04f * least;
    of_before += r.lesser_radius > 2.02f * least;
  }
  INFO(of_before << " are not updated, " << roomy << " of them with room");
  CHECK(roomy == 0);
  CHECK(test::lit(now).size() > test::lit(far).size() + 20);
}

}  // namespace cache_gather_tests
