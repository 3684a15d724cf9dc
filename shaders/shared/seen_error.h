// The error of a pixel as seen: its only definition, read by C++ and GLSL.
//
// Light is perceived relative to the light around it; display black and display white have no visible noise.
// All quantities are luminances (Rec.709) of the film, with the present exposure and tone curve:
// - Y: the pixel's mean. A, B: means of its two halves, independent of each other. L = min(A, B).
// - shown(y) = min(y, white), with white = tone_white(curve) / exposure.
// - D = shown(Y) - shown(L): difference of the shown pixel from its darker half. Below white it is
//   |A - B| / 2, whose square is an unbiased estimate of the variance of Y.
// - local: mean of shown(Y) over those of the 5x5 pixels around that are in the picture and have two
//   samples.
// - scale = max(local, shown(Y) / k_seen_most, floor), with floor = k_luminance_floor / exposure.
// - e = D / scale, 0 .. k_seen_most, without unit: the error as seen. 0.1 is a tenth of the light around.
//
// The bound keeps a single firefly from outweighing its picture. Components use the same scale.
// With d_c = (A_c - B_c) / 2 of component c, the sum of d_c over the components is (A - B) / 2, and
// e_c = |d_c| / scale times the part of the sum's deviation that is seen, D / (|A - B| / 2). A component that
// is off has e_c = 0. The expected squares of independent components' errors add up to e^2.
//
// The error of a picture is the root of the mean of e^2 over its pixels, and a component's share of it is its
// sum of e_c^2 over that of all components. The error that stops a tile is a mean of min(e, 1)
// (BlockError::relative), which few pixels cannot dominate.
#ifndef LUCERNA_SHARED_SEEN_ERROR_H
#define LUCERNA_SHARED_SEEN_ERROR_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN
#ifdef __cplusplus
using glm::max;
using glm::min;
#endif

/// Minimum display radiance (after exposure) in relative errors: 5 % of it is about one step of an 8-bit sRGB picture, so
/// black corners do not take the samples of a render.
LUCERNA_CONST float k_luminance_floor = 0.02f;

/// Maximum error of a pixel.
LUCERNA_CONST float k_seen_most = 4.0f;

/// Radius of `local` [pixels].
LUCERNA_CONST uint k_seen_reach = 2u;

LUCERNA_INLINE float seen_shown(float luminance, float white) { return min(luminance, white); }

/// D over |A - B| / 2, 0 .. 1. `mean` is Y, `low` is L <= Y.
LUCERNA_INLINE float seen_part(float mean, float low, float white) {
  if (mean <= white) return 1.0f;
  return low < white ? (white - low) / (mean - low) : 0.0f;
}

/// `shown`: of the pixel; `floor` > 0.
LUCERNA_INLINE float seen_scale(float shown, float local, float luminance_floor) {
  return max(max(local, shown / k_seen_most), luminance_floor);
}

LUCERNA_SHARED_END
#endif
