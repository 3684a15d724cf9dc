#pragma once
// Difference of two pictures as light: figures for comparing renders, and a picture of its sign and size.
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "film/io/view_transform.h"

namespace lucerna::film {

/// Figures of a picture against another one, which counts as the truth. They contain the noise of both.
struct LightDifference {
  double relative_squared = 0;  ///< Comparison::relmse
  /// Root of SeenMse::all: relative to the light around each pixel; 0.05 is 5 %. Light beyond what the view
  /// shows as white counts as white.
  double as_seen = 0;
  double flip = 0;  ///< mean of flip() of the pictures as shown, 0..1
};

/// `picture` and `other`: linear Rec.709 radiance, rows from the top, of equal size, a multiple of `width`,
/// not empty, all finite. `view`: how they are shown.
LightDifference light_difference(uint32_t width, std::span<const vec3> picture, std::span<const vec3> other,
                                 const ViewTransform& view = {});

/// Likewise against display colours, decoded by the sRGB curve, 0..1. Only flip is known; the others are NaN.
LightDifference display_difference(uint32_t width, std::span<const vec3> picture, std::span<const vec3> other,
                                   const ViewTransform& view);

/// The colours of radiance on the display, decoded by the sRGB curve, 0..1.
std::vector<vec3> shown_light(const ViewTransform& view, std::span<const vec3> radiance);

/// The colour of a signed difference: blue at -1, white at 0, orange at 1; clamped, NaN counts as 0.
/// sRGB-encoded, 0..1. Steps are even in OKLab (B. Ottosson, 2020), and lightness falls to both ends, so that
/// the size is readable without hues.
vec3 difference_color(float t);

/// Differences in luminance, picture - other, times `gain`, as difference_color(): RGBA bytes, alpha 255.
/// Sizes as above.
std::vector<uint8_t> difference_colors(std::span<const vec3> picture, std::span<const vec3> other,
                                       float gain);

}  // namespace lucerna::film
