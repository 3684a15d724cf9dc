#include "gizmo.h"

#include <algorithm>
#include <cmath>

#include "commands/camera_control.h"

namespace lucerna::ui {
namespace {

using scene::ObjectPlace;
using session::PickRay;

/// Cosine between a ray and a plane below which its crossing says little.
constexpr float k_grazing = 0.05f;

std::optional<vec3> crossing(const PickRay& ray, const vec3& point, const vec3& normal) {
  const float across = glm::dot(normal, ray.direction);
  if (std::abs(across) < k_grazing) return std::nullopt;
  const float t = glm::dot(point - ray.origin, normal) / across;
  if (!(t > 0)) return std::nullopt;
  return ray.origin + t * ray.direction;
}

/// Where along the axis through `point` the ray passes closest, in metres; nullopt if both are parallel.
std::optional<float> along(const PickRay& ray, const vec3& point, const vec3& axis) {
  const float cosine = glm::dot(axis, ray.direction), sine2 = 1 - cosine * cosine;
  if (sine2 < k_grazing * k_grazing) return std::nullopt;
  const vec3 off = ray.origin - point;
  return (glm::dot(off, axis) - cosine * glm::dot(off, ray.direction)) / sine2;
}

float snapped(float value, float step, bool snap) { return snap ? std::round(value / step) * step : value; }

/// The angle [radians] about an axis by which the pointer has gone round.
float angle_about(const Gizmo& g, const vec3& axis, const PickRay& from, const PickRay& to) {
  const auto a = crossing(from, g.middle, axis), b = crossing(to, g.middle, axis);
  if (a && b) {
    const vec3 u = *a - g.middle, v = *b - g.middle;
    if (glm::length(u) > 0 && glm::length(v) > 0)
      return std::atan2(glm::dot(glm::cross(u, v), axis), glm::dot(u, v));
  }
  // A ring seen from its side: along its front.
  const vec3 front = glm::cross(axis, g.view[2]);
  if (!(glm::length(front) > 0)) return 0;
  const vec3 way = glm::normalize(front);
  const auto s = along(from, g.middle, way), t = along(to, g.middle, way);
  return s && t ? (*t - *s) / g.reach : 0;
}

void move_by(const Gizmo& g, GizmoPart part, const PickRay& from, const PickRay& to, bool snap,
             ObjectPlace& place) {
  if (part <= GizmoPart::z) {
    const vec3 axis = g.axes[int(part)];
    const auto a = along(from, g.middle, axis), b = along(to, g.middle, axis);
    if (a && b) place.moved += snapped(*b - *a, k_step_metres, snap) * axis;
    return;
  }
  const vec3 normal = part == GizmoPart::middle ? g.view[2] : g.axes[int(part) - int(GizmoPart::yz)];
  const auto a = crossing(from, g.middle, normal), b = crossing(to, g.middle, normal);
  if (!a || !b) return;
  vec3 way = *b - *a;
  if (snap && part == GizmoPart::middle) {
    for (int k = 0; k < 3; ++k) way[k] = snapped(way[k], k_step_metres, true);
  } else if (snap) {
    vec3 steps(0);
    for (int k = 0; k < 3; ++k) steps += snapped(glm::dot(way, g.axes[k]), k_step_metres, true) * g.axes[k];
    way = steps;
  }
  place.moved += way;
}

void size_by(const Gizmo& g, GizmoPart part, const PickRay& from, const PickRay& to, bool snap,
             ObjectPlace& place) {
  const auto sized = [&](float scale, float factor) {
    const float size = snapped(std::abs(scale) * std::max(factor, 0.0f), k_step_factor, snap);
    const float least = snap ? k_step_factor : scene::k_least_factor;
    return std::copysign(std::clamp(size, least, scene::k_most_factor), scale);
  };
  if (part <= GizmoPart::z) {
    const vec3 axis = g.axes[int(part)];
    const auto a = along(from, g.middle, axis), b = along(to, g.middle, axis);
    if (!a || !b || std::abs(*a) < 0.05f * g.reach) return;
    place.scaled[int(part)] = sized(place.scaled[int(part)], *b / *a);
    return;
  }
  const auto a = crossing(from, g.middle, g.view[2]), b = crossing(to, g.middle, g.view[2]);
  if (!a || !b) return;
  // To the right and up is larger: twice as large in an arm's length.
  const float factor = std::exp2(std::clamp(glm::dot(*b - *a, g.view[0] + g.view[1]) / g.reach, -16.f, 16.f));
  // One factor for all axes, by the first.
  const float common = sized(place.scaled.x, factor) / place.scaled.x;
  for (int k = 0; k < 3; ++k)
    place.scaled[k] = std::copysign(
        std::clamp(std::abs(place.scaled[k] * common), scene::k_least_factor, scene::k_most_factor),
        place.scaled[k]);
}

}  // namespace

Gizmo make_gizmo(GizmoMode mode, const Box& box, const mat4& to_world, const scene::Camera& camera,
                 float reach) {
  Gizmo g{.mode = mode, .middle = scene::middle_of(box, to_world), .reach = reach};
  if (mode == GizmoMode::size)
    for (int k = 0; k < 3; ++k)
      if (const float length = glm::length(vec3(to_world[k])); length > 0)
        g.axes[k] = vec3(to_world[k]) / length;
  g.view = {commands::right_of(camera), commands::up_of(camera), -commands::forward_of(camera)};
  return g;
}

ObjectPlace dragged_place(const Gizmo& g, GizmoPart part, const ObjectPlace& start, const PickRay& from,
                          const PickRay& to, bool snap) {
  ObjectPlace place = start;
  if (from.direction == vec3(0) || to.direction == vec3(0)) return place;
  if (g.mode == GizmoMode::move) move_by(g, part, from, to, snap, place);
  if (g.mode == GizmoMode::size) size_by(g, part, from, to, snap, place);
  if (g.mode == GizmoMode::turn && part <= GizmoPart::z) {
    const float degrees =
        snapped(glm::degrees(angle_about(g, g.axes[int(part)], from, to)), k_step_degrees, snap);
    vec3 turn(0);
    turn[int(part)] = degrees;
    place.turned =
        scene::angles_of(scene::rotation_of(turn) * scene::rotation_of(start.turned), start.turned + turn);
  }
  return place;
}

}  // namespace lucerna::ui
