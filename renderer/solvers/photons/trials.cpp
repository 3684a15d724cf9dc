#include "solvers/photons/trials.h"

#include <algorithm>

#include "base/math.h"

namespace lucerna::photons {
namespace {

constexpr uint32_t k_block = 8;      // pixels, along each side
constexpr double k_much_less = 0.5;  // of the first one's product

struct Noise {
  std::vector<double> variance;  ///< a pixel each: of one sample's luminance
  std::vector<double> around;    ///< a block each: mean luminance
  double mean = 0;
};

Noise noise_of(const Trial& trial) {
  const film::Image& image = trial.image;
  const uint32_t across = (image.width + k_block - 1) / k_block,
                 down = (image.height + k_block - 1) / k_block;
  Noise n;
  n.variance.assign(size_t{image.width} * image.height, 0);
  n.around.assign(size_t{across} * down, 0);
  std::vector<double> pixels(n.around.size(), 0);
  for (uint32_t y = 0; y < image.height; ++y)
    for (uint32_t x = 0; x < image.width; ++x) {
      const size_t i = size_t{y} * image.width + x, block = size_t{y / k_block} * across + x / k_block;
      ++pixels[block];
      for (size_t c = 0; c < film::k_components; ++c) {
        if ((trial.judged >> c & 1u) == 0) continue;
        const double mean = double(luminance(image.components[c][i])),
                     odd = double(luminance(image.odd_half[c][i]));
        // The even sample is 2 mean - odd; half the square of the two samples' difference.
        n.variance[i] += 2 * (odd - mean) * (odd - mean) * trial.variance_factor[c];
        n.around[block] += mean;
        n.mean += mean;
      }
    }
  for (size_t b = 0; b < pixels.size(); ++b) n.around[b] /= pixels[b];
  n.mean /= double(n.variance.size());
  return n;
}

}  // namespace

size_t judge(std::span<Trial> trials) {
  std::vector<Noise> noises;
  for (const Trial& trial : trials) noises.push_back(noise_of(trial));
  Noise least = noises[0];
  for (const Noise& n : noises) {
    for (size_t b = 0; b < n.around.size(); ++b) least.around[b] = std::min(least.around[b], n.around[b]);
    least.mean = std::min(least.mean, n.mean);
  }
  const uint32_t width = trials[0].image.width, across = (width + k_block - 1) / k_block;
  std::vector<double> products;
  for (size_t t = 0; t < trials.size(); ++t) {
    double relative = 0;
    for (size_t i = 0; i < noises[t].variance.size(); ++i) {
      const auto x = uint32_t(i % width), y = uint32_t(i / width);
      const double around = least.around[size_t{y / k_block} * across + x / k_block];
      const double square = around * around + least.mean * least.mean;
      if (square > 0) relative += noises[t].variance[i] / square;
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
