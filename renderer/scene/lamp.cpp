#include "scene/lamp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lucerna::scene {

double solid_angle(const Light& lamp) {
  switch (lamp.kind) {
    case LightKind::point:
      return 4 * std::numbers::pi;
    case LightKind::spot: {
      if (lamp.picture) return picture_solid_angle(lamp);
      // Full within the inner cone, and the square of what is left of the way to the outer cosine, as
      // shaders/lib/lights.glsl has it: the ramp holds a third of its width.
      const double inner{std::cos(lamp.inner_cone)}, outer{std::cos(lamp.outer_cone)};
      const double width = std::max(inner - outer, 1e-4), ramp = std::min(1.0, (1 - outer) / width);
      return 2 * std::numbers::pi * (std::max(0.0, 1 - outer - width) + width * ramp * ramp * ramp / 3);
    }
    case LightKind::sphere:
      return 4 * std::numbers::pi;
    case LightKind::rectangle:
    case LightKind::disk:
      return std::numbers::pi * (lamp.two_sided ? 2 : 1);
    case LightKind::tube:
      return std::numbers::pi * std::numbers::pi;
    case LightKind::profile:
      return lamp.profile ? lamp.profile->solid_angle : 4 * std::numbers::pi;
    case LightKind::directional:
      break;
  }
  return 0;
}

vec2 half_size(const Light& lamp) {
  switch (lamp.kind) {
    case LightKind::sphere:
    case LightKind::disk:
      return vec2(lamp.radius);
    case LightKind::rectangle:
      return 0.5f * vec2(lamp.width, lamp.height);
    case LightKind::tube:
      return {0.5f * lamp.width, lamp.radius};
    default:
      return vec2(0);
  }
}

vec3 radiance_of(const Light& lamp) {
  const bool round = lamp.kind == LightKind::sphere || lamp.kind == LightKind::disk;
  const vec2 half = half_size(lamp);
  return lamp.intensity / ((round ? k_pi : 4.0f) * half.x * half.y);
}

vec3 level_right(const vec3& direction) {
  const glm::dvec3 level = glm::cross(glm::dvec3(direction), glm::dvec3(0, 1, 0));
  return glm::length(level) > 1e-4 ? vec3(glm::normalize(level)) : vec3(1, 0, 0);
}

vec3 right_across(const vec3& direction, const vec3& right) {
  const glm::dvec3 d(direction), across = glm::dvec3(right) - d * glm::dot(d, glm::dvec3(right));
  return glm::length(across) > 1e-6 ? vec3(glm::normalize(across)) : level_right(direction);
}

vec3 rolled(const vec3& direction, float degrees) {
  const glm::dvec3 level(level_right(direction)), up = glm::cross(level, glm::dvec3(direction));
  const double angle = glm::radians(double{degrees});
  return right_across(direction, vec3(std::cos(angle) * level + std::sin(angle) * up));
}

float roll_of(const vec3& direction, const vec3& right) {
  const vec3 level = level_right(direction), up = glm::cross(level, direction);
  return glm::degrees(std::atan2(glm::dot(right, up), glm::dot(right, level)));
}

void turn_to(Light& light, const vec3& direction) {
  if (can_roll(light)) {
    const glm::dvec3 from(light.direction), to(direction), axis = glm::cross(from, to);
    const double cosine = glm::dot(from, to);
    glm::dvec3 right(light.right);
    // Rodrigues; about half a turn the axis is any.
    if (cosine > -0.999999)
      right = right * cosine + glm::cross(axis, right) + axis * (glm::dot(axis, right) / (1 + cosine));
    light.right = right_across(direction, vec3(right));
  }
  light.direction = direction;
}

bool can_roll(const Light& light) {
  return has_shape(light.kind) || light.kind == LightKind::profile || light.picture;
}

void set_profile(Light& light, std::shared_ptr<const LightProfile> profile) {
  const double power = solid_angle(light);
  if (light.kind != LightKind::profile) light.right = level_right(light.direction);
  light.kind = LightKind::profile, light.profile = std::move(profile), light.picture.reset();
  light.intensity *= float(power / solid_angle(light));
}

void drop_profile(Light& light) {
  const double power = solid_angle(light);
  light.kind = LightKind::point, light.profile.reset();
  light.intensity *= float(power / solid_angle(light));
}

void set_picture(Light& light, std::shared_ptr<const LightPicture> picture) {
  if (!light.picture) light.right = level_right(light.direction);
  light.picture = std::move(picture);
}

const char* kind_name(LightKind kind) {
  static constexpr const char* k_names[] = {"point",     "spot", "directional", "sphere",
                                            "rectangle", "disk", "tube",        "profile"};
  return k_names[static_cast<size_t>(kind)];
}

}  // namespace lucerna::scene
