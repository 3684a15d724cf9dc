#include "lamp_outline.h"

#include <algorithm>
#include <cmath>

#include "scene/lamp.h"
#include "scene/range.h"

namespace lucerna::ui {
namespace {

using scene::LightKind;

std::vector<vec3> circle(const vec3& centre, const vec3& x, const vec3& y) {
  std::vector<vec3> points;
  for (int k = 0; k <= 48; ++k) {
    const float angle = float(k) * 2 * k_pi / 48;
    points.push_back(centre + std::cos(angle) * x + std::sin(angle) * y);
  }
  return points;
}

/// From the centre towards the eye, unit.
vec3 towards(const scene::Light& light, const vec3& eye) {
  const vec3 way = eye - light.position;
  return glm::length(way) > 0 ? glm::normalize(way) : vec3(0, 0, 1);
}

/// Where the ray passes the plane through `point`; nothing behind its origin.
std::optional<vec3> on_plane(const vec3& point, const vec3& normal, const vec3& origin,
                             const vec3& direction) {
  const float across = glm::dot(normal, direction);
  if (std::abs(across) < 1e-4f) return std::nullopt;
  const float t = glm::dot(point - origin, normal) / across;
  if (!(t > 0)) return std::nullopt;
  return origin + t * direction;
}

float clamped(float size) { return std::clamp(size, scene::k_least_lamp, scene::k_max_lamp); }

}  // namespace

std::vector<std::vector<vec3>> lamp_outline(const scene::Light& light, float reach) {
  const vec3 c = light.position, n = light.direction;
  const vec3 x = can_roll(light) ? light.right : scene::level_right(n), y = glm::cross(x, n);
  const vec2 half = half_size(light);
  std::vector<std::vector<vec3>> lines;
  switch (light.kind) {
    case LightKind::rectangle: {
      const vec3 u = half.x * x, v = half.y * y;
      lines = {{c - u - v, c + u - v, c + u + v, c - u + v, c - u - v},
               {c, c + 0.5f * std::min(half.x, half.y) * n}};
      break;
    }
    case LightKind::disk:
      lines = {circle(c, half.x * x, half.x * y), {c, c + 0.5f * half.x * n}};
      break;
    case LightKind::sphere:
      for (int k = 0; k < 3; ++k) {
        vec3 a(0), b(0);
        a[k] = half.x, b[(k + 1) % 3] = half.x;
        lines.push_back(circle(c, a, b));
      }
      break;
    case LightKind::tube:
      for (const float end : {-half.x, half.x}) lines.push_back(circle(c + end * x, half.y * n, half.y * y));
      for (const vec3& side : {n, -n, y, -y})
        lines.push_back({c - half.x * x + half.y * side, c + half.x * x + half.y * side});
      break;
    case LightKind::spot: {
      const float radius = reach * std::sin(light.outer_cone), ahead = reach * std::cos(light.outer_cone);
      lines.push_back(circle(c + ahead * n, radius * x, radius * y));
      for (const vec3& side : {x, -x, y, -y}) lines.push_back({c, c + ahead * n + radius * side});
      if (light.picture) {
        const vec2 extent = ahead * picture_extent(light);
        const vec3 o = c + ahead * n, u = extent.x * x, v = extent.y * y;
        lines.push_back({o - u - v, o + u - v, o + u + v, o - u + v, o - u - v});
      }
      break;
    }
    case LightKind::profile:
      for (const vec3& side : {x, y}) {
        std::vector<vec3> web;
        for (int k = 0; k <= 120; ++k) {
          const float angle = float(k) * 2 * k_pi / 120, s = std::sin(angle), f = std::cos(angle);
          const float share =
              light.profile ? light.profile->along(side == x ? vec3(s, 0, -f) : vec3(0, s, -f)) : 0;
          web.push_back(c + reach * share * (s * side + f * n));
        }
        lines.push_back(std::move(web));
      }
      break;
    default:
      break;
  }
  return lines;
}

std::optional<vec3> size_handle(const scene::Light& light, float reach, const vec3& eye) {
  const vec3 c = light.position, n = light.direction, x = light.right, y = glm::cross(x, n);
  const vec2 half = half_size(light);
  switch (light.kind) {
    case LightKind::rectangle:
      return c + half.x * x + half.y * y;
    case LightKind::disk:
      return c + half.x * x;
    case LightKind::tube:
      return c + half.x * x;
    case LightKind::sphere:
      return c + half.x * scene::level_right(towards(light, eye));
    case LightKind::spot:
      return c +
             reach * (std::cos(light.outer_cone) * n + std::sin(light.outer_cone) * scene::level_right(n));
    default:
      return std::nullopt;
  }
}

std::vector<std::pair<std::string, float>> size_by_ray(const scene::Light& light, const vec3& eye,
                                                       const vec3& origin, const vec3& direction) {
  const vec3 c = light.position, n = light.direction, x = light.right, y = glm::cross(x, n);
  const vec3 front = towards(light, eye);
  vec3 plane = n;
  if (light.kind == LightKind::sphere) plane = front;
  // Across the view, but along the axis that is dragged.
  if (light.kind == LightKind::tube) plane = front - x * glm::dot(x, front);
  if (light.kind == LightKind::spot) plane = glm::cross(n, scene::level_right(n));
  if (!(glm::length(plane) > 1e-4f)) return {};
  const std::optional<vec3> at = on_plane(c, glm::normalize(plane), origin, direction);
  if (!at) return {};
  const vec3 d = *at - c;
  switch (light.kind) {
    case LightKind::rectangle:
      return {{"width", clamped(2 * std::abs(glm::dot(d, x)))},
              {"height", clamped(2 * std::abs(glm::dot(d, y)))}};
    case LightKind::disk:
    case LightKind::sphere:
      return {{"radius", clamped(glm::length(d))}};
    case LightKind::tube:
      return {{"length", clamped(2 * std::abs(glm::dot(d, x)))}};
    case LightKind::spot: {
      if (!(glm::length(d) > 0)) return {};
      const float cosine = glm::dot(glm::normalize(d), n);
      return {{"cone", std::clamp(std::acos(std::clamp(cosine, -1.0f, 1.0f)) * 180 / k_pi, 0.5f, 90.0f)}};
    }
    default:
      return {};
  }
}

}  // namespace lucerna::ui
