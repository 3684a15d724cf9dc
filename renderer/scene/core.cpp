#include "scene/core.h"

#include <algorithm>
#include <vector>

namespace lucerna::scene {

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
  const auto half = values.begin() + ptrdiff_t((count - 1) / 2);
  std::nth_element(values.begin(), half, values.end());
  // The largest that can be reached from the median without a gap.
  float last = *half;
  bool apart = false;
  for (bool grown = true; grown;) {
    float next = last, beyond = 0;
    for (const float r : reach)
      if (r <= k_apart * last)
        next = std::max(next, r);
      else if (beyond == 0 || r < beyond)
        beyond = r;
    grown = next > last;
    apart = !grown && beyond > 0;
    // From triangles without extent in the middle every other one is infinitely many times as far.
    if (apart && last == 0) next = beyond, grown = true, apart = false;
    last = next;
  }
  if (!apart) return std::nullopt;
  Box core;
  for (size_t i = 0; i < count; ++i)
    for (size_t k = 0; k < 3 && reach[i] <= last; ++k) core.grow(positions[3 * i + k]);
  return core;
}

Box core_bounds(const Scene& scene) {
  std::vector<vec3> positions;
  for (const Instance& instance : scene.instances)
    for (const Primitive& primitive : shown_parts(scene, instance))
      for (const uvec3& t : primitive.triangles)
        for (const uint32_t corner : {t.x, t.y, t.z})
          positions.push_back(vec3(instance.to_world * vec4(primitive.positions[corner], 1)));
  return core_of(positions).value_or(bounds(scene));
}

}  // namespace lucerna::scene
