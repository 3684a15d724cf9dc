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
  uint looked_up;  ///< bit i: component i looks records up, whose errors are known
  uint seen;       ///< not 0: it is known what the pixels show in mirrors and through glass
  float scale;     ///< radiance is multiplied by this, so that 16-bit floats hold it
};

/// Light is divided by the colour of its surface to be filtered, and by no less than this.
LUCERNA_CONST float k_filter_least_albedo = 0.04f;
/// By how much a half may be brighter than all that the other one has met around it.
LUCERNA_CONST float k_filter_confirmed = 1.5f;
/// Distances of light, over their standard deviation, that count as one.
LUCERNA_CONST float k_filter_strength = 0.8f;
/// Relative distances that count as none, whatever the noise.
LUCERNA_CONST float k_filter_equal = 0.002f;
/// What keeps slopes small that little speaks for, over the weights' sum.
LUCERNA_CONST float k_filter_ridge = 0.01f;
LUCERNA_CONST float k_filter_ridge_albedo = 0.0003f;  ///< the same of the slope with the surface's colour
/// Least weight of a pixel whose surface is nearly alike: counts where none is more so.
LUCERNA_CONST float k_filter_unlike = 0.03f;
/// Standard deviations by which the other half must speak against a fit before less than all of it is taken.
LUCERNA_CONST float k_filter_doubt = 3.5f;
/// Half side [pixels] of the window over which a fit is judged, and how its weights fall off.
LUCERNA_CONST int k_filter_judged_reach = 6;
LUCERNA_CONST float k_filter_judged_falloff = 0.025f;
/// A pixel's evidence is bounded by the inverse of this.
LUCERNA_CONST float k_filter_judged_most = 4.0f;
/// Probability from which on it is chance that both halves are bright in a pixel, and the standard deviations above the mean
/// around it that it then keeps.
LUCERNA_CONST float k_filter_chance = 0.1f;
LUCERNA_CONST float k_filter_usual = 4.0f;
/// Relative difference up to which what was chosen is the samples, but for rounding.
LUCERNA_CONST float k_filter_same = 0.004f;
/// Light, over the colour of the surface and in the filter's scale, beyond which samples stay as they are.
LUCERNA_CONST float k_filter_largest = 50000.0f;
/// Side of the blocks [pixels] in which it is summed what taming takes, and by how much light may become more by what of it is
/// given back.
LUCERNA_CONST uint k_filter_block = 16u;
LUCERNA_CONST float k_filter_most_restored = 2.0f;

LUCERNA_SHARED_END
#endif
