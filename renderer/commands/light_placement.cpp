#include "commands/light_placement.h"

#include <algorithm>
#include <cmath>

#include "commands/light_edit.h"
#include "scene/lamp.h"

namespace lucerna::commands {
namespace {

constexpr float k_far = 1e6f;  // m

float radius_of(const Room& room) {
  const float radius = room.core.empty() ? room.view.extent : room.core.radius();
  return std::max(radius, 1e-3f);
}

}  // namespace

LookedAt looked_at(const Room& room) {
  const vec3 eye = eye_of(room.view.camera), ahead = forward_of(room.view.camera);
  if (room.look)
    if (const auto hit = room.look(eye, ahead, k_far)) return {eye + hit->distance * ahead, hit->normal};
  return {pivot_of(room.view), -ahead};
}

vec3 off_surface(const Room& room) {
  const LookedAt at = looked_at(room);
  float off = 0.25f * glm::distance(eye_of(room.view.camera), at.point);
  // The ray starts off the surface, so as not to meet it again.
  const float least = 1e-3f * radius_of(room);
  if (room.look)
    if (const auto other = room.look(at.point + least * at.normal, at.normal, 2 * off))
      off = std::min(off, 0.5f * (other->distance + least));
  return at.point + std::max(off, least) * at.normal;
}

vec3 beside(const Room& room) { return 0.1f * radius_of(room) * right_of(room.view.camera); }

namespace {

/// `place`, or the nearest of some places beside it that no lamp is near.
vec3 free_place(const Room& room, const std::vector<scene::Light>& lamps, const vec3& place) {
  constexpr int k_tried = 8;
  const vec3 step = beside(room);
  const float least = 0.5f * glm::length(step);
  for (int k = 0; k <= k_tried; ++k) {
    const vec3 way = float((k + 1) / 2) * (k % 2 ? step : -step);
    const bool taken = std::any_of(lamps.begin(), lamps.end(), [&](const scene::Light& other) {
      return other.kind != scene::LightKind::directional &&
             glm::distance(other.position, place + way) < least;
    });
    const float length = glm::length(way);
    if (!taken && (k == 0 || !room.look || !room.look(place, way / length, length + least)))
      return place + way;
  }
  return place;
}

}  // namespace

void place_new(const Room& room, const std::vector<scene::Light>& others, scene::Light& light) {
  // Radiance 0.5 after exposure, of reflectance 0.5: irradiance pi.
  const float irradiance = k_pi * std::exp2(-room.ev);
  if (light.kind == scene::LightKind::directional) {
    light.direction = direction_from({.azimuth = 135, .elevation = 45});
    light.intensity = vec3(irradiance);
    return;
  }
  light.position = free_place(room, others, off_surface(room));
  const float distance = 0.25f * radius_of(room);
  light.intensity = vec3(irradiance * distance * distance);
  if (light.kind == scene::LightKind::point) return;
  if (has_shape(light.kind)) {
    const float size = 0.1f * radius_of(room);
    light.width = (light.kind == scene::LightKind::tube ? 3.3f : 1.5f) * size, light.height = size;
    light.radius = (light.kind == scene::LightKind::tube ? 0.1f : 0.5f) * size;
  }
  const glm::dvec3 way(looked_at(room).point - light.position);
  if (light.kind != scene::LightKind::sphere && glm::length(way) > 0)
    light.direction = vec3(glm::normalize(way));
  if (has_shape(light.kind)) light.right = scene::level_right(light.direction);
  if (light.kind != scene::LightKind::spot) return;
  light.inner_cone = glm::radians(20.0f), light.outer_cone = glm::radians(35.0f);
}

}  // namespace lucerna::commands
