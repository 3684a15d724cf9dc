// links: irradiance_cache
// The forecast of the remaining build time, compared with measured builds.
#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "solvers/irradiance_cache/build_forecast.h"

namespace cache_forecast_tests {

using namespace lucerna;
using namespace lucerna::irradiance_cache;

namespace {

constexpr double k_stop = 0.002;  // cache.stop

struct Pass {
  double asked;
  uint32_t records;
  uint64_t rays;
  double ms;
};

/// Measured builds, pass by pass: interiors at 900x600.
const std::vector<std::vector<Pass>> k_measured = {
    // classroom
    {{0.9491, 11571, 6393472, 13775},
     {0.5027, 28710, 11066368, 24738},
     {0.2146, 28708, 10162688, 26592},
     {0.0162, 8199, 2982080, 10427},
     {0.0048, 6669, 2335104, 10139},
     {0.0024, 6407, 2239552, 11025},
     {0.0016, 720, 335680, 3435}},
    // hall
    {{0.9956, 11189, 5857536, 13508},
     {0.7530, 27511, 11288320, 23410},
     {0.4217, 27312, 10997632, 23464},
     {0.0518, 6366, 3383872, 7739},
     {0.0110, 3560, 1775872, 6268},
     {0.0022, 2156, 1015296, 5888},
     {0.0009, 508, 331968, 3174}},
    // teapot
    {{0.9956, 1823, 1421376, 2891},
     {0.0893, 2100, 840000, 2781},
     {0.0411, 3098, 1153920, 3017},
     {0.0018, 502, 211072, 1228}}};

CachePass pass(const Pass& p, uint32_t number, double part) {
  CachePass r;
  r.number = number, r.complete = part == 1;
  r.paths = 1000000, r.uncovered = uint64_t(p.asked * 1e6);
  r.records = p.records, r.rays = uint64_t(part * double(p.rays));
  r.ms[size_t(BuildStep::evaluate)] = part * p.ms;
  return r;
}

/// The state of a build at that share of that pass.
CacheStatus at(const std::vector<Pass>& all, uint32_t number, double part) {
  CacheStatus s;
  for (uint32_t i = 0; i <= number; ++i) {
    s.passes.push_back(pass(all[i], i, i < number ? 1 : part));
    s.rays += s.passes.back().rays;
  }
  return s;
}

}  // namespace

TEST_CASE("the remaining time of a cache build is forecast") {
  for (const auto& all : k_measured) {
    double whole = 0, before = 0;
    for (const Pass& p : all) whole += p.ms;
    for (uint32_t i = 0; i < all.size(); ++i) {
      for (const double part : {0.4, 0.7}) {
        const auto reported = forecast_of(at(all, i, part), k_stop);
        INFO("pass " << i << ", " << part << " of it");
        REQUIRE(reported);
        const double done = before + part * all[i].ms;
        CHECK(reported->done > 0);
        CHECK(reported->done < 1);
        // The total: small scenes finish earlier than the first pass suggests.
        const double predicted = done + reported->left_ms;
        CHECK(predicted < (i == 0 ? 2.3 : 1.7) * whole);
        CHECK(predicted > whole / 1.7);
        CHECK(reported->done == Approx(done / predicted));
      }
      before += all[i].ms;
    }
  }
}

TEST_CASE("before a record has light, and after building has stopped, there is no forecast") {
  CacheStatus s;
  CHECK_FALSE(forecast_of(s, k_stop));
  s = at(k_measured[0], 0, 0.5);
  s.passes[0].rays = 0;
  CHECK_FALSE(forecast_of(s, k_stop));
  s = at(k_measured[0], 6, 1);
  s.stop = StopReason::covered;
  CHECK_FALSE(forecast_of(s, k_stop));
}

TEST_CASE("progress of relighting is measured in the records' previous rays") {
  CacheStatus s;
  s.relighting = {.records = 100, .share = 0.5f, .rays = 4000};
  CHECK_FALSE(forecast_of(s, k_stop));  // no record has rays yet
  CachePass p;
  p.relit = true, p.records = 100, p.rays = 1000;
  p.ms[size_t(BuildStep::evaluate)] = 50;
  s.passes = {p}, s.rays = 1000;
  const auto reported = forecast_of(s, k_stop);
  REQUIRE(reported);
  CHECK(reported->done == Approx(0.25));
  CHECK(reported->left_ms == Approx(150));
  // Rays are counted before their time is known, and set-up time does not scale.
  s.passes[0].ms = {};
  s.passes[0].ms[size_t(BuildStep::measure)] = 500;
  CHECK_FALSE(forecast_of(s, k_stop));
  s.passes[0].ms[size_t(BuildStep::evaluate)] = 50;
  CHECK(forecast_of(s, k_stop)->left_ms == Approx(150));
  CHECK(forecast_of(s, k_stop)->done == Approx(0.25));
  // More rays than before: nearly finished, never above 1.
  s.rays = s.passes[0].rays = 5000;
  CHECK(forecast_of(s, k_stop)->done < 1);
  s.relighting.rays = 0;
  CHECK_FALSE(forecast_of(s, k_stop));
  s.relighting = {};  // all are relit, and the next pass has not started
  CHECK_FALSE(forecast_of(s, k_stop));
}

TEST_CASE("building that continues after relighting resumes its progress") {
  CacheStatus built = at(k_measured[0], 3, 0.5), relit = built;
  for (uint32_t i = 0; i < 3; ++i) relit.passes[i].relit = true;
  CHECK(forecast_of(relit, k_stop)->left_ms == Approx(forecast_of(built, k_stop)->left_ms));
}

TEST_CASE("records for a new view take their share of the whole build") {
  CacheStatus s = at(k_measured[0], 6, 1);
  CachePass p;
  s.passes.push_back(p);  // the camera has moved; there is no data yet
  CHECK_FALSE(forecast_of(s, k_stop));
  double last = 0;
  for (const double asked : {0.0005, 0.002, 0.02, 0.3, 0.9}) {
    s.passes.back().paths = 1000000, s.passes.back().uncovered = uint64_t(asked * 1e6);
    const double left = forecast_of(s, k_stop)->left_ms;
    CHECK(left > last);
    CHECK(forecast_of(s, k_stop)->done == Approx(100130 / (100130 + left)).epsilon(0.01));
    last = left;
  }
  CHECK(last < 100131);
}

}  // namespace cache_forecast_tests
