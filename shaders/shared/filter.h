// Parameters of the filter's kernels (shaders/film/filter/). Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_FILTER_H
#define LUCERNA_SHARED_FILTER_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

struct FilterPush {
  uint width, height;
  uint component;  ///< 0..3
  uint stride;     ///< pixels from one of the window to the next
  uint first;      ///< pixel of the first invocation, where a kernel runs in pieces
  uint looked_up;  ///< bit i: component i looks up records, whose errors are known
  uint seen;       ///< not 0: the surfaces seen in mirrors and through glass are known
  float scale;     ///< factor that scales radiance to the range of 16-bit floats
};

/// Minimum surface colour by which light is divided before filtering.
LUCERNA_CONST float k_filter_least_albedo = 0.04f;
/// Half side [pixels] of the window in which the other half confirms a bright pixel, and the maximum factor by which a half may
/// exceed the maximum of the other there.
LUCERNA_CONST int k_filter_near = 2;
LUCERNA_CONST float k_filter_confirmed = 1.5f;
/// Differences of light, in standard deviations, that count as 1.
LUCERNA_CONST float k_filter_strength = 0.8f;
LUCERNA_CONST float k_filter_strength_direct = 0.7f;  ///< likewise, of primary light
/// Relative differences that count as 0, whatever the noise.
LUCERNA_CONST float k_filter_equal = 0.002f;
/// Regularization of slopes, over the sum of the weights.
LUCERNA_CONST float k_filter_ridge = 0.01f;
LUCERNA_CONST float k_filter_ridge_smooth = 0.03f;  ///< likewise, of secondary and tertiary light
LUCERNA_CONST float k_filter_ridge_albedo = 0.0003f;  ///< likewise, of the slope with the surface's colour
/// Weight of a pixel whose surface is almost similar: used where none is more similar.
LUCERNA_CONST float k_filter_unlike = 0.03f;
/// Of secondary and tertiary light: minimum factor on k_filter_unlike; square of the ratio of light to noise at which a pixel's
/// own weight is half way between that of its most similar neighbour and 1; and its minimum weight.
LUCERNA_CONST float k_filter_least_alike = 0.2f;
LUCERNA_CONST float k_filter_certain = 100.0f;
LUCERNA_CONST float k_filter_least_own = 1e-4f;
/// Standard deviations by which the other half must contradict a fit before its share is reduced.
LUCERNA_CONST float k_filter_doubt = 3.5f;
/// Half side [pixels] of the window over which a fit is judged, and the falloff of its weights.
LUCERNA_CONST int k_filter_judged_reach = 6;
LUCERNA_CONST float k_filter_judged_falloff = 0.025f;
/// Inverse of the maximum evidence of a pixel.
LUCERNA_CONST float k_filter_judged_most = 4.0f;
/// Minimum probability at which both halves being bright in a pixel, or near it, counts as chance, and the standard deviations
/// above the mean of less bright pixels around it that the pixel then keeps.
LUCERNA_CONST float k_filter_chance = 0.1f;
LUCERNA_CONST float k_filter_usual = 4.0f;
/// Part of a pixel's brightness from which others count as bright there, and the number of pixels around that are bright in one
/// half only at which a single one that is bright in both counts as chance.
LUCERNA_CONST float k_filter_alike_bright = 0.5f;
LUCERNA_CONST float k_filter_lone = 1.0f;
/// Maximum number of pixels around that are expected to be bright in one half and near such a one of the other by chance, at which
/// a pixel is limited by the less bright ones; where there are more, their mean is smooth. Likewise, of caustics.
LUCERNA_CONST float k_filter_rare = 8.0f;
LUCERNA_CONST float k_filter_rare_caustic = 0.5f;
/// Maximum relative difference, due to rounding, of a chosen value that equals the samples.
LUCERNA_CONST float k_filter_same = 0.004f;
/// Light, over the colour of the surface and in the filter's scale, above which samples stay unfiltered.
LUCERNA_CONST float k_filter_largest = 50000.0f;
/// Side of the blocks [pixels] in which the light that taming removes is summed, and the maximum factor on light by what is
/// restored of it.
LUCERNA_CONST uint k_filter_block = 16u;
LUCERNA_CONST float k_filter_most_restored = 1.0f;

LUCERNA_SHARED_END
#endif
