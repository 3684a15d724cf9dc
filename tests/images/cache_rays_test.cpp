// links: session
// How many rays each record gets: a record that more of the picture reads stops at less noise, by the rule in
// cache.h (noise.h for a single record); and how much of the picture reads a record. Both are computed here
// again from the records' data.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "cache_support.h"
#include "support/rooms.h"

namespace cache_rays_tests {

using namespace lucerna;

TEST_CASE("the more of the picture reads a record, the less noise it has at the end") {
  constexpr float k_noise = 0.05f;
  const scene::Scene room = test::block_room();
  test::CacheRenderer shown(room, 64, false);
  shown.set(test::k_cached);
  shown.set({{"cache.noise", std::to_string(k_noise)},
             {"cache.min_radius", "1"},
             {"cache.max_rays", "16384"},
             {"cache.passes", "1"},
             {"samples", "1"}});
  shown.finish();
  REQUIRE(shown.status().stop == irradiance_cache::StopReason::passes);
  const std::vector<irradiance_cache::Record> records = test::cache(shown.r)->records().read();
  const std::vector<float>& importance = test::cache(shown.r)->importance();
  REQUIRE(importance.size() == records.size());

  const auto light = [](const irradiance_cache::Record& r) {
    float sum = 0;
    for (const irradiance_cache::Irradiance& part : r.parts) sum += luminance(part.value);
    return sum;
  };
  double mean = 0;
  for (const irradiance_cache::Record& r : records) mean += double(light(r)) / double(records.size());
  // Records for which a common noise bound would stop later; sooner; records that no pixel reads.
  int less = 0, more = 0, none = 0;
  // The stop criterion averages over neighbouring records, so records meet the rule on average: the rms of
  // noise over bound.
  double stopped = 0;
  int stops = 0;
  for (size_t i = 0; i < records.size(); ++i) {
    const irradiance_cache::Record& r = records[i];
    // Dark records stop earlier.
    if (r.crowded || double(light(r)) < 0.5 * mean) continue;
    const int level = r.rays == 256 ? 0 : r.rays == 1280 ? 1 : r.rays == 5376 ? 2 : 3;
    if (level == 3) continue;  // the maximum number of rays
    const float share = std::ldexp(0.03f * std::sqrt(0.5f / std::max(importance[i], 1e-20f)), level);
    if (importance[i] > 0) {
      const double over = double(r.error) / (k_noise * double(share) * double(light(r)));
      stopped += over * over, ++stops;
    }
    less += r.error > k_noise * light(r);
    more += r.rays > 256 && share < 1;
    none += importance[i] <= 0;
  }
  stopped = std::sqrt(stopped / stops);
  INFO(stopped << " of the bound where " << stops << " stop");
  // 0.42: most records of the last level are well below the bound. Twice the bound gives 1.1, half of it
  // 0.19.
  CHECK(stopped < 0.6);
  CHECK(stopped > 0.3);
  // Both sides of the rule and its end occur.
  INFO(less << " less and " << more << " more, " << none << " without readers, of " << records.size());
  CHECK(less > 5);
  CHECK(more > 5);
  CHECK(none > 0);
}

TEST_CASE("levels after the first have at most 16 rays per pixel in a pass, more for a lower noise bound") {
  const scene::Scene room = test::block_room();
  constexpr uint32_t k_size = 16;
  const auto further = [&](const char* noise) {
    test::CacheRenderer shown(room, k_size, false);
    shown.set(test::k_cached);
    shown.set({{"cache.noise", noise},
               {"cache.rays", "64"},
               {"cache.min_radius", "1"},
               {"cache.passes", "1"},
               {"samples", "1"}});
    shown.finish();
    uint64_t rays = 0;
    for (const irradiance_cache::Record& r : test::cache(shown.r)->records().read())
      rays += uint64_t(r.rays) - 64;
    return double(rays) / (k_size * k_size);
  };
  // The first pass wants more than that in both cases.
  const double usual = further("0.3"), less = further("0.15");
  INFO(usual << " and " << less << " rays per pixel");
  CHECK(usual <= 16);
  CHECK(usual > 8);
  CHECK(less <= 64);
  CHECK(less > 32);
}

TEST_CASE("a record's importance is the square of its share of the picture, summed over the pixels") {
  const test::PanelRoom room;
  constexpr uint32_t k_size = 64;
  test::CacheRenderer shown(room.s, k_size);
  // Records do not read each other. One level, so radii stay as measured; circles, as assumed below.
  shown.set({{"components.secondary", "cache"},
             {"cache.gather", "false"},
             {"cache.max_rays", "256"},
             {"cache.metric", "split-sphere"},
             {"samples", "1"}});
  shown.finish();
  const std::vector<irradiance_cache::Record> records = test::cache(shown.r)->records().read();
  const std::vector<float>& importance = test::cache(shown.r)->importance();
  REQUIRE(importance.size() == records.size());

  // The camera sees the floor alone: a record's weight there decreases from its centre to its border.
  const float half = 0.98f * std::tan(0.7f);
  constexpr int k_points = 64;  // per pixel
  std::mt19937 random(3);
  const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
  std::vector<double> expected(records.size());
  for (uint32_t y = 0; y < k_size; ++y)
    for (uint32_t x = 0; x < k_size; ++x) {
      std::vector<double> share(records.size());
      for (int k = 0; k < k_points; ++k) {
        const vec3 at(half * (2 * (float(x) + unit()) / k_size - 1), 0,
                      half * (2 * (float(y) + unit()) / k_size - 1));
        std::vector<std::pair<size_t, float>> serve;
        float all = 0;
        for (size_t i = 0; i < records.size(); ++i) {
          const vec3 centre = records[i].place.position;
          if (records[i].place.normal.y < 0.9f || centre.y > 0.01f) continue;
          const float weight = 1 - distance(vec3(centre.x, 0, centre.z), at) / records[i].radius;
          if (weight > 0) serve.push_back({i, weight}), all += weight;
        }
        for (const auto& [i, weight] : serve) share[i] += double(weight / all) / k_points;
      }
      for (size_t i = 0; i < records.size(); ++i) expected[i] += share[i] * share[i] / (k_size * k_size);
    }
  double all = 0, measured = 0, off = 0;
  for (size_t i = 0; i < records.size(); ++i) {
    all += expected[i], measured += double(importance[i]);
    // A pair of points per pixel estimates it with some noise, in steps of 1/256 of a pixel.
    off += std::abs(expected[i] - double(importance[i]));
    if (expected[i] == 0) CHECK(importance[i] < 1e-6f);
  }
  INFO(records.size() << " records, " << measured << " where " << all << " is expected, off by " << off);
  CHECK(all > 0.05);
  CHECK(measured == Approx(all).epsilon(0.03));
  CHECK(off < 0.15 * all);
}

TEST_CASE("light that the picture reads through another record counts by its contribution there") {
  const test::PanelRoom room;
  constexpr uint32_t k_size = 64;
  test::CacheRenderer shown(room.s, k_size, false);
  shown.set(test::k_cached);
  shown.set({{"cache.max_rays", "256"},
             {"cache.gather", "false"},
             {"cache.metric", "split-sphere"},
             {"samples", "1"}});
  shown.finish();
  const std::vector<irradiance_cache::Record> records = test::cache(shown.r)->records().read();
  const std::vector<float>& importance = test::cache(shown.r)->importance();
  REQUIRE(importance.size() == records.size());

  // Paths like the camera's: to the floor, then cosine-distributed to a wall or the ceiling of a room of 2 x
  // 1 x 2 m; paths that hit the black panel contribute nothing.
  std::mt19937 random(5);
  const auto unit = [&] { return float(random() >> 8) / 16777216.0f; };
  struct Served {
    std::vector<std::pair<size_t, float>> by;  // shares
    float light = 0;
  };
  const auto serve = [&](const vec3& x, const vec3& n) {
    Served s;
    float all = 0;
    for (size_t i = 0; i < records.size(); ++i) {
      const irradiance_cache::Place& p = records[i].place;
      if (dot(p.normal, n) < 0.9f || std::abs(dot(p.position - x, n)) > 0.005f) continue;
      const float weight = 1 - distance(p.position, x) / records[i].radius;
      if (weight <= 0) continue;
      float light = 0;
      for (const irradiance_cache::Irradiance& part : records[i].parts) light += luminance(part.value);
      s.by.push_back({i, weight}), s.light += weight * light, all += weight;
    }
    for (auto& [i, share] : s.by) share /= all;
    s.light /= std::max(all, 1e-30f);
    return s;
  };
  const float half = 0.98f * std::tan(0.7f);
  constexpr int k_paths = 8;  // per pixel and half
  std::vector<double> expected(records.size());
  for (uint32_t y = 0; y < k_size; ++y)
    for (uint32_t x = 0; x < k_size; ++x) {
      // The square of a mean, as a product of two independent means.
      std::map<size_t, std::array<double, 2>> share;
      for (int k = 0; k < 2 * k_paths; ++k) {
        const vec3 from(half * (2 * (float(x) + unit()) / k_size - 1), 0,
                        half * (2 * (float(y) + unit()) / k_size - 1));
        const float r = std::sqrt(unit()), phi = 2 * k_pi * unit();
        const vec3 d(r * std::cos(phi), std::sqrt(std::max(1e-9f, 1 - r * r)), r * std::sin(phi));
        const float up = 1 / d.y, along = (std::copysign(1.0f, d.x) - from.x) / d.x,
                    across = (std::copysign(1.0f, d.z) - from.z) / d.z;
        const float t = std::min({up, along, across});
        const vec3 panel = from + 0.99f * up * d;
        if (panel.x > 0.3f && panel.x < 0.9f && std::abs(panel.z) < 0.5f && 0.99f * up < t) continue;
        const vec3 n = t == up      ? vec3(0, -1, 0)
                       : t == along ? vec3(-std::copysign(1.0f, d.x), 0, 0)
                                    : vec3(0, 0, -std::copysign(1.0f, d.z));
        const Served first = serve(from, {0, 1, 0}), next = serve(from + t * d, n);
        if (first.light <= 0) continue;
        const double ratio = 0.5 * double(next.light / first.light) / k_paths;
        for (const auto& [i, part] : next.by) share[i][size_t(k % 2)] += double(part) * ratio;
      }
      for (const auto& [i, s] : share) expected[i] += s[0] * s[1] / (k_size * k_size);
    }
  // The picture itself also reads records on the floor.
  double all = 0, measured = 0;
  size_t beyond = 0;
  for (size_t i = 0; i < records.size(); ++i) {
    if (records[i].place.normal.y > 0.9f) continue;
    all += expected[i], measured += double(importance[i]), ++beyond;
  }
  INFO(beyond << " records, " << measured << " where " << all << " is expected");
  CHECK(beyond > 100);
  CHECK(all > 0.001);
  // One pair of paths per pixel: only some of the pairs read a record.
  CHECK(measured == Approx(all).epsilon(0.15));
}

}  // namespace cache_rays_tests
