#include "upload/core.h"

#include <algorithm>
#include <vector>

namespace lucerna::upload {

std::optional<Box> core_of(std::span<const vec3> positions) {
  constexpr float k_apart = 16;
  const size_t count = positions.size() / 3;
  if (count < 2) return std::nullopt;
  vec3 middle(0);
  std::vector<float> values(count);
  for (int axis = 0; axis < 3; ++axis) {
    for (size_t i = 0; i < count; ++i)
      values[i] = (positions[3 * i][axis] + positions[3 * i + 1][axis] + positions[3 * i + 2][axis]) / 3;
    std::nth_element(values.begin(), values.begin() + ptrdiff_t(count / 2), values.end());
    middle[axis] = values[count / 2];
  }
  std::vector<float> reach(count);
  for (size_t i = 0; i < count; ++i)
    reach[i] = std::max({glm::distance(positions[3 * i], middle), glm::distance(positions[3 * i + 1], middle),
                         glm::distance(positions[3 * i + 2], middle)});
  values = reach;
  std::sort(values.begin(), values.end());
  const auto apart = std::adjacent_find(values.begin() + ptrdiff_t((count - 1) / 2), values.end(),
                                        [](float a, float b) { return a > 0 && b > k_apart * a; });
  if (apart == values.end()) return std::nullopt;
  Box core;
  for (size_t i = 0; i < count; ++i)
    for (size_t k = 0; k < 3 && reach[i] <= *apart; ++k) core.grow(positions[3 * i + k]);
  return core;
}

}  // namespace lucerna::upload
