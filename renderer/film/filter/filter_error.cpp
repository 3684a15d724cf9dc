#include "film/filter/filter_error.h"

#include <algorithm>
#include <cmath>

namespace lucerna::film {

namespace {

// Half sides of the windows over which noise and bias of pixels and of tiles are averaged.
constexpr int k_noise_reach = 2, k_bias_reach = 9, k_tile_reach = 2;
// Share of the samples' own variance that a comparison with them leaves open for a tile (README.md).
constexpr double k_unseen = 0.4;
// Minimum luminance for relative differences, over the median luminance.
constexpr double k_dark = 0.05;

struct Grid {
  uint32_t width, height;
  std::vector<double> values;
};

/// Means over squares of 2 * reach + 1, clipped at the edges.
std::vector<double> box_mean(const Grid& grid, int reach) {
  const int w = int(grid.width), h = int(grid.height);
  std::vector<double> rows(grid.values.size()), out(grid.values.size());
  const auto pass = [&](const std::vector<double>& from, std::vector<double>& to, int count, int lines,
                        int step, int line_step) {
    for (int line = 0; line < lines; ++line)
      for (int i = 0; i < count; ++i) {
        const int lo = std::max(0, i - reach), hi = std::min(count - 1, i + reach);
        double sum = 0;
        for (int k = lo; k <= hi; ++k)
          sum += from[size_t(line) * size_t(line_step) + size_t(k) * size_t(step)];
        to[size_t(line) * size_t(line_step) + size_t(i) * size_t(step)] = sum / (hi - lo + 1);
      }
  };
  pass(grid.values, rows, w, h, 1, w);
  pass(rows, out, h, w, w, 1);
  return out;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Squares of the reference for relative differences: the luminance around, and a share of the picture's.
std::vector<double> scales(const Grid& luminance, int reach) {
  std::vector<double> scale = box_mean(luminance, reach);
  const double dark = k_dark * median(scale);
  for (double& s : scale) s = (s + dark) * (s + dark);
  return scale;
}

/// Luminance of the halves of an image, and of both together.
struct Halves {
  std::vector<double> even, odd, mean;
};
Halves halves_of(const Image& image) {
  const size_t n = image.samples.size();
  Halves h{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  for (size_t i = 0; i < n; ++i) {
    for (const size_t c : k_components) {
      h.mean[i] += double(luminance(image.components[c][i]));
      h.odd[i] += double(luminance(image.odd_half[c][i]));
    }
    const double count = image.samples[i], odd = image.samples[i] / 2;
    if (image.samples[i] < 2)
      h.even[i] = h.odd[i] = h.mean[i];
    else
      h.even[i] = (count * h.mean[i] - odd * h.odd[i]) / (count - odd);
  }
  return h;
}

double square(double x) { return x * x; }

/// Estimates for a mean of the filtered halves f and g, from the samples' halves a and b, each of variance
/// `variance`: noise, and noise and bias together. Both are unbiased and may be below 0.
struct Evidence {
  double noise, all;
};
Evidence evidence(double f, double g, double a, double b, double variance) {
  const double noise = square(f - g) / 4;
  return {noise, 0.5 * (square(f - b) + square(g - a)) - variance - noise};
}

/// The averaged evidence of each position as a variance: at least the noise.
std::vector<double> variances(Grid noise, Grid all, const std::vector<double>& scale, int noise_reach,
                              int all_reach) {
  for (size_t i = 0; i < scale.size(); ++i)
    if (scale[i] > 0) noise.values[i] /= scale[i], all.values[i] /= scale[i];
  std::vector<double> v = box_mean(noise, noise_reach);
  const std::vector<double> m = box_mean(all, all_reach);
  for (size_t i = 0; i < v.size(); ++i) v[i] = std::max({v[i], m[i], 0.0}) * scale[i];
  return v;
}

void estimate_pixels(FilterError& error, const Image& image, const Halves& s, const Halves& f) {
  const size_t n = image.samples.size();
  Grid noise{image.width, image.height, std::vector<double>(n)}, all = noise;
  double noise_sum = 0, all_sum = 0, unknown = 0;
  for (size_t i = 0; i < n; ++i) {
    const Evidence e = evidence(f.even[i], f.odd[i], s.even[i], s.odd[i], square(s.even[i] - s.odd[i]) / 2);
    noise.values[i] = e.noise, all.values[i] = e.all;
    noise_sum += e.noise, all_sum += e.all;
    error.luminance += f.mean[i] / double(n);
    if (image.samples[i] < 2) unknown += square(f.mean[i]);
  }
  error.rms = std::sqrt((std::max(noise_sum, all_sum) + unknown) / double(n));
  const std::vector<double> scale = scales({image.width, image.height, f.mean}, k_noise_reach);
  const std::vector<double> v = variances(noise, all, scale, k_noise_reach, k_bias_reach);
  error.luminances.assign(f.mean.begin(), f.mean.end());
  double variance = 0, noise_variance = 0;
  for (size_t i = 0; i < n; ++i)
    if (scale[i] > 0) variance += v[i] / scale[i], noise_variance += noise.values[i] / scale[i];
  if (noise_variance > 0) error.over_noise = std::max(1.0, std::sqrt(variance / noise_variance));
  error.pixels.resize(n);
  for (size_t i = 0; i < n; ++i) error.pixels[i] = float(image.samples[i] < 2 ? f.mean[i] : std::sqrt(v[i]));
}

void estimate_tiles(FilterError& error, const Image& image, const Halves& s, const Halves& f, uint32_t side,
                    double luminance_floor) {
  const uint32_t across = error.tiles_across, down = error.tiles_down;
  const size_t count = size_t{across} * down;
  error.tiles.resize(count);
  Grid noise{across, down, std::vector<double>(count)}, all = noise, mean = noise, samples = noise;
  for (uint32_t t = 0; t < count; ++t) {
    const uint32_t x0 = t % across * side, y0 = t / across * side, x1 = std::min(x0 + side, image.width),
                   y1 = std::min(y0 + side, image.height);
    double fe = 0, fo = 0, se = 0, so = 0, v = 0, squares = 0;
    for (uint32_t y = y0; y < y1; ++y)
      for (uint32_t x = x0; x < x1; ++x) {
        const size_t i = size_t{y} * image.width + x;
        fe += f.even[i], fo += f.odd[i], se += s.even[i], so += s.odd[i], mean.values[t] += f.mean[i];
        v += square(s.even[i] - s.odd[i]) / 2;
      }
    const double n = double(x1 - x0) * (y1 - y0);
    mean.values[t] /= n;
    for (uint32_t y = y0; y < y1; ++y)
      for (uint32_t x = x0; x < x1; ++x) {
        const size_t i = size_t{y} * image.width + x;
        squares += square(double{error.pixels[i]} / std::max({f.mean[i], mean.values[t], luminance_floor}));
      }
    samples.values[t] = v / (n * n) / 2;  // mean of both halves
    const Evidence e = evidence(fe / n, fo / n, se / n, so / n, v / (n * n));
    noise.values[t] = e.noise, all.values[t] = e.all;
    error.tiles[t].luminance = mean.values[t];
    error.tiles[t].relative = std::sqrt(squares / n);
  }
  const std::vector<double> scale = scales(mean, 0);
  const std::vector<double> v = variances(noise, all, scale, k_tile_reach, k_tile_reach);
  for (size_t t = 0; t < count; ++t)
    if (scale[t] > 0) samples.values[t] /= scale[t];
  const std::vector<double> unseen = box_mean(samples, 1);
  for (size_t t = 0; t < count; ++t)
    error.tiles[t].standard_error = std::sqrt(v[t] + k_unseen * unseen[t] * scale[t]);
}

}  // namespace

FilterError filter_error(const Image& samples, const Image& filtered, uint32_t side, double luminance_floor) {
  const Halves s = halves_of(samples), f = halves_of(filtered);
  FilterError error;
  error.tiles_across = (samples.width + side - 1) / side;
  error.tiles_down = (samples.height + side - 1) / side;
  estimate_pixels(error, samples, s, f);
  estimate_tiles(error, samples, s, f, side, luminance_floor);
  std::vector<double> relative;
  for (const FilteredTile& tile : error.tiles) relative.push_back(tile.relative);
  std::sort(relative.begin(), relative.end());
  error.tile_median = relative[relative.size() / 2];
  error.tile_worst_tenth = relative[relative.size() * 9 / 10];
  return error;
}

}  // namespace lucerna::film
