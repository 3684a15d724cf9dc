#pragma once
// Conversion of colours with other primaries to Rec.709 (ITU-R BT.709-6).
#include <array>
#include <glm/glm.hpp>
#include <optional>

namespace lucerna {

/// CIE 1931 x, y of red, green, blue and white, as in EXR's "chromaticities" and Radiance's PRIMARIES.
using Chromaticities = std::array<float, 8>;

/// Matrix from linear RGB with these primaries to Rec.709. White stays white (Bradford adaptation); colours
/// outside the gamut get negative channels. Nothing if the primaries are Rec.709's within 0.001 or span no
/// gamut.
std::optional<glm::dmat3> rec709_from(const Chromaticities& primaries);

}  // namespace lucerna
