#include "scene/projection.h"

#include <algorithm>
#include <cmath>

namespace lucerna::scene {
namespace {

struct Axes {
  vec3 eye, right, up, forward;  ///< unit
};
Axes axes_of(const Camera& camera) {
  const mat4& m = camera.to_world;
  return {vec3(m[3]), glm::normalize(vec3(m[0])), glm::normalize(vec3(m[1])), -glm::normalize(vec3(m[2]))};
}

constexpr float k_most_angle = k_pi / 2;  // of a fisheye

}  // namespace

vec2 half_extent(const Camera& camera, float aspect) {
  switch (camera.wide) {
    case Wide::panorama:
      return {k_pi, k_pi / 2};
    case Wide::fisheye:
      return k_most_angle * vec2(std::max(aspect, 1.0f), std::max(1 / aspect, 1.0f));
    case Wide::none:
      break;
  }
  const float half = camera.orthographic ? camera.ymag : std::tan(0.5f * camera.yfov);
  return {half * aspect, half};
}

std::optional<ViewRay> view_ray(const Camera& camera, float right, float down, float aspect) {
  const Axes a = axes_of(camera);
  vec2 place = half_extent(camera, aspect);
  if (camera.wide == Wide::none)
    place *= vec2(2 * (right + camera.shift.x) - 1, 1 - 2 * (down - camera.shift.y));
  const vec3 aside = place.x * a.right + place.y * a.up;
  if (camera.orthographic) return ViewRay{a.eye + aside, a.forward};
  if (camera.wide == Wide::none) return ViewRay{a.eye, glm::normalize(a.forward + aside)};
  place *= vec2(2 * right - 1, 1 - 2 * down);
  if (camera.wide == Wide::panorama) {
    const vec3 level = std::cos(place.x) * a.forward + std::sin(place.x) * a.right;
    return ViewRay{a.eye, glm::normalize(std::cos(place.y) * level + std::sin(place.y) * a.up)};
  }
  const float angle = glm::length(place);
  if (angle > k_most_angle) return std::nullopt;
  const vec2 to = angle > 0 ? place * (std::sin(angle) / angle) : place;
  return ViewRay{a.eye, glm::normalize(std::cos(angle) * a.forward + to.x * a.right + to.y * a.up)};
}

std::optional<vec2> place_in_picture(const Camera& camera, const vec3& point, float aspect) {
  const Axes a = axes_of(camera);
  const vec3 d = point - a.eye;
  const float ahead = glm::dot(d, a.forward);
  vec2 aside(glm::dot(d, a.right), glm::dot(d, a.up)), shift = camera.shift;
  if (camera.wide != Wide::none) {
    const float distance = glm::length(d);
    if (!(distance > 0)) return std::nullopt;
    shift = vec2(0);
    if (camera.wide == Wide::panorama) {
      aside = {std::atan2(aside.x, ahead), std::asin(std::clamp(aside.y / distance, -1.0f, 1.0f))};
    } else {
      const float sine = glm::length(aside), angle = std::atan2(sine, ahead);
      if (angle > k_most_angle) return std::nullopt;
      aside = sine > 0 ? aside * (angle / sine) : vec2(0);
    }
  } else if (!camera.orthographic) {
    if (!(ahead > 1e-6f)) return std::nullopt;
    aside /= ahead;
  }
  const vec2 place = aside / half_extent(camera, aspect);
  return vec2(0.5f + 0.5f * place.x - shift.x, 0.5f - 0.5f * place.y + shift.y);
}

}  // namespace lucerna::scene
