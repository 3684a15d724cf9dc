#pragma once
// Skies by formula, as environments: radiance by direction, and images made from it.
#include <cstdint>

#include "base/math.h"

namespace lucerna::scene {

enum class SkyKind : uint32_t {
  preetham,      ///< clear to hazy daylight by turbidity: Preetham, Shirley, Smits 1999, appendix A.2
  cie_clear,     ///< CIE standard clear sky, ISO 15469:2004 type 12
  cie_overcast,  ///< CIE standard overcast sky (Moon and Spencer 1942), ISO 15469:2004 type 16
};

/// A sky over a horizontal plane, and the ground below the horizon.
struct SkyModel {
  SkyKind kind = SkyKind::preetham;
  float turbidity = 3;   ///< of Preetham's sky: 2 (clear) to 10 (hazy)
  float ground = 0.2f;   ///< reflectance of the ground, which is lit by the sky and diffuse, 0 to 1
  vec3 to_sun{0, 1, 0};  ///< unit, towards the sun; below the horizon it is night
  bool operator==(const SkyModel&) const = default;
};

}  // namespace lucerna::scene
