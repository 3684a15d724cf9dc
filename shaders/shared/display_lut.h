// A display transform as a table of k_display_lut_size^3 colours, over the logarithm of exposed linear radiance.
// Compiled by C++, which makes it, and by GLSL, which reads it (lib/display.glsl).
#ifndef LUCERNA_SHARED_DISPLAY_LUT_H
#define LUCERNA_SHARED_DISPLAY_LUT_H
#include "shaders/shared/tone.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_display_lut_size = 65u;  ///< nodes along a side; red varies fastest
// The axis: from 11 stops below to 9 above middle grey, 3.2 nodes a stop. What is brighter looks like the last node.
LUCERNA_CONST float k_display_lut_low = -13.473931f, k_display_lut_high = 6.526069f;  ///< log2 of the ends

/// Exposed radiance -> place among the nodes, 0 to k_display_lut_size - 1. The first node is black.
LUCERNA_TONE_FUNCTION float display_lut_place(float radiance) {
  float stops = log2(max(tone_finite(radiance), 1e-20f));
  float place = (stops - k_display_lut_low) / (k_display_lut_high - k_display_lut_low) * float(k_display_lut_size - 1u);
  return clamp(place, 0.0f, float(k_display_lut_size - 1u));
}
/// The radiance of a node.
LUCERNA_TONE_FUNCTION float display_lut_radiance(uint node) {
  if (node == 0u) return 0.0f;
  float stops = k_display_lut_low + (k_display_lut_high - k_display_lut_low) * float(node) / float(k_display_lut_size - 1u);
  return pow(2.0f, stops);
}

LUCERNA_SHARED_END
#endif
