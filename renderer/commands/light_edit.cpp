#include "commands/light_edit.h"

#include <cmath>

namespace lucerna::commands {

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

}  // namespace lucerna::commands
