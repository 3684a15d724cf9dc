#include "base/blackbody.h"

#include <algorithm>
#include <cmath>

#include "base/color.h"

namespace lucerna {
namespace {

struct Lobe {
  double height, mean, below, above;  // nm
  double at(double nm) const {
    const double t = (nm - mean) / (nm < mean ? below : above);
    return height * std::exp(-0.5 * t * t);
  }
};

constexpr Lobe k_x[] = {{1.056, 599.8, 37.9, 31.0}, {0.362, 442.0, 16.0, 26.7}, {-0.065, 501.1, 20.4, 26.2}};
constexpr Lobe k_y[] = {{0.821, 568.8, 46.9, 40.5}, {0.286, 530.9, 16.3, 31.1}};
constexpr Lobe k_z[] = {{1.217, 437.0, 11.8, 36.0}, {0.681, 459.0, 26.0, 13.8}};

template <size_t N>
double sum(const Lobe (&lobes)[N], double nm) {
  double all = 0;
  for (const Lobe& lobe : lobes) all += lobe.at(nm);
  return all;
}

}  // namespace

vec3 blackbody_color(float kelvin) {
  const double t = std::clamp(kelvin, k_coolest_kelvin, k_hottest_kelvin);
  double x = 0, y = 0, z = 0;
  for (double nm = 380; nm <= 780; nm += 5) {
    // Planck's law without its constant factor: (nm / 560)^-5 / (exp(c2 / (lambda T)) - 1).
    const double power = std::pow(nm / 560, -5) / std::expm1(1.438776877e7 / (nm * t));
    x += power * sum(k_x, nm), y += power * sum(k_y, nm), z += power * sum(k_z, nm);
  }
  const vec3 rgb(3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
                 -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                 0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
  return tint_of(glm::max(rgb, vec3(0)));
}

NearestKelvin nearest_kelvin(const vec3& color) {
  const vec3 wanted = tint_of(color);
  // Blue over red grows with the temperature; compared crosswise, for either may be 0.
  float lo = k_coolest_kelvin, hi = k_hottest_kelvin;
  for (int i = 0; i < 40; ++i) {
    const float middle = std::sqrt(lo * hi);
    const vec3 c = blackbody_color(middle);
    (c.z * wanted.x < wanted.z * c.x ? lo : hi) = middle;
  }
  const float kelvin = std::sqrt(lo * hi);
  const vec3 d = glm::abs(blackbody_color(kelvin) - wanted);
  return {kelvin, std::max({d.x, d.y, d.z})};
}

}  // namespace lucerna
