#pragma once
// Images of skies by formula.
#include "scene/scene.h"

namespace lucerna::scene {

inline constexpr float k_least_turbidity = 2, k_most_turbidity = 10;

/// Throws Error that names the field: turbidity from k_least_turbidity to k_most_turbidity, ground from 0 to
/// 1, to_sun finite and not 0; `where`: location for the message.
void check_range(const SkyModel& sky, const std::string& where = "sky");

/// Radiance towards a unit direction, linear Rec.709 in cd/m^2 (its luminance); without the sun's disk.
/// Directions below the horizon show the ground. Black at night, when the sun is below the horizon.
/// - preetham: A. J. Preetham, P. Shirley, B. Smits, 'A Practical Analytic Model for Daylight', SIGGRAPH
///   1999, appendix A.2: luminance and chromaticity by Perez' formula. Fitted for a sun above the horizon.
/// - cie_clear: ISO 15469:2004 / CIE S 011, equations 1 to 3, type 12; cie_overcast: type 16, (1 + 2 sin
///   elevation) / 3 of the zenith. Both white, and scaled to the illuminance of a horizontal plane that the
///   IES Lighting Handbook gives: 800 + 15500 sqrt(sin e) lx clear, 300 + 21000 sin e lx overcast, at the
///   sun's elevation e.
class Sky {
 public:
  explicit Sky(const SkyModel& model);
  vec3 radiance(const vec3& direction) const;
  /// Irradiance from the sky on a horizontal plane, by quadrature; in lx.
  vec3 horizontal_irradiance() const;

 private:
  vec3 above(const glm::dvec3& direction) const;

  SkyModel model_;
  glm::dvec3 to_sun_{0, 1, 0};
  bool night_ = false;
  double scale_ = 1;  ///< of CIE skies
  vec3 ground_{0};    ///< radiance
};

/// The sky as an image for Environment::image, k_sky_width x k_sky_width / 2 float texels, each the radiance
/// at its middle.
Image sky_image(const SkyModel& model);
inline constexpr uint32_t k_sky_width = 512;

}  // namespace lucerna::scene
