#include "base/primaries.h"

#include <cmath>

namespace lucerna {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr Chromaticities k_rec709{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

/// The XYZ of a chromaticity at Y = 1.
dvec3 xyz(const Chromaticities& c, size_t i) {
  const double x{c[2 * i]}, y{c[2 * i + 1]};
  return dvec3(x / y, 1, (1 - x - y) / y);
}

/// RGB of the primaries to XYZ, adapted to Rec.709's white.
dmat3 adapted_xyz(const Chromaticities& c) {
  const dmat3 primaries(xyz(c, 0), xyz(c, 1), xyz(c, 2));
  const dvec3 white = xyz(c, 3), strengths = glm::inverse(primaries) * white;
  const dmat3 to_xyz(primaries[0] * strengths.x, primaries[1] * strengths.y, primaries[2] * strengths.z);
  // Columns of Bradford's cone responses.
  const dmat3 cones(dvec3(0.8951, -0.7502, 0.0389), dvec3(0.2664, 1.7135, -0.0685),
                    dvec3(-0.1614, 0.0367, 1.0296));
  const dvec3 gain = (cones * xyz(k_rec709, 3)) / (cones * white);
  return glm::inverse(cones) * dmat3(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z) * cones * to_xyz;
}

}  // namespace

std::optional<dmat3> rec709_from(const Chromaticities& primaries) {
  bool same = true;
  for (size_t i = 0; i < primaries.size(); ++i) same = same && std::abs(primaries[i] - k_rec709[i]) < 0.001f;
  if (same) return std::nullopt;
  const dmat3 m = glm::inverse(adapted_xyz(k_rec709)) * adapted_xyz(primaries);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!std::isfinite(m[c][r]) || std::abs(m[c][r]) > 100) return std::nullopt;
  return m;
}

}  // namespace lucerna
