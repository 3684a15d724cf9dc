#pragma once
// Black bodies as linear Rec.709 colours, and back.
#include "base/math.h"

namespace lucerna {

/// Range of temperatures of lamps [K]. Below it a black body has almost no green or blue in Rec.709; above
/// it, its colour hardly changes.
inline constexpr float k_coolest_kelvin = 1000, k_hottest_kelvin = 40000;

/// Linear Rec.709 colour of a black body, its strongest channel 1; negative channels become 0. `kelvin` is
/// clamped to the range above. Planck's law over 380 to 780 nm, with the CIE 1931 colour matching functions
/// as fitted by C. Wyman, P.-P. Sloan, P. Shirley, 'Simple Analytic Approximations to the CIE XYZ Color
/// Matching Functions', JCGT 2(2), 2013, equation 4.
vec3 blackbody_color(float kelvin);

/// The temperature [K] whose ratio of blue to red is nearest; an end of the range for redder or bluer
/// colours. `off`: the largest difference of a channel, both colours scaled to a strongest channel of 1; 0
/// for a black body's colour. Black counts as white.
struct NearestKelvin {
  float kelvin, off;
};
NearestKelvin nearest_kelvin(const vec3& color);

}  // namespace lucerna
