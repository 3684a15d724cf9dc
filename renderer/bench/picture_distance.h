#pragma once
// Difference of a shown picture from a reference picture, as seen.
#include <cstdint>
#include <span>
#include <vector>

#include "shaders/shared/preview.h"

namespace lucerna::bench {

/// Distance of two pictures of linear luminance as shown: 0 black, 1 white.
///
/// A pixel's error is the difference over the reference, after a mean over 3x3 pixels of both. Pixels darker
/// than k_dark are divided by k_dark. In each tile of 16x16 pixels the reference's own noise is subtracted
/// from the mean square; a tile in which the noise exceeds it counts below 0.
struct PictureDistance {
  double error = 0;        ///< mean over all pixels
  double black = 0;        ///< share of the pixels lit in the reference whose 3x3 mean shows no light
  double tile_median = 0;  ///< median of the tiles' mean errors
  double worst_tenth = 0;  ///< error that a tenth of the tiles exceed
};
inline constexpr float k_dark = shared::k_preview_dark;

/// Both pictures have equal size, row by row. `half_difference`: half of the difference of two independent
/// halves of the reference, which is their mean; empty: the reference is noise-free.
PictureDistance picture_distance(std::span<const float> shown, std::span<const float> reference,
                                 uint32_t width, std::span<const float> half_difference = {});

/// Luminance shown by a published picture with the linear tone curve.
std::vector<float> shown_luminance(std::span<const uint8_t> rgba);

}  // namespace lucerna::bench
