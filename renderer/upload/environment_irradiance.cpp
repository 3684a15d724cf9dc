#include "upload/environment_irradiance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shaders/shared/scene.h"

namespace lucerna::upload {
namespace {

constexpr double k_pi_d = 3.14159265358979323846;

/// Direction of a point of the map, u and v in 0..1.
glm::dvec3 direction(double u, double v) {
  const double phi = (u - 0.5) * 2 * k_pi_d, theta = v * k_pi_d;
  return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

/// Of a block of texels and a channel: its light's direction, as long as its radiance times solid angle.
using Vectors = std::array<glm::dvec3, 3>;

}  // namespace

std::vector<vec4> environment_irradiance(std::span<const vec3> texels, uint32_t width, uint32_t height) {
  using shared::k_irradiance_height, shared::k_irradiance_width;
  std::vector<vec4> result(size_t{k_irradiance_width} * k_irradiance_height, vec4(0));
  if (texels.empty()) return result;
  constexpr uint32_t k_across = 128, k_down = 64;
  std::vector<Vectors> blocks(size_t{k_across} * k_down,
                              Vectors{glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)});
  // A small map's texels are cut into several.
  const uint32_t columns = width * ((k_across + width - 1) / width),
                 rows = height * ((k_down + height - 1) / height);
  for (uint32_t y = 0; y < rows; ++y) {
    const double angle =
        (std::cos(y * k_pi_d / rows) - std::cos((y + 1) * k_pi_d / rows)) * 2 * k_pi_d / columns;
    for (uint32_t x = 0; x < columns; ++x) {
      const vec3& radiance = texels[size_t{y} * height / rows * width + size_t{x} * width / columns];
      const glm::dvec3 d = angle * direction((x + 0.5) / columns, (y + 0.5) / rows);
      Vectors& block = blocks[size_t{y} * k_down / rows * k_across + size_t{x} * k_across / columns];
      for (int c = 0; c < 3; ++c) block[size_t(c)] += double(radiance[c]) * d;
    }
  }
  for (uint32_t j = 0; j < k_irradiance_height; ++j)
    for (uint32_t i = 0; i < k_irradiance_width; ++i) {
      const glm::dvec3 n = direction((i + 0.5) / k_irradiance_width, (j + 0.5) / k_irradiance_height);
      glm::dvec3 sum(0);
      for (const Vectors& block : blocks)
        for (int c = 0; c < 3; ++c) sum[c] += std::max(0.0, glm::dot(n, block[size_t(c)]));
      result[size_t{j} * k_irradiance_width + i] = vec4(vec3(sum), 0);
    }
  return result;
}

}  // namespace lucerna::upload
