#include "scene/sky_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace lucerna::scene {
namespace {

using glm::dvec3;
constexpr double k_pi_d = std::numbers::pi;

/// Perez et al. 1993: F(theta, gamma) by the cosine of theta, at least a little above the horizon.
struct Perez {
  double a, b, c, d, e;
  double operator()(double cos_theta, double gamma) const {
    const double cos_gamma = std::cos(gamma);
    return (1 + a * std::exp(b / std::max(cos_theta, 1e-4))) *
           (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
  }
};

/// Coefficients by turbidity: Preetham et al. 1999, appendix A.2.
Perez luminance_coefficients(double t) {
  return {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
          -0.0670 * t + 0.3703};
}
Perez x_coefficients(double t) {
  return {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
          -0.0033 * t + 0.0452};
}
Perez y_coefficients(double t) {
  return {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
          -0.0109 * t + 0.0529};
}

/// Luminance of the zenith [kcd/m^2], the sun at `theta` from it.
double zenith_luminance(double t, double theta) {
  const double chi = (4.0 / 9 - t / 120) * (k_pi_d - 2 * theta);
  return std::max(0.0, (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192);
}

using Cubic = std::array<double, 4>;  // of theta, from its cube down
double zenith_chromaticity(double t, double theta, const std::array<Cubic, 3>& m) {
  const auto row = [theta](const Cubic& c) { return ((c[0] * theta + c[1]) * theta + c[2]) * theta + c[3]; };
  return t * t * row(m[0]) + t * row(m[1]) + row(m[2]);
}
double zenith_x(double t, double theta) {
  return zenith_chromaticity(
      t, theta,
      {Cubic{0.00166, -0.00375, 0.00209, 0}, Cubic{-0.02903, 0.06377, -0.03202, 0.00394},
       Cubic{0.11693, -0.21196, 0.06052, 0.25886}});
}
double zenith_y(double t, double theta) {
  return zenith_chromaticity(
      t, theta,
      {Cubic{0.00275, -0.00610, 0.00317, 0}, Cubic{-0.04214, 0.08970, -0.04153, 0.00516},
       Cubic{0.15346, -0.26756, 0.06670, 0.26688}});
}

/// CIE xyY to linear Rec.709 (IEC 61966-2-1), without negative channels.
vec3 rec709(double x, double y, double luminance) {
  const double to_xyz = luminance / y, xx = x * to_xyz, zz = (1 - x - y) * to_xyz;
  const dvec3 rgb(3.2404542 * xx - 1.5371385 * luminance - 0.4985314 * zz,
                  -0.9692660 * xx + 1.8760108 * luminance + 0.0415560 * zz,
                  0.0556434 * xx - 0.2040259 * luminance + 1.0572252 * zz);
  return vec3(glm::max(rgb, dvec3(0)));
}

double angle_between(const dvec3& a, const dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

vec3 preetham(const SkyModel& model, const dvec3& direction, const dvec3& to_sun) {
  const double t{model.turbidity}, theta = angle_between(to_sun, dvec3(0, 1, 0));
  const double gamma = angle_between(direction, to_sun);
  const auto value = [&](const Perez& f, double zenith) {
    return zenith * f(direction.y, gamma) / f(1, theta);
  };
  return rec709(value(x_coefficients(t), zenith_x(t, theta)), value(y_coefficients(t), zenith_y(t, theta)),
                std::max(0.0, value(luminance_coefficients(t), zenith_luminance(t, theta))));
}

/// Luminance relative to the zenith.
double cie_relative(SkyKind kind, const dvec3& direction, const dvec3& to_sun) {
  if (kind == SkyKind::cie_overcast) return (1 + 2 * direction.y) / 3;
  // Type 12: the gradation of ISO 15469, equation 2, and its indicatrix, equation 3.
  const auto gradation = [](double cosine) { return 1 - std::exp(-0.32 / std::max(cosine, 1e-4)); };
  const auto indicatrix = [](double chi) {
    const double c = std::cos(chi);
    return 1 + 10 * (std::exp(-3 * chi) - std::exp(-3 * k_pi_d / 2)) + 0.45 * c * c;
  };
  return indicatrix(angle_between(direction, to_sun)) * gradation(direction.y) /
         (indicatrix(angle_between(dvec3(0, 1, 0), to_sun)) * gradation(1));
}

/// Integral of f(direction) * cosine over the upper hemisphere: midpoints in the cosine's square and the
/// azimuth.
template <class F>
auto over_horizontal(F f) {
  constexpr int k_rings = 64, k_steps = 128;
  decltype(f(dvec3())) sum(0);
  for (int i = 0; i < k_rings; ++i)
    for (int j = 0; j < k_steps; ++j) {
      const double y = std::sqrt((i + 0.5) / k_rings), r = std::sqrt(1 - y * y);
      const double azimuth = 2 * k_pi_d * (j + 0.5) / k_steps;
      sum += f(dvec3(r * std::cos(azimuth), y, r * std::sin(azimuth)));
    }
  return sum * decltype(sum)(k_pi_d / (k_rings * k_steps));
}

}  // namespace

void check_range(const SkyModel& sky, const std::string& where) {
  if (!(sky.turbidity >= k_least_turbidity && sky.turbidity <= k_most_turbidity))
    throw_error(where, "the turbidity is {}, expected {} to {}", sky.turbidity, k_least_turbidity,
                k_most_turbidity);
  if (!(sky.ground >= 0 && sky.ground <= 1))
    throw_error(where, "the reflectance of the ground is {}, expected 0 to 1", sky.ground);
  const float length = glm::length(sky.to_sun);
  if (!(length > 0 && std::isfinite(length)))
    throw_error(where, "the direction of the sun is not finite or 0");
}

Sky::Sky(const SkyModel& model) : model_(model), to_sun_(glm::normalize(dvec3(model.to_sun))) {
  // The formulas end at the horizon.
  night_ = to_sun_.y < 0;
  if (night_) return;
  if (model_.kind != SkyKind::preetham) {
    const double elevation = to_sun_.y;  // its sine
    const double wanted =
        model_.kind == SkyKind::cie_clear ? 800 + 15500 * std::sqrt(elevation) : 300 + 21000 * elevation;
    scale_ = wanted / over_horizontal([&](const dvec3& d) { return cie_relative(model_.kind, d, to_sun_); });
  }
  ground_ = model_.ground / k_pi * horizontal_irradiance();
}

vec3 Sky::above(const dvec3& direction) const {
  if (model_.kind == SkyKind::preetham) return 1000.0f * preetham(model_, direction, to_sun_);
  return vec3(float(scale_ * cie_relative(model_.kind, direction, to_sun_)));
}

vec3 Sky::radiance(const vec3& direction) const {
  if (night_) return vec3(0);
  return direction.y < 0 ? ground_ : above(glm::normalize(dvec3(direction)));
}

vec3 Sky::horizontal_irradiance() const {
  if (night_) return vec3(0);
  return vec3(over_horizontal([&](const dvec3& d) { return dvec3(above(d)); }));
}

Image sky_image(const SkyModel& model) {
  const Sky sky(model);
  Image image;
  image.name = "sky";
  image.width = k_sky_width, image.height = k_sky_width / 2;
  image.floats.reserve(size_t{image.width} * image.height * 4);
  for (uint32_t row = 0; row < image.height; ++row)
    for (uint32_t column = 0; column < image.width; ++column) {
      const float polar = k_pi * (float(row) + 0.5f) / float(image.height);
      const float azimuth = 2 * k_pi * ((float(column) + 0.5f) / float(image.width) - 0.5f);
      const vec3 l = sky.radiance(
          {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)});
      image.floats.insert(image.floats.end(), {l.x, l.y, l.z, 1});
    }
  return image;
}

}  // namespace lucerna::scene
