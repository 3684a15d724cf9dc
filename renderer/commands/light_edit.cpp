#include "commands/light_edit.h"

#include <algorithm>
#include <cmath>

namespace lucerna::commands {

float solid_angle(const scene::Light& lamp) {
  switch (lamp.kind) {
    case scene::LightKind::point:
      return 4 * k_pi;
    case scene::LightKind::spot: {
      // The square of a ramp that is linear in the cosine holds a third of its width.
      const float inner = std::cos(lamp.inner_cone), outer = std::cos(lamp.outer_cone);
      return 2 * k_pi * ((1 - inner) + (inner - outer) / 3);
    }
    case scene::LightKind::directional:
      break;
  }
  return 0;
}

Bearing bearing_of(const vec3& direction) {
  const vec3 from = -direction;
  const float flat = std::hypot(from.x, from.z);
  Bearing bearing;
  bearing.elevation = std::atan2(from.y, flat) * 180 / k_pi;
  if (flat > 1e-6f) bearing.azimuth = std::atan2(from.x, -from.z) * 180 / k_pi;
  if (bearing.azimuth < 0) bearing.azimuth += 360;
  return bearing;
}

vec3 direction_from(const Bearing& bearing) {
  const double a = double{bearing.azimuth} * double{k_pi} / 180,
               e = double{bearing.elevation} * double{k_pi} / 180;
  return -vec3(std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a));
}

float strength_of(const vec3& color) { return std::max({color.x, color.y, color.z}); }

vec3 tint_of(const vec3& color) {
  const float strength = strength_of(color);
  return strength > 0 ? color / strength : vec3(1);
}

}  // namespace lucerna::commands
