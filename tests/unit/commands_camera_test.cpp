// links: commands
#include "commands/camera_control.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace commands_camera_tests {

using namespace lucerna;
using namespace lucerna::commands;

namespace {

scene::Camera camera_at(const vec3& eye, const vec3& target) {
  scene::Camera camera;
  camera.to_world = glm::inverse(glm::lookAt(eye, target, vec3(0, 1, 0)));
  camera.yfov = 0.9f;
  return camera;
}

Box room() {
  Box box;
  box.grow(vec3(-3, 0, -4)), box.grow(vec3(3, 3, 4));
  return box;
}

bool near(const vec3& a, const vec3& b, float tolerance = 1e-4f) { return glm::length(a - b) < tolerance; }

bool is_rigid(const mat4& m) {
  const vec3 x(m[0]), y(m[1]), z(m[2]);
  return near(glm::cross(x, y), z) && std::abs(glm::length(x) - 1) < 1e-4f &&
         std::abs(glm::dot(x, y)) < 1e-4f;
}

/// The position of a point in a picture of that height, in pixels from its centre, y down.
vec2 project(const scene::Camera& camera, const vec3& p, float height) {
  const vec3 d = p - eye_of(camera);
  const float z = glm::dot(d, forward_of(camera));
  const float scale = 0.5f * height / std::tan(0.5f * camera.yfov);
  return {scale * glm::dot(d, right_of(camera)) / z, -scale * glm::dot(d, up_of(camera)) / z};
}

}  // namespace

TEST_CASE("the pivot lies at the depth of the scene's centre") {
  const Viewpoint view = make_viewpoint(camera_at({0, 1.5f, 6}, {0, 1.5f, 0}), room());
  CHECK(view.distance == Approx(6).epsilon(1e-4));
  CHECK(near(pivot_of(view), {0, 1.5f, 0}));
  CHECK(make_viewpoint(camera_at({0, 1, 0}, {0, 1, -5}), room()).distance >= 0.05f * room().radius());
  CHECK(make_viewpoint(camera_at({0, 1, 0}, {0, 1, -5}), Box{}).distance > 0);
}

TEST_CASE("orbit keeps the pivot and the distance, and stops at the poles") {
  Viewpoint view = make_viewpoint(camera_at({2, 2, 5}, {0, 1, 0}), room());
  const vec3 pivot = pivot_of(view);
  const float distance = view.distance;
  for (int i = 0; i < 200; ++i) orbit(view, {0.31f, i % 3 ? 0.2f : -0.1f});
  CHECK(near(pivot_of(view), pivot, 1e-3f));
  CHECK(glm::length(eye_of(view.camera) - pivot) == Approx(distance).epsilon(1e-3));
  CHECK(is_rigid(view.camera.to_world));
  for (int i = 0; i < 50; ++i) orbit(view, {0, 0.5f});
  CHECK(forward_of(view.camera).y == Approx(-std::sin(89 * k_pi / 180)).margin(1e-4));
  CHECK(std::abs(right_of(view.camera).y) < 1e-3f);  // no roll was introduced

  Viewpoint front = make_viewpoint(camera_at({0, 1, 5}, {0, 1, 0}), room());
  orbit(front, {k_pi / 2, 0});  // a quarter turn counter-clockwise from above: +Z goes to +X
  CHECK(near(eye_of(front.camera) - pivot_of(front), {front.distance, 0, 0}, 1e-3f));
  orbit(front, {0, 0.3f});
  CHECK(eye_of(front.camera).y > 1.1f);
}

TEST_CASE("look turns about the eye") {
  Viewpoint view = make_viewpoint(camera_at({1, 2, 3}, {1, 2, 0}), room());
  look(view, {k_pi / 2, 0});
  CHECK(near(eye_of(view.camera), {1, 2, 3}));
  CHECK(near(forward_of(view.camera), {-1, 0, 0}));
  look(view, {0, 0.4f});
  CHECK(forward_of(view.camera).y == Approx(std::sin(0.4f)).margin(1e-4));
}

TEST_CASE("a pan moves the pivot with the cursor, pixel for pixel") {
  Viewpoint view = make_viewpoint(camera_at({2, 2, 5}, {0, 1, 0}), room());
  const vec3 grabbed = pivot_of(view);
  pan(view, {120, -45}, 600);
  const vec2 at = project(view.camera, grabbed, 600);
  CHECK(at.x == Approx(120).margin(0.05));
  CHECK(at.y == Approx(-45).margin(0.05));
}

TEST_CASE("dolly moves a tenth per step and does not stall at the pivot") {
  Viewpoint view = make_viewpoint(camera_at({0, 1, 6}, {0, 1, 0}), room());
  const vec3 pivot = pivot_of(view);
  dolly(view, 1);
  CHECK(view.distance == Approx(0.9f * 6).epsilon(1e-4));
  CHECK(near(pivot_of(view), pivot));
  dolly(view, -1);
  CHECK(view.distance == Approx(6).epsilon(1e-4));
  for (int i = 0; i < 20000; ++i) dolly(view, 1);
  CHECK(eye_of(view.camera).z < -1.0f);  // passed through the pivot
  CHECK(view.distance > 0);
  view.camera.orthographic = true, view.camera.ymag = 2, view.camera.xmag = 3;
  dolly(view, 1);
  CHECK(view.camera.ymag == Approx(1.8f));
  CHECK(view.camera.xmag == Approx(2.7f));
}

TEST_CASE("framing fits the sphere of the box") {
  for (float aspect : {0.5f, 1.0f, 2.0f}) {
    Viewpoint view = make_viewpoint(camera_at({2, 2, 5}, {0, 1, 0}), room());
    const vec3 before = forward_of(view.camera);
    Box box;
    box.grow(vec3(1, 0, 1)), box.grow(vec3(1.5f, 0.5f, 1.25f));
    frame(view, box, aspect);
    CHECK(near(forward_of(view.camera), before));
    CHECK(near(pivot_of(view), box.centre()));
    const float half_y = 0.45f, half_x = std::atan(std::tan(half_y) * aspect);
    const float seen = std::asin(box.radius() / view.distance);
    CHECK(seen < std::min(half_x, half_y));
    CHECK(seen > 0.9f * std::min(half_x, half_y));
  }
  Viewpoint view = make_viewpoint(camera_at({2, 2, 5}, {0, 1, 0}), room());
  const mat4 before = view.camera.to_world;
  frame(view, Box{}, 1);
  CHECK(view.camera.to_world == before);
}

TEST_CASE("flight is smooth and independent of the frame rate") {
  Flight coarse, fine;
  vec3 a(0), b(0);
  for (int i = 0; i < 10; ++i) a += advance(coarse, {0, 0, 1}, 2, 0.05f);
  for (int i = 0; i < 500; ++i) b += advance(fine, {0, 0, 1}, 2, 0.001f);
  CHECK(near(a, b, 2e-3f));
  CHECK(a.z == Approx(2 * (0.5 - 0.08)).margin(0.01));            // the start costs one time constant
  CHECK(glm::length(advance(coarse, {1, 1, 1}, 2, 10.0f)) < 21);  // diagonals are no faster
  for (int i = 0; i < 100; ++i) advance(coarse, {0, 0, 0}, 2, 0.016f);
  CHECK_FALSE(coarse.moving());
}

TEST_CASE("a scaled or sheared node matrix becomes rigid, and keeps its view") {
  Viewpoint view = make_viewpoint(camera_at({2, 2, 5}, {0, 1, 0}), room());
  const vec3 forward = forward_of(view.camera);
  view.camera.to_world = view.camera.to_world * glm::scale(mat4(1), vec3(2, 3, 0.5f));
  CHECK(near(forward_of(view.camera), forward));
  fly(view, {0, 0, 0});
  CHECK(is_rigid(view.camera.to_world));
  CHECK(near(forward_of(view.camera), forward));
  view.camera.to_world[0] = view.camera.to_world[1] = view.camera.to_world[2] = vec4(0);
  orbit(view, {0.1f, 0.1f});
  CHECK(is_rigid(view.camera.to_world));
}

TEST_CASE("focal lengths round-trip") {
  CHECK(yfov_from_focal_length(focal_length_mm(0.7f, 1.5f), 1.5f) == Approx(0.7f));
  CHECK(focal_length_mm(2 * std::atan(0.5f), 1.0f) == Approx(36.0f));
}

}  // namespace commands_camera_tests
