// links: irradiance_cache scene_io bvh_embree
// A record under an environment of which one half emits: irradiance and rotational gradient have a closed
// form for any normal, and do not depend on the position.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/cache.h"

namespace cache_half_lit_tests {

using namespace lucerna;
using irradiance_cache::Place;
using irradiance_cache::Record;

namespace {

/// Checks the mean of a figure over records, within 3.9 standard errors (1e-4, two-sided) plus `slack` for
/// the blur of the environment's texels.
template <class Value>
void expect(const char* what, const std::vector<Record>& records, size_t first, size_t count, double truth,
            double slack, const Value& value) {
  const test::Moments m = test::moments(records, first, count, value);
  INFO(what << ": " << m.mean << " +- " << m.deviation << ", expected " << truth);
  CHECK(std::abs(m.mean - truth) <= 3.9 * m.deviation + slack);
}

}  // namespace

TEST_CASE("half an environment: irradiance and its rotational gradient match the closed form") {
  scene::Scene scene = test::CacheBed::load("furnace-disk");
  for (scene::Material& m : scene.materials) m.emission = vec3(0);
  scene::Image sky;
  sky.name = "half", sky.width = 64, sky.height = 32;
  for (uint32_t row = 0; row < sky.height; ++row)
    for (uint32_t column = 0; column < sky.width; ++column) {  // its middle is +x
      const float l = column >= sky.width / 4 && column < 3 * sky.width / 4 ? 2.0f : 0.0f;
      sky.floats.insert(sky.floats.end(), {l, 0.5f * l, 0, 1});
    }
  scene.images.push_back(sky);
  scene.environment.image = static_cast<scene::Id>(scene.images.size() - 1);
  scene.environment.given = true;
  test::CacheBed bed(scene);
  constexpr uint32_t k_direct = 1;
  bed.set_frame(k_direct);

  // Above the disk at 2 m: only the environment is visible above these planes.
  constexpr size_t k_repeats = 64;
  const std::vector<vec3> normals{
      {0, 1, 0}, normalize(vec3(0.2f, 1, 0.1f)), normalize(vec3(-0.15f, 1, -0.2f))};
  std::vector<Place> places;
  for (const vec3& n : normals)
    for (size_t i = 0; i < k_repeats; ++i) places.push_back({vec3(0, 500, 0), n});
  const auto records = bed.evaluate(places, {.elevations = 16, .azimuths = 64, .parts = k_direct});
  // E(n) = pi L (1 + n.x) / 2 for radiance L where x > 0; (n_i x n) . g is its change, so g = n x (pi L/2) x.
  const double half = 3.14159265358979 * 2 / 2;
  for (size_t k = 0; k < normals.size(); ++k) {
    const vec3 n = normals[k];
    INFO("normal " << n.x << ", " << n.y << ", " << n.z);
    const vec3 g = cross(n, vec3(float(half), 0, 0));
    const double slack = 0.005 * half;
    const auto one = [&](const char* what, double truth, const auto& value) {
      expect(what, records, k * k_repeats, k_repeats, truth, slack, value);
    };
    one("irradiance", half * (1 + double(n.x)), [](const Record& r) { return double(r.parts[0].value.x); });
    one("its green", half / 2 * (1 + double(n.x)),
        [](const Record& r) { return double(r.parts[0].value.y); });
    one("its blue", 0, [](const Record& r) { return double(r.parts[0].value.z); });
    for (int axis = 0; axis < 3; ++axis)
      one("rotation", double(g[axis]), [&](const Record& r) { return double(r.parts[0].rotation[0][axis]); });
    // The environment is at infinity.
    for (size_t i = k * k_repeats; i < (k + 1) * k_repeats; ++i) {
      CHECK(records[i].parts[0].translation[0] == vec3(0));
      CHECK(std::isinf(records[i].mean_distance));
    }
  }
  CHECK(bed.device.validation_messages() == 0);
}

}  // namespace cache_half_lit_tests
