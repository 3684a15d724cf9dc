// links: commands
// A lamp dragged in the picture stays under the pointer.
#include "commands/light_edit.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "commands/camera_control.h"

namespace commands_light_edit_tests {

using namespace lucerna;
using namespace lucerna::commands;

namespace {

scene::Camera camera_at(const vec3& eye, const vec3& target, bool orthographic = false) {
  scene::Camera camera;
  camera.to_world = glm::inverse(glm::lookAt(eye, target, vec3(0, 1, 0)));
  camera.yfov = 0.8f, camera.ymag = 2.5f;
  camera.orthographic = orthographic;
  return camera;
}

/// Pixels from the centre, y down, of a picture `height` pixels high.
vec2 pixel_of(const scene::Camera& camera, const vec3& point, float height) {
  const vec3 d = point - eye_of(camera);
  const float half =
      camera.orthographic ? camera.ymag : glm::dot(d, forward_of(camera)) * std::tan(0.5f * camera.yfov);
  return 0.5f * height / half * vec2(glm::dot(d, right_of(camera)), -glm::dot(d, up_of(camera)));
}

}  // namespace

TEST_CASE("a dragged lamp stays under the pointer and in its plane parallel to the picture") {
  for (const bool orthographic : {false, true}) {
    const scene::Camera camera = camera_at({3, 2, 5}, {0, 1, -1}, orthographic);
    const vec3 from(0.5f, 2.2f, -0.7f);
    const vec2 by(140, -65);
    const vec3 to = dragged(camera, from, by, 540, false);
    const vec2 moved = pixel_of(camera, to, 540) - pixel_of(camera, from, 540);
    CHECK(moved.x == Approx(by.x).epsilon(1e-4));
    CHECK(moved.y == Approx(by.y).epsilon(1e-4));
    CHECK(glm::dot(to - from, forward_of(camera)) == Approx(0).margin(1e-5));
    CHECK(dragged(camera, from, {0, 0}, 540, false) == from);
  }
}

TEST_CASE("with Shift it moves vertically, following the pointer's height") {
  for (const vec3 eye : {vec3(3, 2, 5), vec3(1, 6, 3)}) {
    // Far away, where height changes the distance little.
    const scene::Camera camera = camera_at(100.0f * eye, {0, 1, -1});
    const vec3 from(0.5f, 2.2f, -0.7f);
    const vec3 to = dragged(camera, from, {90, -3}, 540, true);
    CHECK(to.x == from.x);
    CHECK(to.z == from.z);
    CHECK(to.y > from.y);
    const vec2 moved = pixel_of(camera, to, 540) - pixel_of(camera, from, 540);
    CHECK(moved.y == Approx(-3).epsilon(0.03));
  }
  // Seen from exactly above there is no vertical motion; the lamp must not jump.
  scene::Camera above;
  above.to_world = glm::inverse(glm::lookAt(vec3(0, 10, 0), vec3(0), vec3(0, 0, -1)));
  above.yfov = 0.8f;
  const vec3 to = dragged(above, vec3(0), {0, 100}, 500, true);
  CHECK(std::abs(to.y) < 20);
  // It also follows the pointer with an upside-down camera.
  scene::Camera rolled = camera_at({0, 1, 8}, {0, 1, 0});
  rolled.to_world[0] = -rolled.to_world[0], rolled.to_world[1] = -rolled.to_world[1];
  CHECK(dragged(rolled, vec3(0), {0, -40}, 500, true).y < 0);
}

TEST_CASE("a lamp at the camera's position or behind it does not jump") {
  const scene::Camera camera = camera_at({0, 1, 4}, {0, 1, 0});
  for (const vec3 from : {vec3(0, 1, 4), vec3(0, 1, 9)})
    CHECK(dragged(camera, from, {50, 20}, 500, false) == from);
}

}  // namespace commands_light_edit_tests
