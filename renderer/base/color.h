#pragma once
// Colours as strength and tint; decoding of sRGB.
#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace lucerna {

/// Strength: the strongest channel. Tint: the colour over its strength; white for black.
inline float strength_of(const vec3& color) { return std::max({color.x, color.y, color.z}); }
inline vec3 tint_of(const vec3& color) {
  const float strength = strength_of(color);
  return strength > 0 ? color / strength : vec3(1);
}

/// sRGB-encoded 0..1 -> linear (IEC 61966-2-1). shared::srgb_encode (shaders/shared/tone.h) is the inverse.
template <class T>
T linear_from_srgb(T x) {
  return x <= T(0.04045) ? x / T(12.92) : std::pow((x + T(0.055)) / T(1.055), T(2.4));
}

}  // namespace lucerna
