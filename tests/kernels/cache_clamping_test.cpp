// links: irradiance_cache
// Radii clamped by the nearest distances of other records, compared with the same on the host.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "kernels/cache_records_support.h"
#include "solvers/irradiance_cache/clamping.h"

namespace cache_clamping_tests {

using namespace lucerna;
using irradiance_cache::Clamping;
using irradiance_cache::Metric;
using irradiance_cache::Place;
using irradiance_cache::Record;
using Disc = test::RecordDisc;

namespace {

constexpr float k_normal_tolerance = 0.06f, k_off_plane = 0.03f, k_least = 0.01f;

/// True if record i covers the place, as in lookup.glsl.
bool serves(const Disc& i, const Place& at) {
  const vec3 away = at.position - i.place.position;
  const vec3 unit = away / i.radius;
  const double far = std::hypot(double(unit.x) / double(i.stretch), double(unit.y), double(unit.z));
  const float off = i.radius * (i.radius <= 1.001f * k_least ? 2 * k_off_plane : k_off_plane);
  return far < 1 && 1 - dot(at.normal, i.place.normal) < k_normal_tolerance &&
         std::abs(dot(away, at.normal + i.place.normal)) <= 2 * off;
}

float clamped_plainly(const std::vector<Disc>& discs, size_t i, float near) {
  float bound = discs[i].radius;
  for (const Disc& j : discs)
    if (serves(discs[i], j.place))
      bound = std::min(bound, near * (j.nearest + distance(j.place.position, discs[i].place.position)));
  return std::max(bound, std::min(k_least, discs[i].radius));
}

struct Bed : test::RecordBed {
  Clamping clamping;

  Bed(uint32_t capacity, Metric metric)
      : clamping(device, compiler, capacity, irradiance_cache::Cache::defines({}, metric, false)) {}

  std::vector<Record> clamp(const std::vector<Disc>& discs, float near) {
    shared::CacheFrame frame{};
    frame.normal_tolerance = k_normal_tolerance;
    frame.off_plane = k_off_plane, frame.off_plane_least = 2 * k_off_plane;
    return change(discs, k_least, frame,
                  [&](const auto& bind) { clamping.clamp(stream, bind, uint32_t(discs.size()), near); });
  }
};

/// Discs on two floors and a slope; every other one has seen nothing near.
std::vector<Disc> many(uint32_t count, float stretch) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> any(0, 1);
  std::vector<Disc> discs;
  for (uint32_t i = 0; i < count; ++i) {
    Disc d;
    const float x = any(random), z = any(random);
    const float turned = i % 3 == 2 ? 0.2f : 0.0f;
    d.place.position = vec3(x, i % 3 == 1 ? 0.02f : 0.0f, z);
    d.place.normal = vec3(std::sin(turned), std::cos(turned), 0);
    d.radius = 0.02f + 0.3f * any(random) * any(random);
    d.stretch = stretch;
    d.nearest = i % 2 ? std::numeric_limits<float>::infinity() : 0.4f * any(random) * any(random);
    discs.push_back(d);
  }
  return discs;
}

}  // namespace

TEST_CASE("a record that saw a near object clamps the records that would reach across it") {
  Bed bed(8, Metric::split_sphere);
  const vec3 up(0, 1, 0);
  std::vector<Disc> discs{
      {{vec3(0, 0, 0), up}, 1.0f, 5.0f},      // clamped by the next
      {{vec3(0.3f, 0, 0), up}, 0.2f, 0.1f},   // its own radius is smaller than that limit
      {{vec3(0, 0, 0.5f), up}, 0.4f, 5.0f},   // does not reach that far
      {{vec3(0, -0.5f, 0), up}, 0.7f, 5.0f},  // another floor
      {{vec3(0.2f, 0, 0.1f), normalize(vec3(1, 1, 0))}, 0.7f, 5.0f},        // another slope
      {{vec3(5, 0, 0), up}, 1.0f, std::numeric_limits<float>::infinity()},  // alone, nothing near
      {{vec3(8, 0, 0), up}, 0.3f, 0.001f},                                  // at least the minimum
      {{vec3(9, 0, 0), up}, 0.005f, 0.001f},                                // never above its previous radius
  };
  const std::vector<Record> all = bed.clamp(discs, 1);
  const float expected[] = {0.4f, 0.1f, 0.4f, 0.7f, 0.7f, 1.0f, 0.01f, 0.005f};
  for (size_t i = 0; i < discs.size(); ++i) {
    INFO("record " << i);
    CHECK(all[i].radius == Approx(expected[i]).epsilon(1e-6));
  }
}

TEST_CASE("radii of circles and ellipses are clamped as on the host, twice in a row") {
  for (const Metric metric : {Metric::split_sphere, Metric::hessian}) {
    const float stretch = metric == Metric::hessian ? 1.6f : 1.0f;
    for (const float near : {1.0f, 0.5f}) {
      std::vector<Disc> discs = many(3000, stretch);
      Bed bed(uint32_t(discs.size()), metric);
      for (int time = 0; time < 2; ++time) {
        const std::vector<Record> all = bed.clamp(discs, near);
        int wrong = 0, clamped = 0;
        std::vector<Disc> after = discs;
        for (size_t i = 0; i < discs.size(); ++i) {
          const float expected = clamped_plainly(discs, i, near);
          wrong += std::abs(all[i].lesser_radius - expected) > 1e-5f * expected;
          wrong += std::abs(all[i].radius - stretch * expected) > 1e-4f * expected;
          clamped += expected < discs[i].radius;
          after[i].radius = all[i].lesser_radius;
        }
        INFO("stretch " << stretch << ", near " << near << ", time " << time << ": " << clamped
                        << " clamped, " << wrong << " wrong");
        CHECK(wrong <= 3);  // exactly at the border of another record
        if (time == 0) CHECK(clamped > 1000);
        discs = after;
      }
    }
  }
}

}  // namespace cache_clamping_tests
