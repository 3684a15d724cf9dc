#pragma once
// Emitting surfaces.
#include <cstdint>
#include <vector>

#include "base/math.h"
#include "commands/navigation.h"
#include "commands/open_scene.h"

namespace lucerna::ui {

/// Indices of the materials that emit, or would if switched on, and that are used.
const std::vector<uint32_t>& emitters(const commands::OpenScene& open, const commands::Navigation& camera);

struct EmittingSurface {
  uint32_t material = 0;
  vec3 middle{0};  ///< of its area, in the scene
  float area = 0;  ///< [m^2]
};
/// The surfaces of these materials, for marks in the picture: the largest, at most k_most_marked.
const std::vector<EmittingSurface>& emitting_surfaces(const commands::OpenScene& open,
                                                      const commands::Navigation& camera);
inline constexpr size_t k_most_marked = 200;

}  // namespace lucerna::ui
