#include "pilot/difference.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math.h"
#include "film/film.h"
#include "pilot/findings.h"
#include "pilot/local_light.h"

namespace lucerna::pilot {
namespace {

/// Luminance of a pixel, of the sum of components: the mean, and that of the odd samples.
struct Pixel {
  double mean = 0, odd = 0;
};
Pixel pixel_of(const film::Image& image, size_t i) {
  Pixel p;
  for (const size_t c : k_components)
    p.mean += double(luminance(image.components[c][i])), p.odd += double(luminance(image.odd_half[c][i]));
  return p;
}

}  // namespace

Difference difference(const film::Image& with, const film::Image& without, uint32_t samples) {
  const LocalLight local(with);
  const size_t count = size_t{with.width} * with.height;
  double light = 0, change = 0, noise_with = 0, noise_without = 0;
  std::vector<double> odd(local.blocks(), 0), even(local.blocks(), 0);
  for (size_t i = 0; i < count; ++i) {
    const Pixel a = pixel_of(with, i), b = pixel_of(without, i);
    const size_t block = local.block_of(i);
    light += a.mean, change += a.mean - b.mean;
    odd[block] += a.odd - b.odd;
    even[block] += 2 * (a.mean - b.mean) - (a.odd - b.odd);
    const auto variance = [&](const Pixel& p) {
      const double deviation = (p.odd - p.mean) / local.scale(block);
      return std::min(samples * deviation * deviation, k_most_variance);
    };
    noise_with += variance(a), noise_without += variance(b);
  }
  // The halves' noise is independent: the product of their changes has the squared change as its mean.
  double squared = 0, pixels = 0;
  for (size_t b = 0; b < local.blocks(); ++b) {
    const double n = local.pixels(b), scale = n * local.scale(b);
    squared += n * odd[b] * even[b] / (scale * scale), pixels += n;
  }
  return {.light = light > 0 ? change / light : 0,
          .seen = pixels > 0 ? std::sqrt(std::max(squared / pixels, 0.0)) : 0,
          .noise = noise_with > 0 ? 1 - noise_without / noise_with : 0};
}

}  // namespace lucerna::pilot
