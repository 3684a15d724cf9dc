#include "pilot/findings.h"

#include <algorithm>

#include "base/math.h"
#include "pilot/local_light.h"

namespace lucerna::pilot {

solvers::Findings evaluate(const film::Image& image, uint32_t samples) {
  const LocalLight local(image);
  const size_t count = size_t{image.width} * image.height;
  solvers::Findings findings;
  ByComponent<double> energy{};
  double all = 0;
  for (size_t c = 0; c < energy.size(); ++c) {
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
      const double mean = double(luminance(image.components[c][i]));
      energy[c] += mean;
      // The half's deviation from the mean of both has the variance of that mean.
      const double deviation = double(luminance(image.odd_half[c][i])) - mean;
      const double scale = local.scale(local.block_of(i));
      sum += std::min(samples * deviation * deviation / (scale * scale), k_most_variance);
    }
    all += energy[c];
    findings.components[c].variance = sum / double(std::max<size_t>(count, 1));
  }
  for (size_t c = 0; c < energy.size(); ++c) findings.components[c].energy = all > 0 ? energy[c] / all : 0;
  return findings;
}

}  // namespace lucerna::pilot
