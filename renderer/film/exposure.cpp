#include "film/exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lucerna::film {
namespace {

float rounded(double ev) { return static_cast<float>(std::round(10 * std::clamp(ev, -20.0, 20.0)) / 10); }

/// Mean of the finite pixels of a rectangle.
vec3 mean(std::span<const vec3> radiance, uint32_t width, uint32_t x0, uint32_t y0, uint32_t x1,
          uint32_t y1) {
  glm::dvec3 sum(0);
  double count = 0;
  for (uint32_t y = y0; y < y1; ++y)
    for (uint32_t x = x0; x < x1; ++x) {
      const vec3& c = radiance[size_t{y} * width + x];
      if (!std::isfinite(c.x + c.y + c.z)) continue;
      sum += glm::dvec3(c), ++count;
    }
  return count > 0 ? vec3(sum / count) : vec3(0);
}

}  // namespace

Brightness measure_picture(std::span<const vec3> radiance, uint32_t width, uint32_t height) {
  Brightness found;
  if (width == 0 || height == 0 || radiance.size() < size_t{width} * height) return found;
  const uint32_t side = std::max(1u, (height + 31) / 32);
  std::vector<float> blocks;
  for (uint32_t y = 0; y < height; y += side)
    for (uint32_t x = 0; x < width; x += side)
      blocks.push_back(
          luminance(mean(radiance, width, x, y, std::min(x + side, width), std::min(y + side, height))));
  found.color = mean(radiance, width, 0, 0, width, height);
  std::sort(blocks.begin(), blocks.end());
  const float bright = blocks[blocks.size() - 1 - blocks.size() / 20];
  const float brightest = blocks.back();
  // For a small light in the dark, the light itself is used.
  const float reference = bright > 1e-6f * brightest ? bright : brightest;
  if (!(reference > 0)) return found;
  double sum = 0, count = 0;
  for (const float b : blocks)
    if (b > 1e-3f * reference) sum += std::log2(static_cast<double>(b)), ++count;
  const double grey = std::log2(static_cast<double>(k_middle_grey)) - sum / count;
  const double fifth = std::max(blocks[blocks.size() - 1 - blocks.size() / 5], 1e-6f * reference);
  const double white = 1 - std::log2(fifth);
  found.ev = rounded(std::min(grey, white));
  return found;
}

Brightness measure_point(std::span<const vec3> radiance, uint32_t width, uint32_t height, const vec2& at) {
  Brightness found;
  if (width == 0 || height == 0 || radiance.size() < size_t{width} * height) return found;
  const auto place = [](float share, uint32_t size) {
    return std::min(static_cast<uint32_t>(std::clamp(share, 0.0f, 1.0f) * static_cast<float>(size)),
                    size - 1);
  };
  const uint32_t x = place(at.x, width), y = place(at.y, height), reach = height / 80;
  found.color = mean(radiance, width, x - std::min(x, reach), y - std::min(y, reach),
                     std::min(x + reach + 1, width), std::min(y + reach + 1, height));
  if (const float l = luminance(found.color); l > 0)
    found.ev = static_cast<float>(std::clamp(std::log2(double{k_middle_grey} / double{l}), -20.0, 20.0));
  return found;
}

}  // namespace lucerna::film
