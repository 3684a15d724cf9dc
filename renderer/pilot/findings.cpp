#include "pilot/findings.h"

#include <algorithm>
#include <vector>

#include "base/math.h"

namespace lucerna::pilot {
namespace {

constexpr uint32_t k_block = 8;    // pixels, along each side
constexpr double k_floor = 0.05;   // of the median block
constexpr double k_least = 1e-12;  // luminance of darkness

}  // namespace

solvers::Findings evaluate(const film::Image& image, uint32_t samples) {
  const uint32_t across = (image.width + k_block - 1) / k_block,
                 down = (image.height + k_block - 1) / k_block;
  std::vector<double> light(size_t{across} * down, 0), pixels(light.size(), 0);
  const auto block_of = [&](size_t i) {
    return i / image.width / k_block * across + i % image.width / k_block;
  };
  const size_t count = size_t{image.width} * image.height;
  std::array<double, film::k_components> energy{};
  for (size_t i = 0; i < count; ++i) {
    pixels[block_of(i)] += 1;
    for (size_t c = 0; c < energy.size(); ++c) {
      const double mean = double(luminance(image.components[c][i]));
      light[block_of(i)] += mean, energy[c] += mean;
    }
  }
  for (size_t b = 0; b < light.size(); ++b) light[b] /= std::max(pixels[b], 1.0);
  std::vector<double> sorted = light;
  std::nth_element(sorted.begin(), sorted.begin() + long(sorted.size() / 2), sorted.end());
  const double floor = std::max(k_floor * sorted[sorted.size() / 2], k_least);

  solvers::Findings findings;
  double all = 0;
  for (const double e : energy) all += e;
  for (size_t c = 0; c < energy.size(); ++c) {
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
      // The half's deviation from the mean of both has the variance of that mean.
      const double deviation =
          double(luminance(image.odd_half[c][i])) - double(luminance(image.components[c][i]));
      const double scale = light[block_of(i)] + floor;
      sum += std::min(samples * deviation * deviation / (scale * scale), k_most_variance);
    }
    findings.components[c] = {all > 0 ? energy[c] / all : 0, sum / double(std::max<size_t>(count, 1))};
  }
  return findings;
}

}  // namespace lucerna::pilot
