#include "film/error.h"

#include <algorithm>
#include <cmath>

namespace lucerna::film {

double student_90(double degrees) {
  // Cornish-Fisher expansion about the normal quantile z (Abramowitz and Stegun 26.7.5); it converges badly
  // below 3, where interpolating the exact values in 1/degrees does better.
  const double z = 1.6448536269514722, n = std::max(degrees, 1.0);
  if (n < 4) {
    constexpr double k_exact[] = {6.313752, 2.919986, 2.353363, 2.131847};  // 1, 2, 3, 4
    const auto i = static_cast<int>(n);
    const double s = (1.0 / i - 1 / n) / (1.0 / i - 1.0 / (i + 1));
    return k_exact[i - 1] + s * (k_exact[i] - k_exact[i - 1]);
  }
  const double z2 = z * z, g1 = z * (z2 + 1) / 4, g2 = z * ((5 * z2 + 16) * z2 + 3) / 96;
  const double g3 = z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384;
  return z + (g1 + (g2 + g3 / n) / n) / n;
}

double TileError::half_width_90() const { return student_90(degrees) * standard_error; }

TileError tile_error(std::span<const shared::BlockError> blocks) {
  TileError tile;
  double variance = 0, fourth = 0;
  for (const shared::BlockError& b : blocks) {
    tile.pixels += b.pixels;
    tile.luminance += b.luminance[0];
    variance += b.variance[0];
    fourth += b.fourth;
  }
  if (tile.pixels == 0) return tile;
  tile.luminance /= tile.pixels;
  tile.standard_error = std::sqrt(variance) / tile.pixels;
  tile.degrees = fourth > 0 ? 3 * variance * variance / fourth : tile.pixels;
  tile.heavy_tailed = fourth > 0 && tile.degrees < tile.pixels / 8;
  double squares = 0, quadrants = 0;
  for (const shared::BlockError& b : blocks)
    for (uint32_t q = 0; q < 4; ++q) {
      if (b.quadrant_pixels[q] == 0) continue;
      const double mean = double{b.relative[q]} / b.quadrant_pixels[q];
      squares += mean * mean;
      ++quadrants;
    }
  tile.relative = std::sqrt(squares / quadrants);
  return tile;
}

ImageError image_error(std::span<const shared::BlockError> blocks) {
  ImageError image;
  std::array<double, 5> variance{};
  for (const shared::BlockError& b : blocks) {
    image.pixels += b.pixels;
    for (int k = 0; k < 5; ++k) image.luminance[k] += b.luminance[k], variance[k] += b.variance[k];
  }
  if (image.pixels == 0) return image;
  for (int k = 0; k < 5; ++k) {
    image.luminance[k] /= image.pixels;
    image.rms[k] = std::sqrt(variance[k] / image.pixels);
  }
  return image;
}

}  // namespace lucerna::film
