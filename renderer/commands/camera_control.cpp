#include "commands/camera_control.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/projection.h"
#include "scene/range.h"

namespace lucerna::commands {
namespace {

constexpr float k_pole = 89.0f * k_pi / 180;  // elevation at which turning stops
constexpr float k_time_constant = 0.08f;      // seconds, of the flight's velocity

vec3 unit_or(const vec3& v, const vec3& fallback) {
  const float length = glm::length(v);
  return length > 1e-20f && std::isfinite(length) ? v / length : fallback;
}

/// The camera's frame without scale or shear; a node matrix may hold both.
mat4 rigid(const mat4& m) {
  const vec3 back = unit_or(vec3(m[2]), vec3(0, 0, 1));
  vec3 right = vec3(m[0]) - back * glm::dot(vec3(m[0]), back);
  const vec3 any = std::abs(back.y) < 0.9f ? vec3(0, 1, 0) : vec3(0, 0, -1);
  right = unit_or(right, unit_or(glm::cross(any, back), vec3(1, 0, 0)));
  const vec3 up = glm::cross(back, right);
  return mat4(vec4(right, 0), vec4(up, 0), vec4(back, 0), vec4(vec3(m[3]), 1));
}

mat4 placed(const mat4& rotation, const vec3& eye) {
  mat4 m = rigid(rotation);
  m[3] = vec4(eye, 1);
  return m;
}

/// Rotation by x about world Y and y about the horizontal axis of the frame, with the elevation of
/// `direction` held off the poles.
mat4 turned(const mat4& m, const vec2& angles) {
  const vec3 forward = -vec3(m[2]);
  const float elevation = std::asin(std::clamp(forward.y, -1.0f, 1.0f));
  // A view that starts beyond the limit may stay there, but not go further.
  const float limit = std::max(k_pole, std::abs(elevation));
  const float y = std::clamp(elevation + angles.y, -limit, limit) - elevation;
  const vec3 horizontal = unit_or(glm::cross(forward, vec3(0, 1, 0)), vec3(m[0]));
  const mat4 pitch = glm::rotate(mat4(1), y, horizontal);
  const mat4 yaw = glm::rotate(mat4(1), angles.x, vec3(0, 1, 0));
  return yaw * pitch * m;
}

float smallest_distance(const Viewpoint& view) { return 0.01f * view.extent; }

}  // namespace

vec3 eye_of(const scene::Camera& camera) { return vec3(camera.to_world[3]); }
vec3 right_of(const scene::Camera& camera) { return vec3(rigid(camera.to_world)[0]); }
vec3 up_of(const scene::Camera& camera) { return vec3(rigid(camera.to_world)[1]); }
vec3 forward_of(const scene::Camera& camera) { return -vec3(rigid(camera.to_world)[2]); }
vec3 pivot_of(const Viewpoint& view) { return eye_of(view.camera) + view.distance * forward_of(view.camera); }

Viewpoint make_viewpoint(const scene::Camera& camera, const Box& core) {
  Viewpoint view{.camera = camera};
  if (!core.empty() && core.radius() > 0) view.extent = core.radius();
  const vec3 centre = core.empty() ? vec3(0) : core.centre();
  const float depth = glm::dot(centre - eye_of(camera), forward_of(camera));
  view.distance = std::clamp(depth, 0.05f * view.extent, 2 * view.extent);
  return view;
}

void orbit(Viewpoint& view, const vec2& angles) {
  const vec3 pivot = pivot_of(view);
  // The eye rises when the view turns down.
  const mat4 m = turned(rigid(view.camera.to_world), {angles.x, -angles.y});
  view.camera.to_world = placed(m, pivot + view.distance * vec3(m[2]));
}

void look(Viewpoint& view, const vec2& angles) {
  view.camera.to_world = placed(turned(rigid(view.camera.to_world), angles), eye_of(view.camera));
}

void pan(Viewpoint& view, const vec2& pixels, float picture_height) {
  const float half_height = half_height_at(view.camera, view.distance);
  const float metres = 2 * half_height / std::max(picture_height, 1.0f);
  fly(view, {-pixels.x * metres, pixels.y * metres, 0});
}

void dolly(Viewpoint& view, float steps) {
  const float factor = std::pow(0.9f, steps);
  if (view.camera.orthographic) {
    const float held = std::max(factor, 1e-4f * view.extent / std::max(view.camera.ymag, 1e-20f));
    view.camera.xmag *= held, view.camera.ymag *= held;
    return;
  }
  const float smallest = smallest_distance(view);
  const float closer = view.distance * factor;
  float travel = view.distance - closer;
  if (closer < smallest && steps > 0) {
    // Near the pivot a tenth of the distance is nothing: take the step that the smallest distance gives, and
    // push the pivot.
    travel = std::max(travel, smallest * (1 - factor));
  }
  view.camera.to_world = placed(view.camera.to_world, eye_of(view.camera) + travel * forward_of(view.camera));
  view.distance = std::max(closer, smallest);
}

void fly(Viewpoint& view, const vec3& metres) {
  const mat4 m = rigid(view.camera.to_world);
  view.camera.to_world =
      placed(m, vec3(m[3]) + metres.x * vec3(m[0]) + metres.y * vec3(m[1]) - metres.z * vec3(m[2]));
}

bool place(Viewpoint& view, const vec3& eye, const vec3& target, const vec3& up) {
  const vec3 away = eye - target;
  const float distance = glm::length(away);
  const vec3 right = glm::cross(up, away);
  if (!(distance > 1e-12f) || !(glm::length(right) > 1e-6f * glm::length(up) * distance)) return false;
  view.camera.to_world = placed(mat4(vec4(right, 0), vec4(up, 0), vec4(away, 0), vec4(eye, 1)), eye);
  view.distance = distance;
  return true;
}

void frame(Viewpoint& view, const Box& box, float aspect) {
  if (box.empty()) return;
  const float radius = std::max(box.radius(), 1e-3f * view.extent);
  if (view.camera.orthographic) {
    const float ratio = view.camera.xmag / std::max(view.camera.ymag, 1e-20f);
    view.camera.ymag = 1.05f * radius / std::min(1.0f, std::max(ratio, 1e-3f));
    view.camera.xmag = view.camera.ymag * ratio;
    view.distance = 2 * radius;
  } else {
    const float half_y = 0.5f * view.camera.yfov;
    const float half_x = std::atan(std::tan(half_y) * std::max(aspect, 1e-3f));
    view.distance = 1.05f * radius / std::sin(std::min(half_x, half_y));
  }
  // The box's centre in the middle of the picture, which a lens shift moves away from the view axis.
  const float half =
      view.camera.orthographic ? view.camera.ymag : view.distance * std::tan(0.5f * view.camera.yfov);
  const vec2 aside = 2 * half * view.camera.shift * vec2(aspect, 1);
  view.camera.to_world =
      placed(view.camera.to_world, box.centre() - view.distance * forward_of(view.camera) -
                                       aside.x * right_of(view.camera) - aside.y * up_of(view.camera));
}

bool upright(Viewpoint& view, float aspect) {
  constexpr float k_most = 80 * k_pi / 180;  // of the view axis and the picture's middle from the horizon
  scene::Camera& camera = view.camera;
  const vec3 eye = eye_of(camera), axis = forward_of(camera);
  const vec2 half = std::tan(0.5f * camera.yfov) * vec2(aspect, 1);
  const vec3 middle =
      axis + 2.0f * (camera.shift.x * half.x * right_of(camera) + camera.shift.y * half.y * up_of(camera));
  const float flat = std::hypot(axis.x, axis.z);
  if (!camera.perspective() || !(flat > std::cos(k_most))) return false;
  const vec3 level(axis.x / flat, 0, axis.z / flat), right(-level.z, 0, level.x);
  const float ahead = glm::dot(middle, level);
  if (!(ahead > std::cos(k_most) * glm::length(middle))) return false;
  // Seen under the same angle around the middle: lengths in the plane of the picture grow with the ray's own
  // length.
  const float wider = 1 / ahead;
  const float yfov = 2 * std::atan(half.y * wider);
  const vec2 now_half = half * wider;
  const vec2 shift = vec2(glm::dot(middle, right), middle.y) / (2 * ahead * now_half);
  if (glm::any(glm::greaterThan(glm::abs(shift), vec2(scene::k_max_shift)))) return false;
  camera.to_world = mat4(vec4(right, 0), vec4(0, 1, 0, 0), vec4(-level, 0), vec4(eye, 1));
  camera.yfov = yfov, camera.shift = shift;
  // Focus and pivot stay at the surface in the middle of the picture.
  camera.lens.focus_distance *= ahead, view.distance *= ahead;
  return true;
}

float walking_speed(float extent) { return std::max(1.5f, 0.15f * extent) * std::min(1.0f, extent); }

vec3 advance(Flight& flight, const vec3& wish, float speed, float seconds) {
  const float length = glm::length(wish);
  const vec3 target = length > 0 ? wish * (speed / std::max(length, 1.0f)) : vec3(0);
  // Exact integral of v' = (target - v) / tau over the step, so that two half steps equal a whole one.
  const float keep = std::exp(-seconds / k_time_constant);
  const vec3 metres = target * seconds + (flight.velocity - target) * (k_time_constant * (1 - keep));
  flight.velocity = target + (flight.velocity - target) * keep;
  if (length == 0 && glm::length(flight.velocity) < 1e-3f * speed) flight.velocity = vec3(0);
  return metres;
}

float half_height_at(const scene::Camera& camera, float depth) {
  return scene::half_extent(camera, 1).y * (camera.orthographic ? 1 : depth);
}

float focal_length_mm(float yfov, float aspect) { return 18.0f / (std::tan(0.5f * yfov) * aspect); }
float yfov_from_focal_length(float millimetres, float aspect) {
  return 2 * std::atan(18.0f / (millimetres * aspect));
}

bool same_view(const scene::Camera& a, const scene::Camera& b) {
  return a.to_world == b.to_world && a.orthographic == b.orthographic && a.wide == b.wide &&
         a.yfov == b.yfov && a.xmag == b.xmag && a.ymag == b.ymag && a.aspect == b.aspect &&
         a.lens == b.lens && a.shift == b.shift && a.section == b.section;
}

}  // namespace lucerna::commands
