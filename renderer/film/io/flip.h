#pragma once
// FLIP: how large the difference appears when two pictures are shown in alternation at the same place.
// P. Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020; for high dynamic
// range P. Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021.
#include <span>
#include <vector>

#include "base/math.h"

namespace lucerna::film {

struct FlipOptions {
  /// Pixels per degree of the visual angle; > 0. The default is a 0.7 m wide screen of 3840 pixels at 0.7 m.
  double pixels_per_degree = 67.02064327658226;
};

/// The difference of every pixel, 0 (equal) to 1. `a` and `b` are linear Rec.709 colours as displayed, of
/// equal size, a multiple of `width`; values outside 0..1 are clamped. Symmetric in a and b. Beyond their
/// edges pictures repeat their edge pixels.
std::vector<float> flip(uint32_t width, std::span<const vec3> a, std::span<const vec3> b,
                        const FlipOptions& options = {});

/// Likewise for radiance. Both pictures are displayed with several exposures, about one stop apart, by the
/// ACES curve: from that which shows the brightest pixel of `reference` at 0.85 to that which shows its
/// median so. The result is the maximum over the exposures. Not symmetric. Values must be finite; negative
/// ones count as 0.
std::vector<float> flip_hdr(uint32_t width, std::span<const vec3> picture, std::span<const vec3> reference,
                            const FlipOptions& options = {});

}  // namespace lucerna::film
