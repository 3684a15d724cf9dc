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

namespace {
struct Quadrants {
  double squares = 0, count = 0;
  void add(const shared::BlockError& b) {
    for (uint32_t q = 0; q < 4; ++q) {
      if (b.quadrant_pixels[q] == 0) continue;
      const double mean = double{b.relative[q]} / b.quadrant_pixels[q];
      squares += mean * mean;
      ++count;
    }
  }
  double relative() const { return count > 0 ? std::sqrt(squares / count) : 0; }
};
}  // namespace

double relative_error(const Film& film, std::span<const uint32_t> blocks) {
  Quadrants quadrants;
  for (const uint32_t b : blocks) quadrants.add(film.errors()[b]);
  return quadrants.relative();
}

TileError tile_error(std::span<const shared::BlockError> blocks) {
  TileError tile;
  double &variance = tile.variance, &fourth = tile.fourth;
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
  Quadrants quadrants;
  for (const shared::BlockError& b : blocks) quadrants.add(b);
  tile.relative = quadrants.relative();
  return tile;
}

std::vector<TileError> tile_errors(const Film& film, uint32_t side) {
  const uint32_t step = std::max(1u, side / shared::k_block);
  std::vector<TileError> tiles;
  for (uint32_t y = 0; y < film.blocks_down(); y += step)
    for (uint32_t x = 0; x < film.blocks_across(); x += step) {
      std::vector<shared::BlockError> blocks;
      for (uint32_t v = y; v < std::min(y + step, film.blocks_down()); ++v)
        for (uint32_t u = x; u < std::min(x + step, film.blocks_across()); ++u)
          blocks.push_back(film.errors()[v * film.blocks_across() + u]);
      tiles.push_back(tile_error(blocks));
    }
  return tiles;
}

void mark_heavy_tails(std::span<TileError> tiles, uint32_t across, double luminance_floor) {
  constexpr double k_share = 1.0 / 8;
  const auto few = [](double variance, double fourth, double pixels) {
    return fourth > 0 && 3 * variance * variance < k_share * pixels * fourth;
  };
  const int width = static_cast<int>(across), height = across ? static_cast<int>(tiles.size() / across) : 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double variance = 0, fourth = 0, pixels = 0;
      for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
          const TileError& n = tiles[static_cast<size_t>(v) * across + static_cast<size_t>(u)];
          const double scale = std::max(n.luminance, luminance_floor);
          variance += n.variance / (scale * scale);
          fourth += n.fourth / (scale * scale * scale * scale);
          pixels += n.pixels;
        }
      TileError& tile = tiles[static_cast<size_t>(y) * across + static_cast<size_t>(x)];
      tile.heavy_tailed = few(variance, fourth, pixels) || few(tile.variance, tile.fourth, tile.pixels);
    }
}

TileSpread tile_spread(std::span<const TileError> tiles) {
  TileSpread spread;
  if (tiles.empty()) return spread;
  std::vector<double> sorted;
  sorted.reserve(tiles.size());
  for (const TileError& t : tiles) sorted.push_back(t.relative), spread.heavy_tailed += t.heavy_tailed;
  std::sort(sorted.begin(), sorted.end());
  spread.median = sorted[sorted.size() / 2];
  spread.worst_tenth = sorted[sorted.size() * 9 / 10];
  spread.worst = sorted.back();
  return spread;
}

ImageError image_error(std::span<const shared::BlockError> blocks) {
  ImageError image;
  std::array<double, 5> variance{};
  double fourth = 0;
  for (const shared::BlockError& b : blocks) {
    image.pixels += b.pixels, fourth += b.fourth;
    for (int k = 0; k < 5; ++k) image.luminance[k] += b.luminance[k], variance[k] += b.variance[k];
  }
  if (image.pixels == 0) return image;
  for (int k = 0; k < 5; ++k) {
    image.luminance[k] /= image.pixels;
    image.rms[k] = std::sqrt(variance[k] / image.pixels);
  }
  image.degrees = fourth > 0 ? 3 * variance[0] * variance[0] / fourth : image.pixels;
  return image;
}

}  // namespace lucerna::film
