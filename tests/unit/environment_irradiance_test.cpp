// links: upload
// The table of the environment's irradiance against closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "shaders/shared/scene.h"
#include "upload/environment_irradiance.h"

namespace environment_irradiance_tests {

using namespace lucerna;

namespace {

constexpr double k_pi_d = 3.14159265358979323846;

glm::dvec3 direction(double u, double v) {
  const double phi = (u - 0.5) * 2 * k_pi_d, theta = v * k_pi_d;
  return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

template <class F>
std::vector<vec3> map(uint32_t width, uint32_t height, const F& radiance) {
  std::vector<vec3> texels;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      texels.push_back(vec3(radiance(direction((x + 0.5) / width, (y + 0.5) / height))));
  return texels;
}

template <class F>
void compare(const std::vector<vec4>& table, double error, const F& expected) {
  using namespace shared;
  double worst = 0;
  for (uint32_t j = 0; j < k_irradiance_height; ++j)
    for (uint32_t i = 0; i < k_irradiance_width; ++i) {
      const glm::dvec3 n = direction((i + 0.5) / k_irradiance_width, (j + 0.5) / k_irradiance_height);
      worst = std::max(worst, std::abs(double(table[size_t{j} * k_irradiance_width + i].x) - expected(n)));
    }
  CHECK(worst < error);
}

}  // namespace

TEST_CASE("irradiance of an even sky, of one that is brighter above, and of one texel") {
  for (const auto& [width, height] : {std::pair{256u, 128u}, std::pair{96u, 50u}, std::pair{1000u, 333u}}) {
    INFO(width << " by " << height);
    const auto even = map(width, height, [](const glm::dvec3&) { return 1.0; });
    compare(upload::environment_irradiance(even, width, height), 0.005 * k_pi_d,
            [](const glm::dvec3&) { return k_pi_d; });
    const auto above = map(width, height, [](const glm::dvec3& d) { return 1 + d.y; });
    compare(upload::environment_irradiance(above, width, height), 0.005 * k_pi_d,
            [](const glm::dvec3& n) { return k_pi_d + 2 * k_pi_d / 3 * n.y; });
  }
  std::vector<vec3> sun(512 * 256, vec3(0));
  sun[80 * 512 + 100] = vec3(1e5f);
  const double angle = (std::cos(80 * k_pi_d / 256) - std::cos(81 * k_pi_d / 256)) * 2 * k_pi_d / 512;
  const glm::dvec3 to_sun = direction(100.5 / 512, 80.5 / 256);
  compare(upload::environment_irradiance(sun, 512, 256), 1e-3 * 1e5 * angle,
          [&](const glm::dvec3& n) { return 1e5 * angle * std::max(0.0, dot(n, to_sun)); });
}

TEST_CASE("without an environment there is none; one texel is an even sky") {
  for (const vec4& e : upload::environment_irradiance({}, 0, 0)) CHECK(e == vec4(0));
  const std::vector<vec3> one{vec3(2)};
  compare(upload::environment_irradiance(one, 1, 1), 0.01 * k_pi_d,
          [](const glm::dvec3&) { return 2 * k_pi_d; });
}

}  // namespace environment_irradiance_tests
