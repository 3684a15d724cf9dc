#pragma once
// Measured distributions of lamps: intensity by direction, on an even grid.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/math.h"

namespace lucerna::scene {

/// A distribution of intensity around a lamp that shines down its -Z. Between grid points it is bilinear in
/// the two angles.
struct LightProfile {
  std::string name;   ///< of its file, without folders
  std::string text;   ///< the LM-63 file that it is read from (scene/io/light_profile_file.h)
  uint32_t rows = 0;  ///< polar angles from -Z, 0 to 180 degrees, evenly spaced
  /// Angles around -Z, from +X towards +Y, evenly spaced over 360 degrees; 1: the same all around.
  uint32_t columns = 0;
  std::vector<float> intensity;  ///< rows * columns, a row after the other, over the peak: 0 to 1
  double peak = 0;               ///< largest intensity [cd]
  double solid_angle = 0;        ///< flux over the peak [sr]
  std::vector<vec4> alias;       ///< table for choosing a cell by its integral (base/alias_table.h)
  double lumens() const { return peak * solid_angle; }
  /// Relative intensity in a direction, unit, in the lamp's frame.
  float along(const vec3& direction) const;
  /// Integrals of the cells between grid points over the peak [sr], a row after the other: (rows - 1) *
  /// columns of them, the last column to the first.
  std::vector<double> cells() const;
};

inline constexpr uint32_t k_profile_rows = 361, k_profile_columns = 360;

/// Samples candela(polar, around), angles in degrees, on the grid; `even`: it is the same all around. Fills
/// everything but the texts. A distribution without light has peak 0.
LightProfile sampled_profile(const std::function<double(double polar, double around)>& candela, bool even);

}  // namespace lucerna::scene
