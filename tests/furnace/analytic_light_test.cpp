// links: session
// Direct light of a disk and of a sphere on a Lambertian floor compared with the closed forms (furnace-disk
// and furnace-sphere: orthographic, 8 m x 8 m around the axis, seen along the floor's normal).
#include <catch2/catch.hpp>
#include <cmath>

#include "support/render.h"

namespace analytic_light_tests {

using namespace lucerna;

namespace {

template <class Expected>
void check_floor(const std::string& scene, const Expected& radiance) {
  const uint32_t size = 64;
  const test::Result r = test::render({.scene = scene, .width = size, .height = size, .samples = 64});
  // Rings of equal distance: their mean compared with the mean of the closed form over the same pixels.
  double seen[8] = {}, expected[8] = {}, squares[8] = {};
  for (uint32_t y = 0; y < size; ++y)
    for (uint32_t x = 0; x < size; ++x) {
      const size_t i = size_t(y) * size + x;
      // The light itself is excluded: only pixels whose feature is the floor count.
      if (std::abs(r.image.albedo[i].x - 0.5f) > 1e-3f) continue;
      const double u = (x + 0.5) / size * 8 - 4, v = (y + 0.5) / size * 8 - 4, d = std::sqrt(u * u + v * v);
      const int ring = std::min(7, int(d / 0.5));
      const double value = r.image.components[0][i].x, odd = r.image.odd_half[0][i].x;
      double mean = 0;
      for (int k = 0; k < 64; ++k) {
        const double pu = u + (k % 8 - 3.5) / 8 * (8.0 / size), pv = v + (k / 8 - 3.5) / 8 * (8.0 / size);
        mean += radiance(std::sqrt(pu * pu + pv * pv)) / 64;
      }
      seen[ring] += value, expected[ring] += mean, squares[ring] += (odd - value) * (odd - value);
    }
  for (int ring = 0; ring < 8; ++ring) {
    if (expected[ring] == 0) continue;
    INFO(scene << ": ring " << ring << " seen " << seen[ring] << " expected " << expected[ring]);
    CHECK(std::abs(seen[ring] - expected[ring]) < 0.002 * expected[ring] + 4 * std::sqrt(squares[ring]));
  }
}

}  // namespace

TEST_CASE("a disk light") {
  check_floor("furnace-disk", [](double d) {
    const double h = 2, r = 1, s = h * h + d * d + r * r;
    return 10 * 0.5 / 2 * (1 - (h * h + d * d - r * r) / std::sqrt(s * s - 4 * d * d * r * r));
  });
}

TEST_CASE("a sphere light") {
  check_floor("furnace-sphere", [](double d) {
    const double h = 2.5, r = 1;
    return 10 * 0.5 * r * r * h / std::pow(h * h + d * d, 1.5);
  });
}

}  // namespace analytic_light_tests
