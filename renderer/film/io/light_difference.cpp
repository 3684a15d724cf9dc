#include "film/io/light_difference.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/color.h"
#include "film/io/compare.h"
#include "film/io/flip.h"
#include "film/io/relative_mse.h"
#include "shaders/shared/tone.h"

namespace lucerna::film {
namespace {

constexpr double k_epsilon = CompareOptions{}.epsilon;

/// Mean over pixels and channels of (a - b)^2 / (b^2 + epsilon), as Comparison::relmse.
double relative_squared(std::span<const vec3> a, std::span<const vec3> b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double d = double{a[i][k]} - double{b[i][k]};
      sum += d * d / (double{b[i][k]} * double{b[i][k]} + k_epsilon);
    }
  return sum / (3 * double(a.size()));
}

/// Scales what is brighter than white down to it.
std::vector<vec3> up_to_white(std::span<const vec3> light, float white) {
  std::vector<vec3> shown(light.begin(), light.end());
  for (vec3& c : shown)
    if (const float y = luminance(c); y > white) c *= white / y;
  return shown;
}

double mean_flip(uint32_t width, std::span<const vec3> a, std::span<const vec3> b) {
  const std::vector<float> flips = flip(width, a, b);
  return std::accumulate(flips.begin(), flips.end(), 0.0) / double(flips.size());
}

}  // namespace

std::vector<vec3> shown_light(const ViewTransform& view, std::span<const vec3> radiance) {
  std::vector<vec3> colors = shown_colors(view, radiance);
  for (vec3& c : colors)
    for (int k = 0; k < 3; ++k) c[k] = linear_from_srgb(c[k]);
  return colors;
}

LightDifference light_difference(uint32_t width, std::span<const vec3> picture, std::span<const vec3> other,
                                 const ViewTransform& view) {
  assert(width > 0 && picture.size() == other.size() && !picture.empty());
  const float white = shown_white(view);
  const std::vector<vec3> truth = up_to_white(other, white);
  const SeenMse seen =
      seen_mse(up_to_white(picture, white), {.width = width, .first = truth, .second = truth});
  return {.relative_squared = relative_squared(picture, other),
          .as_seen = std::sqrt(std::max(0.0, seen.all)),
          .flip = mean_flip(width, shown_light(view, picture), shown_light(view, other))};
}

LightDifference display_difference(uint32_t width, std::span<const vec3> picture, std::span<const vec3> other,
                                   const ViewTransform& view) {
  assert(width > 0 && picture.size() == other.size() && !picture.empty());
  constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();
  return {k_unknown, k_unknown, mean_flip(width, shown_light(view, picture), other)};
}

vec3 difference_color(float t) {
  constexpr float k_light = 0.97f, k_dark = 0.52f, k_chroma = 0.16f;
  constexpr float k_blue = 4.45f, k_orange = 0.93f;  // hues, radians
  const float x = t > 0 ? std::min(t, 1.0f) : t < 0 ? std::max(t, -1.0f) : 0.0f, size = std::abs(x);
  const float lightness = k_light + (k_dark - k_light) * size, hue = x < 0 ? k_blue : k_orange;
  const float a = k_chroma * size * std::cos(hue), b = k_chroma * size * std::sin(hue);
  vec3 lms(lightness + 0.3963377774f * a + 0.2158037573f * b,
           lightness - 0.1055613458f * a - 0.0638541728f * b,
           lightness - 0.0894841775f * a - 1.2914855480f * b);
  lms = lms * lms * lms;
  const vec3 linear(dot(lms, vec3(4.0767416621f, -3.3077115913f, 0.2309699292f)),
                    dot(lms, vec3(-1.2684380046f, 2.6097574011f, -0.3413193965f)),
                    dot(lms, vec3(-0.0041960863f, -0.7034186147f, 1.7076147010f)));
  return shared::srgb_encode(clamp(linear, vec3(0), vec3(1)));
}

std::vector<uint8_t> difference_colors(std::span<const vec3> picture, std::span<const vec3> other,
                                       float gain) {
  assert(picture.size() == other.size());
  constexpr int k_steps = 255;  // on either side of 0
  static const std::array<std::array<uint8_t, 4>, 2 * k_steps + 1> k_colors = [] {
    std::array<std::array<uint8_t, 4>, 2 * k_steps + 1> colors{};
    for (int i = -k_steps; i <= k_steps; ++i) {
      const vec3 c = difference_color(float(i) / k_steps) * 255.0f + 0.5f;
      colors[size_t(i + k_steps)] = {uint8_t(c.x), uint8_t(c.y), uint8_t(c.z), 255};
    }
    return colors;
  }();
  std::vector<uint8_t> rgba(picture.size() * 4);
  for (size_t i = 0; i < picture.size(); ++i) {
    const float d = gain * (luminance(picture[i]) - luminance(other[i]));
    const float t = std::isnan(d) ? 0.0f : std::clamp(d, -1.0f, 1.0f);
    const auto& color = k_colors[size_t(int(std::lround(t * k_steps)) + k_steps)];
    std::copy(color.begin(), color.end(), rgba.begin() + ptrdiff_t(4 * i));
  }
  return rgba;
}

}  // namespace lucerna::film
