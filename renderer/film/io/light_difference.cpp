#include "film/io/light_difference.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "film/io/compare.h"
#include "film/io/planes.h"
#include "film/io/relative_mse.h"
#include "shaders/shared/tone.h"

namespace lucerna::film {
namespace {

FilmImage as_image(uint32_t width, std::span<const vec3> light) {
  FilmImage image{.width = width, .height = uint32_t(light.size() / width)};
  add_plane(image, "", "RGB", light);
  return image;
}

}  // namespace

LightDifference light_difference(uint32_t width, std::span<const vec3> picture, std::span<const vec3> other) {
  assert(width > 0 && picture.size() == other.size() && !picture.empty());
  const Comparison compared = compare(as_image(width, picture), as_image(width, other));
  const std::vector<vec3> truth(other.begin(), other.end());
  const SeenMse seen = seen_mse(picture, {.width = width, .first = truth, .second = truth});
  return {.relative_squared = compared.relmse,
          .as_seen = std::sqrt(std::max(0.0, seen.all)),
          .flip = compared.flip.value_or(0)};
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
