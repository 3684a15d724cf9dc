#include "pilot/local_light.h"

#include <algorithm>

#include "base/math.h"

namespace lucerna::pilot {
namespace {

constexpr double k_floor = 0.05;   // of the median block
constexpr double k_least = 1e-12;  // luminance of darkness

}  // namespace

LocalLight::LocalLight(const film::Image& image)
    : width_(image.width), across_((image.width + k_block - 1) / k_block) {
  const uint32_t down = (image.height + k_block - 1) / k_block;
  light_.assign(size_t{across_} * down, 0);
  pixels_.assign(light_.size(), 0);
  const size_t count = size_t{image.width} * image.height;
  for (size_t i = 0; i < count; ++i) {
    pixels_[block_of(i)] += 1;
    for (const auto& component : image.components) light_[block_of(i)] += double(luminance(component[i]));
  }
  for (size_t b = 0; b < light_.size(); ++b) light_[b] /= std::max(pixels_[b], 1.0);
  std::vector<double> sorted = light_;
  const auto middle = sorted.begin() + long(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  floor_ = std::max(middle == sorted.end() ? 0 : k_floor * *middle, k_least);
}

}  // namespace lucerna::pilot
