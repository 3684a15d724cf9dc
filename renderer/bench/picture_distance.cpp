#include "bench/picture_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/color.h"
#include "base/math.h"

namespace lucerna::bench {
namespace {

std::vector<float> mean_3x3(std::span<const float> of, uint32_t width) {
  const auto height = uint32_t(of.size() / width);
  std::vector<float> all(of.size());
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      float sum = 0, n = 0;
      for (uint32_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, height - 1); ++v)
        for (uint32_t u = x > 0 ? x - 1 : 0; u <= std::min(x + 1, width - 1); ++u)
          sum += of[size_t{v} * width + u], n += 1;
      all[size_t{y} * width + x] = sum / n;
    }
  return all;
}

}  // namespace

PictureDistance picture_distance(std::span<const float> shown, std::span<const float> reference,
                                 uint32_t width, std::span<const float> half_difference) {
  constexpr size_t k_tile = 16;
  struct Tile {
    double error = 0, square = 0, noise = 0, pixels = 0;
  };
  const std::vector<float> a = mean_3x3(shown, width), b = mean_3x3(reference, width),
                           half = mean_3x3(half_difference, width);
  PictureDistance d;
  size_t lit = 0, black = 0;
  const size_t across = (width + k_tile - 1) / k_tile;
  std::vector<Tile> tiles(across * ((a.size() / width + k_tile - 1) / k_tile));
  for (size_t i = 0; i < a.size(); ++i) {
    const double off = std::abs(a[i] - b[i]) / std::max(b[i], k_dark),
                 noise = half.empty() ? 0.0 : double(half[i] / std::max(b[i], k_dark));
    Tile& t = tiles[i / width / k_tile * across + i % width / k_tile];
    t.error += off, t.square += off * off, t.noise += noise * noise, t.pixels += 1;
    if (b[i] < k_dark) continue;
    ++lit;
    black += a[i] < 0.05f * b[i];
  }
  // For a correct picture the rest is below 0 as often as above, with expectation 0.
  std::vector<double> errors;
  for (const Tile& t : tiles) {
    const double left = t.square > 0 ? 1 - t.noise / t.square : 0;
    const double error = t.error * std::copysign(std::sqrt(std::abs(left)), left);
    d.error += error;
    errors.push_back(error / t.pixels);
  }
  d.error = std::max(0.0, d.error) / double(std::max<size_t>(1, a.size()));
  std::sort(errors.begin(), errors.end());
  if (!errors.empty()) {
    d.tile_median = std::max(0.0, errors[errors.size() / 2]);
    d.worst_tenth = std::max(0.0, errors[errors.size() * 9 / 10]);
  }
  d.black = double(black) / double(std::max<size_t>(1, lit));
  return d;
}

std::vector<float> shown_luminance(std::span<const uint8_t> rgba) {
  std::array<float, 256> linear;
  for (size_t i = 0; i < 256; ++i) {
    linear[i] = linear_from_srgb(float(i) / 255);
  }
  std::vector<float> all(rgba.size() / 4);
  for (size_t i = 0; i < all.size(); ++i)
    all[i] = luminance(vec3(linear[rgba[4 * i]], linear[rgba[4 * i + 1]], linear[rgba[4 * i + 2]]));
  return all;
}

}  // namespace lucerna::bench
