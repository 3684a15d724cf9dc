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

constexpr double k_stop = 0.02;  // cache.stop

struct Pass {
  double asked;
  uint32_t tried, records;
  uint64_t rays;
  double ms, placing_ms;  ///< placing_ms: until its records get rays
};

/// Measured builds, pass by pass: interiors at 900x600.
const std::vector<std::vector<Pass>> k_measured = {
    // classroom
    {{0.9491, 13021, 2309, 1598528, 4562, 2503},
     {0.4889, 24851, 8046, 3652288, 7223, 2432},
     {0.0679, 14573, 11571, 3894848, 7887, 965},
     {0.0074, 3649, 3517, 1134912, 3485, 830}},
    // hall
    {{0.9956, 12437, 2260, 1481024, 3581, 1849},
     {0.7814, 21166, 4675, 2636416, 4601, 2043},
     {0.1669, 12940, 8189, 2936832, 4354, 768},
     {0.0097, 2304, 1803, 609024, 1803, 618}},
    // teapot
    {{0.9956, 4197, 1258, 596800, 2065, 1531},
     {0.0925, 2070, 809, 339584, 1623, 1256},
     {0.0100, 2094, 1425, 498816, 1074, 409}}};

/// At that share of its time, after its records began to get rays.
CachePass pass(const Pass& p, uint32_t number, double part) {
  CachePass r;
  r.number = number, r.complete = part == 1;
  r.paths = 1000000, r.uncovered = uint64_t(p.asked * 1e6);
  r.tried = p.tried, r.records = p.records;
  const double placing = double(p.tried) * Evaluator::k_distance_rays;  // rays that measure distances
  const double evaluated = (part * p.ms - p.placing_ms) / (p.ms - p.placing_ms);
  r.rays = uint64_t(placing + std::max(evaluated, 0.0) * (double(p.rays) - placing));
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
      for (const double part : {0.8, 0.95}) {
        const auto reported = forecast_of(at(all, i, part), k_stop);
        INFO("pass " << i << ", " << part << " of it");
        REQUIRE(reported);
        const double done = before + part * all[i].ms;
        CHECK(reported->done > 0);
        CHECK(reported->done < 1);
        // The total: small scenes finish earlier than the first pass suggests.
        const double predicted = done + reported->left_ms;
        CHECK(predicted < (i == 0 ? 2 : 1.7) * whole);
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
  s = at(k_measured[0], 3, 1);
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
  CacheStatus built = at(k_measured[0], 2, 0.8), relit = built;
  for (uint32_t i = 0; i < 2; ++i) relit.passes[i].relit = true;
  CHECK(forecast_of(relit, k_stop)->left_ms == Approx(forecast_of(built, k_stop)->left_ms));
}

TEST_CASE("records for a new view take their share of the whole build") {
  CacheStatus s = at(k_measured[0], 3, 1);
  CachePass p;
  s.passes.push_back(p);  // the camera has moved; there is no data yet
  CHECK_FALSE(forecast_of(s, k_stop));
  double before = 0, last = 0;
  for (const Pass& measured : k_measured[0]) before += measured.ms;
  for (const double asked : {0.0005, 0.002, 0.02, 0.3, 0.9}) {
    s.passes.back().paths = 1000000, s.passes.back().uncovered = uint64_t(asked * 1e6);
    const double left = forecast_of(s, k_stop)->left_ms;
    CHECK(left > last);
    CHECK(forecast_of(s, k_stop)->done == Approx(before / (before + left)).epsilon(0.01));
    last = left;
  }
  CHECK(last < before);
}

}  // namespace cache_forecast_tests
