#include "commands/light_edit.h"

#include <algorithm>
#include <cmath>

#include "commands/camera_control.h"

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

vec3 dragged(const scene::Camera& camera, const vec3& from, const vec2& pixels, float picture_height,
             bool upright) {
  const vec3 away = from - eye_of(camera);
  const float depth = camera.perspective() ? glm::dot(away, forward_of(camera)) : glm::length(away);
  const float half = half_height_at(camera, std::max(depth, 0.0f));
  const vec2 metres = pixels * (2 * half / std::max(picture_height, 1.0f));
  const vec3 up = up_of(camera);
  if (!upright) return from + metres.x * right_of(camera) - metres.y * up;
  // Seen from above or below the pointer's way says little of the height: then as if from 12 degrees off.
  constexpr float k_least = 0.2f;
  return from - vec3(0, metres.y / std::max(std::abs(up.y), k_least) * (up.y < 0 ? -1.0f : 1.0f), 0);
}

}  // namespace lucerna::commands
