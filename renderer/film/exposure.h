#pragma once
// Brightness of a picture and a suitable exposure: pure functions.
#include <optional>
#include <span>

#include "base/math.h"

namespace lucerna::film {

/// Display radiance of a grey card.
inline constexpr float k_middle_grey = 0.18f;

/// Result of a brightness measurement.
struct Brightness {
  vec3 color{0};            ///< mean radiance
  std::optional<float> ev;  ///< suitable exposure; none if black
};

/// Measures a whole picture. Uses means over blocks of about 1/32 of its height, so that the noise of a
/// single sample a pixel does not matter. `ev` puts their log-average at middle grey, with three exceptions:
/// blocks below 1/1000 of the brightest twentieth are ignored (the background of an object is often black),
/// the brightest fifth of the blocks is at most one stop above white (windows may be, a wall in the sun may
/// not), and it is within +-20, like the setting. Rounded to 1/10. `radiance`: row by row.
Brightness measure_picture(std::span<const vec3> radiance, uint32_t width, uint32_t height);

/// Measures at a point (0..1 to the right and down), over a square of 1/40 of the height: `ev` shows its
/// luminance as middle grey.
Brightness measure_point(std::span<const vec3> radiance, uint32_t width, uint32_t height, const vec2& at);

}  // namespace lucerna::film
