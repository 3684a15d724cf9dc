// links: irradiance_cache scene_io bvh_embree
// The contents of a record of the irradiance cache, through the real kernels: irradiance, both gradients and
// distances compared with closed forms, parts with each other, levels and batches.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "support/cache.h"

namespace cache_record_tests {

using namespace lucerna;
using irradiance_cache::Place;
using irradiance_cache::Record;
using test::disk_irradiance, test::moments, test::Moments;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr uint32_t k_direct = 1, k_beyond = 0b1110;

/// Irradiance vector (integral of radiance times direction) of scenes/furnace-disk above the floor: of a disk
/// of radius 1 and radiance 10 (red) at height 2 over a point at x. Midpoint rule.
std::array<double, 3> disk_vector(double x) {
  constexpr int k_rings = 600, k_sectors = 600;
  std::array<double, 3> sum{};
  for (int i = 0; i < k_rings; ++i)
    for (int k = 0; k < k_sectors; ++k) {
      const double r = (i + 0.5) / k_rings, phi = 2 * pi * (k + 0.5) / k_sectors;
      const double dx = r * std::cos(phi) - x, dy = 2, dz = r * std::sin(phi),
                   d2 = dx * dx + dy * dy + dz * dz;
      const double area = r / k_rings * (2 * pi / k_sectors), solid = area * dy / (d2 * std::sqrt(d2));
      sum[0] += 10 * solid * dx / std::sqrt(d2);
      sum[1] += 10 * solid * dy / std::sqrt(d2);
      sum[2] += 10 * solid * dz / std::sqrt(d2);
    }
  return sum;
}

}  // namespace

TEST_CASE("irradiance and gradients under a disk light match the closed form") {
  test::CacheBed bed(test::CacheBed::load("furnace-disk"));
  bed.set_frame(k_direct);
  constexpr size_t k_repeats = 64;
  const std::vector<double> distances{0, 0.4, 0.9, 1.5, 2.5};
  const vec3 out(std::cos(0.6f), 0, std::sin(0.6f)), aside(-out.z, 0, out.x);
  std::vector<Place> places;
  for (const double d : distances)
    for (size_t i = 0; i < k_repeats; ++i)
      places.push_back({vec3(float(d) * out.x, 1e-4f, float(d) * out.z), vec3(0, 1, 0)});
  const auto records = bed.evaluate(places, {.elevations = 32, .azimuths = 128, .parts = k_direct});
  for (size_t i = 0; i < distances.size(); ++i) {
    const double d = distances[i];
    INFO("at " << d);
    // Two-sided at 1e-4 for each of about 40 figures: 3.9 standard errors; plus the error of cells of this
    // size, 1.5 % (for 16 x 64 cells 4 %).
    const auto expect = [&](const char* what, double truth, double scale, const auto& value) {
      const Moments m = moments(records, i * k_repeats, k_repeats, value);
      INFO(what << ": " << m.mean << " +- " << m.deviation << ", expected " << truth);
      CHECK(std::abs(m.mean - truth) <= 3.9 * m.deviation + 0.015 * scale);
      CHECK(m.deviation < 0.05 * scale);
    };
    const double e = disk_irradiance(d);
    expect("irradiance", e, e, [](const Record& r) { return r.parts[0].value.x; });
    expect("its green", 0.5 * e, e, [](const Record& r) { return r.parts[0].value.y; });
    // (n_i x n) . g = change of n . vector: g = n x vector.
    const auto v = disk_vector(d);
    const double lateral = std::hypot(disk_vector(1.5)[0], disk_vector(1.5)[2]);
    expect("rotation about the side", v[0], lateral,
           [&](const Record& r) { return -dot(r.parts[0].rotation[0], aside); });
    expect("rotation outwards", -v[2], lateral,
           [&](const Record& r) { return dot(r.parts[0].rotation[0], out); });
    const double slope = (disk_irradiance(d + 1e-3) - disk_irradiance(d - 1e-3)) / 2e-3;
    const double steepest = std::abs(disk_irradiance(1.001) - disk_irradiance(0.999)) / 2e-3;
    expect("translation outwards", slope, steepest,
           [&](const Record& r) { return dot(r.parts[0].translation[0], out); });
    expect("translation aside", 0, steepest,
           [&](const Record& r) { return dot(r.parts[0].translation[0], aside); });
    expect("translation upwards", 0, steepest, [](const Record& r) { return r.parts[0].translation[0].y; });
    // A record's error is that of the luminance of its red, green and blue.
    const Moments scatter = moments(records, i * k_repeats, k_repeats, [](const Record& r) {
      return 0.2126 * r.parts[0].value.x + 0.7152 * r.parts[0].value.y + 0.0722 * r.parts[0].value.z;
    });
    const Moments reported =
        moments(records, i * k_repeats, k_repeats, [](const Record& r) { return r.error; });
    INFO("error " << reported.mean << ", scatter " << scatter.deviation * std::sqrt(double(k_repeats)));
    CHECK(reported.mean > 0.8 * scatter.deviation * std::sqrt(double(k_repeats)));
  }
  // Directly below the disk, which subtends sin^2 = 1/5 from 2 m: rays hit the disk and nothing else.
  const Moments inverse = moments(records, 0, k_repeats, [](const Record& r) { return 1 / r.mean_distance; });
  // Mean over the cosine distribution of cos/2 within: (1 - (4/5)^1.5) / 3.
  CHECK(inverse.mean == Approx((1 - std::pow(0.8, 1.5)) / 3).epsilon(0.01));
  CHECK(records[0].least_distance == Approx(2).epsilon(0.01));
  CHECK(records[0].rays == 4096);
}

TEST_CASE("a constant environment is reproduced within rounding, without gradients") {
  scene::Scene scene = test::CacheBed::load("furnace-disk");
  for (scene::Material& m : scene.materials) m.emission = vec3(0);
  scene.environment.radiance = vec3(1, 0.5f, 2);
  scene.environment.given = true;
  test::CacheBed bed(scene);
  bed.set_frame(k_direct);
  const auto records = bed.evaluate({{vec3(0, 5, 0), vec3(0, 1, 0)}, {vec3(1000, 1, 0), vec3(0.6f, 0.8f, 0)}},
                                    {.parts = k_direct});
  for (const Record& r : records) {
    const auto& part = r.parts[0];
    CHECK(part.value.x == Approx(pi).epsilon(1e-6));
    CHECK(part.value.z == Approx(2 * pi).epsilon(1e-6));
    for (int c = 0; c < 3; ++c) {
      CHECK(length(part.rotation[c]) < 1e-5f);
      CHECK(part.translation[c] == vec3(0));
    }
    CHECK(std::isinf(r.mean_distance));
    CHECK(r.error < 1e-6f);
  }
}

TEST_CASE("a record's parts are the components of a path after one diffuse event") {
  // In a Cornell box a record's parts, times albedo over pi, equal the components of a picture of that point:
  // compared through a sum over long evaluations. Levels and batches agree with one long run.
  test::CacheBed bed(test::CacheBed::load("cornell"));
  bed.set_frame(k_beyond);
  const std::vector<Place> places(64, Place{vec3(0, 1e-4f, 0.3f), vec3(0, 1, 0)});
  const auto once = bed.evaluate(places, {.elevations = 16, .azimuths = 64, .parts = k_beyond});
  const Moments secondary = moments(once, 0, 64, [](const Record& r) { return r.parts[1].value.y; });
  const Moments tertiary = moments(once, 0, 64, [](const Record& r) { return r.parts[2].value.y; });
  CHECK(secondary.mean > 0);
  CHECK(tertiary.mean > 0);
  for (const Record& r : once) {
    CHECK(r.parts[0].value == vec3(0));  // not requested
    CHECK(r.parts[3].value == vec3(0));  // no glossy surface
  }
  // Two levels are weighted by their rays.
  irradiance_cache::Records records(bed.device, 64);
  records.append(test::CacheBed::on_facets(places));
  bed.evaluate(records, {.elevations = 8, .azimuths = 32, .parts = k_beyond});
  const auto coarse = records.read();
  bed.evaluate(records, {.elevations = 16, .azimuths = 64, .rays_before = 256, .parts = k_beyond});
  const auto both = records.read();
  CHECK(both[0].rays == 1280);
  const Moments m = moments(both, 0, 64, [](const Record& r) { return r.parts[1].value.y; });
  INFO(m.mean << " +- " << m.deviation << ", " << secondary.mean << " +- " << secondary.deviation);
  CHECK(std::abs(m.mean - secondary.mean) <= 3.9 * std::hypot(m.deviation, secondary.deviation));
  CHECK(both[0].error < coarse[0].error);
  CHECK(both[0].least_distance <= coarse[0].least_distance);
  // Batches only divide work: a record alone equals, bit for bit, the same record among many.
  irradiance_cache::Records again(bed.device, 64);
  again.append(test::CacheBed::on_facets(places));
  for (const uint32_t i : {63u, 0u, 17u}) {
    const std::vector<uint32_t> one{i};
    CHECK(bed.evaluator.evaluate(bed.wavefront, bed.automaton, again, one,
                                 {.elevations = 16, .azimuths = 64, .parts = k_beyond}) == 1);
    const Record a = again.read(i);
    CHECK(std::memcmp(&a, &once[i], sizeof a) == 0);
  }
  // Cancelled work does not change records.
  const std::vector<uint32_t> some{1, 2, 3};
  CHECK(bed.evaluator.evaluate(bed.wavefront, bed.automaton, again, some, {.parts = k_beyond},
                               [] { return true; }) == 0);
  CHECK(again.read(2).rays == 0);
  CHECK(bed.device.validation_messages() == 0);
}

TEST_CASE("records beyond the capacity are refused, not written") {
  test::CacheBed bed(test::CacheBed::load("furnace-disk"));
  irradiance_cache::Records records(bed.device, 2);
  CHECK(records.append(std::vector<Place>(5)) == 2);
  CHECK(records.size() == 2);
  CHECK(records.append(std::vector<Place>(1)) == 0);
  CHECK_THROWS_WITH(irradiance_cache::Records(bed.device, 1u << 30), Catch::Contains("this device can bind"));
  bed.set_frame(k_direct);
  const std::vector<uint32_t> one{0};
  CHECK_THROWS_WITH(bed.evaluator.evaluate(bed.wavefront, bed.automaton, records, one,
                                           {.elevations = 1024, .azimuths = 1024}),
                    Catch::Contains("the range is 1 to"));
}

}  // namespace cache_record_tests
