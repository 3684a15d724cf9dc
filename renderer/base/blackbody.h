#pragma once
// The colour of what glows: black bodies as linear Rec.709, and back.
#include "base/math.h"

namespace lucerna {

/// Temperatures that lamps are given in [K]. Below, a black body has no green or blue in Rec.709 worth
/// telling; above, its colour hardly changes.
inline constexpr float k_coolest_kelvin = 1000, k_hottest_kelvin = 40000;

/// Linear Rec.709 of a black body at that temperature [K], its strongest channel 1, what lies outside the
/// gamut cut off at 0. Planck's law over 380 to 780 nm, with the CIE 1931 colour matching functions as fitted
/// by C. Wyman, P.-P. Sloan, P. Shirley, 'Simple Analytic Approximations to the CIE XYZ Color Matching
/// Functions', JCGT 2(2), 2013, equation 4. Temperatures beyond the range above are held to it.
vec3 blackbody_color(float kelvin);

/// The temperature [K] whose colour is nearest, by the ratio of its blue to its red; the ends of the range
/// for what is redder or bluer. `off`: the greatest difference of a channel when both have a strongest
/// channel of 1; 0 for a black body's own colour. A black colour counts as white.
struct NearestKelvin {
  float kelvin, off;
};
NearestKelvin nearest_kelvin(const vec3& color);

}  // namespace lucerna
