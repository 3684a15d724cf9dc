#include "film/error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shaders/shared/tone.h"

namespace lucerna::film {

SeenRange seen_range(double ev, uint32_t curve) {
  const float exposure = float(std::exp2(ev));
  return {k_luminance_floor / exposure, shared::tone_white(curve) / exposure};
}

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

shared::BlockLookups mixed_lookups(const shared::BlockLookups& lookups, const shared::BlockError& block) {
  shared::BlockLookups r = lookups;
  if (!(block.unmixed > 0)) return r;
  const float mixed = block.luminance[0] / block.unmixed;
  for (float& value : r.interpolation) value *= mixed;
  for (float& value : r.noise) value *= mixed;
  for (float& value : r.interpolation_noise) value *= mixed;
  return r;
}

LookupsError lookups_error(std::span<const shared::BlockLookups> blocks) {
  using shared::k_lookup_lanes;
  double pixels = 0;
  std::array<double, 2> interpolation{};
  std::array<double, 2 * k_lookup_lanes> noise{}, left{};
  for (const shared::BlockLookups& b : blocks) {
    pixels += b.pixels;
    for (size_t k = 0; k < 2; ++k) interpolation[k] += b.interpolation[k];
    for (size_t k = 0; k < noise.size(); ++k) noise[k] += b.noise[k], left[k] += b.interpolation_noise[k];
  }
  if (pixels == 0) return {};
  // Products of the two paths' sums: their mean is the square, without the paths' noise.
  double variance = 0, square = interpolation[0] * interpolation[1];
  for (size_t k = 0; k < k_lookup_lanes; ++k) {
    variance += noise[k] * noise[k_lookup_lanes + k] / k_lookup_lanes;
    square -= left[k] * left[k_lookup_lanes + k] / k_lookup_lanes;
  }
  return {std::sqrt(std::max(variance, 0.0)) / pixels, std::sqrt(std::max(square, 0.0)) / pixels,
          k_lookup_lanes};
}

double blur_error(std::span<const shared::BlockError> blocks) {
  double pixels = 0, even = 0, odd = 0;
  for (const shared::BlockError& b : blocks) pixels += b.pixels, even += b.bias[0], odd += b.bias[1];
  return pixels > 0 ? std::sqrt(std::max(even * odd, 0.0)) / pixels : 0;
}

double TileError::half_width_90() const {
  if (!(lookups.noise > 0)) return student_90(degrees) * standard_error + lookups.interpolation;
  const double by_paths = standard_error * standard_error, by_lookups = lookups.noise * lookups.noise;
  const double both = by_paths + by_lookups;
  const double free =
      both * both /
      ((by_paths > 0 ? by_paths * by_paths / degrees : 0) + by_lookups * by_lookups / lookups.degrees);
  return student_90(free) * std::sqrt(both) + lookups.interpolation;
}

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

namespace {
/// The quadratic mean over the pixels of a sum of squares, which may be below 0 by chance.
double quadratic_mean(double squares, double pixels) {
  return pixels > 0 ? std::sqrt(std::max(squares, 0.0) / pixels) : 0;
}
}  // namespace

bool without_evidence(const shared::BlockError& block) {
  return block.interpolation_relative > 0 && block.interpolation_relative < shared::k_most_without_evidence;
}

RelativeError relative_error(const Film& film, std::span<const uint32_t> blocks) {
  Quadrants quadrants;
  double pixels = 0, lookups = 0, interpolation = 0;
  bool unknown = false;
  for (const uint32_t b : blocks) {
    const shared::BlockError& e = film.errors()[b];
    quadrants.add(e);
    unknown = unknown || without_evidence(e);
    for (const float n : e.quadrant_pixels) pixels += n;
    lookups += e.lookup_noise_relative, interpolation += e.interpolation_relative;
  }
  return {unknown ? std::max(quadrants.relative(), 1.0) : quadrants.relative(),
          quadratic_mean(lookups, pixels), quadratic_mean(interpolation, pixels)};
}

TileError tile_error(std::span<const shared::BlockError> blocks,
                     std::span<const shared::BlockLookups> lookups) {
  TileError tile;
  double &variance = tile.variance, &fourth = tile.fourth;
  for (const shared::BlockError& b : blocks) {
    tile.pixels += b.pixels;
    tile.luminance += b.luminance[0];
    variance += b.variance[0];
    fourth += b.fourth;
    tile.difference += b.difference;
  }
  if (tile.pixels == 0) return tile;
  tile.luminance /= tile.pixels;
  tile.difference /= tile.pixels;
  tile.standard_error = std::sqrt(variance) / tile.pixels;
  tile.degrees = fourth > 0 ? 3 * variance * variance / fourth : tile.pixels;
  Quadrants quadrants;
  double by_lookups = 0, by_interpolation = 0;
  for (const shared::BlockError& b : blocks) {
    quadrants.add(b);
    tile.unknown = tile.unknown || without_evidence(b);
    by_lookups += b.lookup_noise_relative, by_interpolation += b.interpolation_relative;
  }
  tile.relative = tile.unknown ? std::max(quadrants.relative(), 1.0) : quadrants.relative();
  tile.lookups = lookups_error(lookups);
  tile.lookups.interpolation = std::hypot(tile.lookups.interpolation, blur_error(blocks));
  tile.relative_lookup_noise = quadratic_mean(by_lookups, tile.pixels);
  tile.relative_interpolation = quadratic_mean(by_interpolation, tile.pixels);
  return tile;
}

std::vector<TileError> tile_errors(const Film& film, uint32_t side) {
  const uint32_t step = std::max(1u, side / shared::k_block);
  std::vector<TileError> tiles;
  for (uint32_t y = 0; y < film.blocks_down(); y += step)
    for (uint32_t x = 0; x < film.blocks_across(); x += step) {
      std::vector<shared::BlockError> blocks;
      std::vector<shared::BlockLookups> lookups;
      for (uint32_t v = y; v < std::min(y + step, film.blocks_down()); ++v)
        for (uint32_t u = x; u < std::min(x + step, film.blocks_across()); ++u) {
          const uint32_t b = v * film.blocks_across() + u;
          blocks.push_back(film.errors()[b]);
          if (film.lookup_errors_complete())
            lookups.push_back(mixed_lookups(film.lookup_errors()[b], film.errors()[b]));
        }
      tiles.push_back(tile_error(blocks, lookups));
    }
  if (film.lookup_bias_known()) count_shared_noise(tiles, (film.blocks_across() + step - 1) / step);
  return tiles;
}

void count_shared_noise(std::span<TileError> tiles, uint32_t across) {
  constexpr int k_rings = 2;
  const auto shared = [](const TileError& t) {
    const double apart = t.variance / (t.pixels * t.pixels);
    return t.difference * t.difference / apart;
  };
  const int width = static_cast<int>(across), height = across ? static_cast<int>(tiles.size() / across) : 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0, squares = 0, count = 0;
      for (int v = std::max(0, y - k_rings); v <= std::min(height - 1, y + k_rings); ++v)
        for (int u = std::max(0, x - k_rings); u <= std::min(width - 1, x + k_rings); ++u) {
          const TileError& n = tiles[static_cast<size_t>(v) * across + static_cast<size_t>(u)];
          if (!(n.variance > 0)) continue;
          const double one = shared(n);
          sum += one, squares += one * one, ++count;
        }
      TileError& tile = tiles[static_cast<size_t>(y) * across + static_cast<size_t>(x)];
      if (!(tile.variance > 0) || !(sum > 0)) continue;
      const double factor = std::max(1.0, sum / count);
      tile.standard_error *= std::sqrt(factor);
      // Pixels that share their data provide fewer independent samples of the noise; and the factor itself is
      // noisy, from squares with one degree of freedom each.
      tile.degrees = std::max(1.0, 1 / (factor / tile.degrees + squares / (3 * sum * sum)));
    }
}

void mark_heavy_tails(std::span<TileError> tiles, uint32_t across, double luminance_floor) {
  constexpr double k_share = 1.0 / 8, k_small = 1.0 / 3;
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
      const double around =
          pixels > 0 ? std::sqrt(variance * tile.pixels / pixels) / std::max(tile.pixels, 1.0) : 0;
      const double by_paths =
          std::max(tile.standard_error, around * std::max(tile.luminance, luminance_floor));
      const bool matters = by_paths >= k_small * (tile.lookups.noise + tile.lookups.interpolation);
      tile.heavy_tailed =
          matters && (few(variance, fourth, pixels) || few(tile.variance, tile.fourth, tile.pixels));
    }
}

TileSpread tile_spread(std::span<const TileError> tiles, const std::function<double(const TileError&)>& of) {
  TileSpread spread;
  if (tiles.empty()) return spread;
  std::vector<double> sorted;
  sorted.reserve(tiles.size());
  for (const TileError& t : tiles) sorted.push_back(of(t)), spread.heavy_tailed += t.heavy_tailed;
  std::sort(sorted.begin(), sorted.end());
  spread.median = sorted[sorted.size() / 2];
  spread.worst_tenth = sorted[sorted.size() * 9 / 10];
  spread.worst = sorted.back();
  return spread;
}

ImageError image_error(std::span<const shared::BlockError> blocks) {
  ImageError image;
  std::array<double, 5> variance{}, seen{};
  double fourth = 0, lookups = 0, interpolation = 0;
  double seen_fourth = 0, seen_lookup_noise = 0, seen_interpolation = 0;
  for (const shared::BlockError& b : blocks) {
    image.pixels += b.pixels, fourth += b.fourth;
    lookups += b.lookup_noise, interpolation += b.interpolation;
    seen_lookup_noise += b.lookup_noise_relative, seen_interpolation += b.interpolation_relative;
    image.white += b.white, image.dark += b.dark, seen_fourth += b.seen_fourth;
    if (without_evidence(b)) image.unknown += b.pixels;
    for (int k = 0; k < 5; ++k)
      image.luminance[k] += b.luminance[k], variance[k] += b.variance[k], seen[k] += b.seen[k];
  }
  if (image.pixels == 0) return image;
  for (int k = 0; k < 5; ++k) {
    image.luminance[k] /= image.pixels;
    image.rms[k] = std::sqrt(variance[k] / image.pixels);
    image.seen_rms[k] = std::sqrt(seen[k] / image.pixels);
  }
  image.unknown /= image.pixels, image.white /= image.pixels, image.dark /= image.pixels;
  image.seen_lookup_noise = quadratic_mean(seen_lookup_noise, image.pixels);
  image.seen_interpolation = quadratic_mean(seen_interpolation, image.pixels);
  image.seen_degrees = seen_fourth > 0 ? 3 * seen[0] * seen[0] / seen_fourth : image.pixels;
  image.lookup_noise_rms = quadratic_mean(lookups, image.pixels);
  image.interpolation_rms = quadratic_mean(interpolation, image.pixels);
  image.degrees = fourth > 0 ? 3 * variance[0] * variance[0] / fourth : image.pixels;
  return image;
}

std::array<LayerError, shared::k_error_layers> layer_errors(std::span<const shared::BlockError> blocks) {
  const ImageError all = image_error(blocks);
  std::array<LayerError, shared::k_error_layers> layers;
  for (size_t l = 0; l < layers.size(); ++l)
    layers[l] = {all.luminance[1 + l], all.rms[1 + l], all.seen_rms[1 + l]};
  return layers;
}

double ImageError::share(int component) const {
  const double all = std::inner_product(seen_rms.begin() + 1, seen_rms.end(), seen_rms.begin() + 1, 0.0);
  const double own = seen_rms[size_t(component) + 1];
  return all > 0 ? own * own / all : 0;
}

}  // namespace lucerna::film
