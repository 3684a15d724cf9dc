#pragma once
// Surfaces that are lights: in many interiors the only ones.
#include <cstdint>
#include <vector>

#include "base/math.h"

namespace lucerna::ui {

struct Ui;

/// Indices of the materials that emit, or would if they were not switched off, and of which something is
/// made.
const std::vector<uint32_t>& emitters(const Ui& ui);

struct EmittingSurface {
  uint32_t material = 0;
  vec3 middle{0};  ///< of its area, in the scene
  float area = 0;  ///< [m^2]
};
/// What is made of those materials, for marks in the picture: the largest, k_most_marked at most.
const std::vector<EmittingSurface>& emitting_surfaces(const Ui& ui);
inline constexpr size_t k_most_marked = 200;

}  // namespace lucerna::ui
