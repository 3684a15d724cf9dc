#include "commands/interior.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace lucerna::commands {
namespace {

mat4 at(const mat4& rotation, const vec3& eye) {
  mat4 m = rotation;
  m[3] = vec4(eye, 1);
  return m;
}

/// Maximum distance along `direction` (unit) that keeps `clear` to the surface ahead.
float free_way(const Look& look, const vec3& eye, const vec3& direction, float wanted, float clear,
               Obstacle* met) {
  const auto hit = look(eye, direction, wanted + 10 * clear);
  if (!hit) return wanted;
  // The distance to the surface's plane counts, which a slanting way comes nearer to by its cosine.
  const float cosine = std::max(0.1f, -glm::dot(direction, hit->normal));
  const float way = std::max(0.0f, hit->distance - clear / cosine);
  if (way >= wanted) return wanted;
  *met = *hit;
  return way;
}

vec3 stepped(const Look& look, vec3 eye, vec3 step, float clear, bool slides, bool* blocked) {
  for (int i = 0; i < (slides ? 3 : 1); ++i) {
    const float length = glm::length(step);
    if (!(length > 1e-7f)) break;
    const vec3 direction = step / length;
    Obstacle met{.distance = -1};
    const float way = free_way(look, eye, direction, length, clear, &met);
    eye += way * direction;
    if (met.distance < 0) break;
    if (blocked) *blocked = true;
    step = (length - way) * direction;
    step -= glm::dot(step, met.normal) * met.normal;
  }
  return eye;
}

}  // namespace

float clearance(float extent) { return std::min(0.2f, 0.05f * extent); }

vec3 step_among(const Look& look, const vec3& eye, const vec3& step, float clear, bool* blocked) {
  return stepped(look, eye, step, clear, true, blocked);
}

vec3 step_straight(const Look& look, const vec3& eye, const vec3& step, float clear, bool* blocked) {
  return stepped(look, eye, step, clear, false, blocked);
}

void orbit_about(Viewpoint& view, const vec3& point, const vec2& angles) {
  const mat4 before = view.camera.to_world;
  const vec3 eye = eye_of(view.camera);
  // look() turns the frame; the eye follows by the same rotation about the point.
  Viewpoint turned = view;
  look(turned, {angles.x, -angles.y});
  const mat3 was(right_of(view.camera), up_of(view.camera), -forward_of(view.camera));
  const mat3 is(right_of(turned.camera), up_of(turned.camera), -forward_of(turned.camera));
  view.camera.to_world = at(turned.camera.to_world, point + is * glm::transpose(was) * (eye - point));
  const float depth = glm::dot(point - eye_of(view.camera), forward_of(view.camera));
  if (!std::isfinite(glm::length(eye_of(view.camera)))) {
    view.camera.to_world = before;
    return;
  }
  view.distance = std::max(depth, 0.01f * view.extent);
}

void dolly_towards(Viewpoint& view, const vec3& point, float steps) {
  if (view.camera.orthographic) return dolly(view, steps);
  const vec3 eye = eye_of(view.camera);
  const float kept = std::pow(0.9f, steps);
  vec3 way = (1 - kept) * (point - eye);
  // Close to it a step is one of the least distance, as in dolly().
  const float distance = glm::length(point - eye), smallest = 0.01f * view.extent;
  if (distance > 0 && distance < smallest) way *= smallest / distance;
  view.camera.to_world = at(view.camera.to_world, eye + way);
  view.distance =
      std::max(glm::dot(point - eye_of(view.camera), forward_of(view.camera)), 0.01f * view.extent);
}

std::optional<float> floor_below(const Look& look, const vec3& eye, float least, float extent) {
  std::optional<float> lowest;
  float travelled = 0;
  const float skin = 1e-4f * extent;
  for (int i = 0; i < 64; ++i) {
    const auto hit = look(eye - vec3(0, travelled, 0), vec3(0, -1, 0), 8 * extent);
    if (!hit) break;
    travelled += hit->distance;
    if (hit->normal.y > 0.5f) {
      lowest = travelled;
      if (travelled >= least) return travelled;
    }
    travelled += skin;
  }
  return lowest;
}

bool walk(Viewpoint& view, const Look& look, const vec2& metres, float height, bool through) {
  const vec3 up(0, 1, 0);
  vec3 right = right_of(view.camera);
  right.y = 0;
  if (!(glm::length(right) > 1e-6f)) return false;
  right = glm::normalize(right);
  const vec3 step = metres.x * right + metres.y * glm::cross(up, right);
  vec3 eye = eye_of(view.camera);
  bool blocked = false;
  const float clear = clearance(view.extent);
  eye = through ? eye + step : step_among(look, eye, vec3(step.x, 0, step.z), clear, &blocked);
  // Tables and chairs below the eye are no obstacles, and no floor: only low surfaces can be stepped on.
  const float least = std::max(height - k_stair, 0.1f * height);
  if (const auto floor = floor_below(look, eye, least, view.extent); floor && *floor >= least) {
    const vec3 rise(0, height - *floor, 0);
    // Under a low ceiling one stoops.
    eye = rise.y > 0 && !through ? step_straight(look, eye, rise, clear) : eye + rise;
  }
  view.camera.to_world = at(view.camera.to_world, eye);
  return blocked;
}

bool enclosed(const Look& look, const vec3& eye, float extent) {
  int met = 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const int axes = std::abs(x) + std::abs(y) + std::abs(z);
        if (axes != 1 && axes != 3) continue;
        met += look(eye, glm::normalize(vec3(x, y, z)), 4 * extent).has_value();
      }
  return met >= 11;
}

void frame_clear(Viewpoint& view, const Box& box, float aspect, const Look& look) {
  if (box.empty()) return;
  const Viewpoint before = view;
  frame(view, box, aspect);
  const float wanted = view.distance, radius = std::max(box.radius(), 1e-3f * view.extent);
  const float clear = clearance(view.extent);
  const vec3 centre = box.centre(), back = -forward_of(view.camera);
  float best = -1;
  vec3 best_back = back;
  // From the view's own direction outwards, by turns and then from a little above.
  for (const float lift : {0.0f, 25.0f, 50.0f})
    for (const float turn : {0.0f, 30.0f, -30.0f, 60.0f, -60.0f, 90.0f, -90.0f, 135.0f, -135.0f, 180.0f}) {
      vec3 d = vec3(glm::rotate(mat4(1), turn * k_pi / 180, vec3(0, 1, 0)) * vec4(back, 0));
      const float flat = std::hypot(d.x, d.z);
      const float elevation = std::atan2(d.y, flat) + lift * k_pi / 180;
      if (lift > 0) {
        if (flat < 1e-4f || elevation > 85 * k_pi / 180) continue;
        d = vec3(d.x / flat * std::cos(elevation), std::sin(elevation), d.z / flat * std::cos(elevation));
      }
      Obstacle met;
      const float way = free_way(look, centre, d, wanted, clear, &met);
      if (way > best + 1e-3f * wanted) best = way, best_back = d;
      if (way >= wanted) break;
      if (best >= wanted) break;
    }
  if (best <= std::min(radius, wanted) * 0.5f) {
    // Nothing is free around it: it is inside something else. The view stays.
    view = before;
    return;
  }
  if (best_back != back) place(view, centre + best * best_back, centre, vec3(0, 1, 0));
  view.distance = best;
  view.camera.to_world = at(view.camera.to_world, centre - best * forward_of(view.camera));
}

void frame_inside(Viewpoint& view, const Box& box, float aspect, const Look& look) {
  Viewpoint wanted = view;
  frame(wanted, box, aspect);
  const vec3 eye = eye_of(view.camera);
  // Directly back, not to the scene's centre, which may be in another room.
  const float back = std::max(0.0f, glm::dot(eye_of(wanted.camera) - eye, -forward_of(view.camera)));
  const vec3 end = step_straight(look, eye, -back * forward_of(view.camera), clearance(view.extent));
  view.distance += glm::length(end - eye);
  view.camera.to_world = at(wanted.camera.to_world, end);
}

}  // namespace lucerna::commands
