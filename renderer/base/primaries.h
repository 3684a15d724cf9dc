#pragma once
// Colours of pictures whose primaries are not Rec.709's (ITU-R BT.709-6).
#include <array>
#include <glm/glm.hpp>
#include <optional>

namespace lucerna {

/// CIE 1931 x, y of red, green, blue and white, as EXR's attribute "chromaticities" and Radiance's PRIMARIES
/// have them.
using Chromaticities = std::array<float, 8>;

/// Takes linear RGB of such primaries to Rec.709: white stays white (Bradford's adaptation), what is outside
/// the gamut is negative. Nothing where they are Rec.709's within 0.001, or span no gamut.
std::optional<glm::dmat3> rec709_from(const Chromaticities& primaries);

}  // namespace lucerna
