#include "solvers/irradiance_cache/noise.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace lucerna::irradiance_cache {

float dark_luminance(std::span<const float> light, uint32_t count) {
  // Crowded records have no light.
  double sum = 0;
  uint32_t lit = 0;
  for (const float l : light.first(count)) sum += double(l), lit += l > 0;
  return lit > 0 ? 0.1f * float(sum / lit) : 1.0f;
}

std::vector<uint32_t> too_noisy(std::span<const Noise> list, float darkest, size_t most) {
  struct Found {
    double excess;
    uint32_t index;
  };
  std::vector<Found> found;
  for (size_t i = 0; i < list.size(); ++i) {
    double squares = 0, light = 0;
    size_t others = 0;
    const size_t end = std::min(list.size(), i + k_around + 1);
    for (size_t k = i > k_around ? i - k_around : 0; k < end; ++k) {
      if (k == i && list.size() > 1) continue;
      squares += double(list[k].error) * double(list[k].error), light += double(list[k].light), ++others;
    }
    const double error = std::sqrt(squares / double(others));
    const double accepted = double(list[i].bound) * std::max(light / double(others), double(darkest));
    if (error > accepted) found.push_back({error / accepted, uint32_t(i)});
  }
  if (found.size() > most) {
    std::ranges::stable_sort(found, std::ranges::greater{}, &Found::excess);
    found.resize(most);
    std::ranges::sort(found, {}, &Found::index);
  }
  std::vector<uint32_t> indices;
  for (const Found& f : found) indices.push_back(f.index);
  return indices;
}

}  // namespace lucerna::irradiance_cache
