#include "solvers/photons/trials.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math.h"

namespace lucerna::photons {
namespace {

constexpr uint32_t k_block = 8;      // pixels, along each side
constexpr double k_much_less = 0.5;  // of the first one's product
constexpr double k_samples = 2;      // a pixel, of a trial
constexpr double k_certain = 3;      // standard errors
constexpr double k_missing = 0.5;    // of the certain light

/// Result of one trial, by block of the picture; the last entry is the whole picture.
struct Noise {
  std::vector<double> variance;  ///< per pixel: variance of one sample's luminance
  std::vector<double> around;    ///< mean luminance
  /// Of a component: mean luminance, its standard error, and the variance of one sample's light that was
  /// missed (miss()).
  struct Light {
    double mean = 0, error = 0, missed = 0;
  };
  ByComponent<std::vector<Light>> light;
};

struct Blocks {
  uint32_t width, height, across, count;  ///< pixels; blocks in a row; blocks in all
  explicit Blocks(const film::Image& image)
      : width(image.width),
        height(image.height),
        across((width + k_block - 1) / k_block),
        count(across * ((height + k_block - 1) / k_block)) {}
  size_t of(size_t pixel) const { return pixel / width / k_block * across + pixel % width / k_block; }
  double pixels(size_t block) const {
    if (block == count) return double(width) * height;
    const auto side = [](uint32_t first, uint32_t all) { return std::min(k_block, all - first); };
    return double(side(uint32_t(block % across) * k_block, width)) *
           side(uint32_t(block / across) * k_block, height);
  }
};

Noise noise_of(const Trial& trial, const Blocks& blocks) {
  const film::Image& image = trial.image;
  Noise n;
  n.variance.assign(size_t{image.width} * image.height, 0);
  n.around.assign(blocks.count + 1, 0);
  for (const size_t c : k_components) {
    if ((trial.judged >> c & 1u) == 0) continue;
    n.light[c].resize(blocks.count + 1);
    std::vector<double> odds(blocks.count + 1, 0), variances(blocks.count + 1, 0);
    for (size_t i = 0; i < n.variance.size(); ++i) {
      const double mean = double(luminance(image.components[c][i])),
                   odd = double(luminance(image.odd_half[c][i]));
      // The even sample is 2 mean - odd; half the squared difference of the two samples.
      const double variance = 2 * (odd - mean) * (odd - mean);
      n.variance[i] += variance * trial.variance_factor[c];
      for (const size_t b : {blocks.of(i), size_t{blocks.count}})
        n.light[c][b].mean += mean, odds[b] += odd, variances[b] += variance;
    }
    for (size_t b = 0; b <= blocks.count; ++b) {
      Noise::Light& l = n.light[c][b];
      const double pixels = blocks.pixels(b);
      l.mean /= pixels;
      // From the pixels, and from the means of the two samples, which include common errors of pixels.
      l.error = std::max(std::sqrt(variances[b] / 2) / pixels, std::abs(odds[b] / pixels - l.mean));
      n.around[b] += l.mean;
    }
  }
  return n;
}

/// Sets Noise::Light::missed of all trials.
void miss(std::span<const Trial> trials, std::vector<Noise>& noises, const Blocks& blocks) {
  for (const size_t c : k_components)
    for (size_t b = 0; !noises[0].light[c].empty() && b <= blocks.count; ++b) {
      double certain = 0;
      for (const Noise& n : noises)
        certain = std::max(certain, n.light[c][b].mean - k_certain * n.light[c][b].error);
      for (size_t t = 0; t < trials.size(); ++t) {
        Noise::Light& l = noises[t].light[c][b];
        const double missing = certain - l.mean;
        if (missing < k_missing * certain) continue;
        const double independent = std::max(1.0, blocks.pixels(b) / trials[t].pixels_in_common);
        l.missed = k_samples * independent * missing * missing * trials[t].variance_factor[c];
      }
    }
}

/// Sum over the components.
double missed_at(const Noise& noise, size_t block) {
  double sum = 0;
  for (const auto& light : noise.light) sum += light.empty() ? 0 : light[block].missed;
  return sum;
}

}  // namespace

size_t judge(std::span<Trial> trials) {
  const Blocks blocks(trials[0].image);
  std::vector<Noise> noises;
  for (const Trial& trial : trials) noises.push_back(noise_of(trial, blocks));
  miss(trials, noises, blocks);
  // The smallest luminance around, among trials that have missed no light.
  std::vector<double> least(blocks.count + 1, std::numeric_limits<double>::max());
  for (const Noise& n : noises)
    for (size_t b = 0; b <= blocks.count; ++b)
      if (!(missed_at(n, b) > 0)) least[b] = std::min(least[b], n.around[b]);
  for (size_t b = 0; b <= blocks.count; ++b)
    if (least[b] == std::numeric_limits<double>::max()) least[b] = noises[0].around[b];
  std::vector<double> products;
  for (size_t t = 0; t < trials.size(); ++t) {
    double relative = 0;
    for (size_t i = 0; i < noises[t].variance.size(); ++i) {
      const size_t block = blocks.of(i);
      const double around = least[block], mean = least[blocks.count];
      const double square = around * around + mean * mean;
      if (square > 0) relative += (noises[t].variance[i] + missed_at(noises[t], block)) / square;
    }
    products.push_back(relative * trials[t].cost);
  }
  size_t best = 0;
  for (size_t t = 0; t < trials.size(); ++t) {
    trials[t].product = products[0] > 0 ? products[t] / products[0] : 0;
    if (products[t] > 0 && products[t] < products[best] && products[t] < k_much_less * products[0]) best = t;
  }
  return best;
}

}  // namespace lucerna::photons
