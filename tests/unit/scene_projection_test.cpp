// links: scene
// Rays of cameras and places in their pictures are inverse to each other.
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/projection.h"
#include "scene/range.h"

namespace scene_projection_tests {

using namespace lucerna;
using scene::Camera, scene::Wide;

namespace {

/// Turned and moved.
Camera camera_of(Wide wide, bool orthographic = false) {
  Camera c;
  c.wide = wide, c.orthographic = orthographic, c.yfov = 1.1f, c.xmag = 3, c.ymag = 2;
  const vec3 z = glm::normalize(vec3(0.4f, 0.3f, -1)), x = glm::normalize(glm::cross(vec3(0, 1, 0), z));
  c.to_world = mat4(vec4(x, 0), vec4(glm::cross(z, x), 0), vec4(z, 0), vec4(3, -2, 5, 1));
  return c;
}

vec3 forward_of(const Camera& c) { return -vec3(c.to_world[2]); }
vec3 right_of(const Camera& c) { return vec3(c.to_world[0]); }
vec3 up_of(const Camera& c) { return vec3(c.to_world[1]); }

}  // namespace

TEST_CASE("a point on a ray is where the ray goes through the picture") {
  for (const float aspect : {0.5f, 1.0f, 2.0f})
    for (int kind = 0; kind < 4; ++kind) {
      Camera c = camera_of(kind < 3 ? Wide(kind) : Wide::none, kind == 3);
      if (c.wide == Wide::none) c.shift = {0.2f, -0.1f};
      size_t seen = 0;
      for (int i = 0; i < 81; ++i) {
        const vec2 at(0.05f + 0.1f * float(i % 9) + 0.05f, 0.1f * float(i / 9) + 0.1f);
        const auto ray = scene::view_ray(c, at.x, at.y, aspect);
        INFO("kind " << kind << " aspect " << aspect << " at " << at.x << " " << at.y);
        if (!ray) {
          // Only outside the circle.
          REQUIRE(c.wide == Wide::fisheye);
          const vec2 off = (2.0f * at - 1.0f) * vec2(std::max(aspect, 1.0f), std::max(1 / aspect, 1.0f));
          REQUIRE(glm::length(off) > 0.999f);
          continue;
        }
        ++seen;
        CHECK(glm::length(ray->direction) == Approx(1));
        const auto back = scene::place_in_picture(c, ray->origin + 7.0f * ray->direction, aspect);
        REQUIRE(back);
        CHECK(glm::distance(*back, at) < 1e-4f);
      }
      CHECK(seen >= (c.wide == Wide::fisheye ? 25 : 81));
    }
}

TEST_CASE("a panorama shows longitude and latitude, a fisheye the angle from the axis") {
  Camera c = camera_of(Wide::panorama);
  const auto close = [](const std::optional<scene::ViewRay>& ray, const vec3& direction) {
    return ray && glm::distance(ray->direction, direction) < 1e-5f;
  };
  CHECK(close(scene::view_ray(c, 0.5f, 0.5f, 2), forward_of(c)));
  CHECK(close(scene::view_ray(c, 0.75f, 0.5f, 2), right_of(c)));
  CHECK(close(scene::view_ray(c, 0.0f, 0.5f, 2), -forward_of(c)));
  CHECK(close(scene::view_ray(c, 1.0f, 0.5f, 2), -forward_of(c)));
  CHECK(close(scene::view_ray(c, 0.3f, 0.0f, 2), up_of(c)));
  CHECK(close(scene::view_ray(c, 0.5f, 0.75f, 2), glm::normalize(forward_of(c) - up_of(c))));
  c.wide = Wide::fisheye;
  for (const float angle : {0.3f, 1.0f, 1.57f}) {
    const float at = 0.5f + angle / k_pi * 0.5f;  // the circle is half as wide as the picture
    CHECK(close(scene::view_ray(c, at, 0.5f, 2),
                std::cos(angle) * forward_of(c) + std::sin(angle) * right_of(c)));
  }
  CHECK_FALSE(scene::view_ray(c, 0.8f, 0.5f, 2));
  CHECK_FALSE(scene::place_in_picture(c, vec3(c.to_world[3]) - 2.0f * forward_of(c), 2));
  CHECK_FALSE(scene::place_in_picture(camera_of(Wide::none), vec3(3, -2, 5) - 2.0f * forward_of(c), 2));
}

TEST_CASE("an orthographic camera cannot be a panorama") {
  CHECK_NOTHROW(scene::check_range(camera_of(Wide::panorama)));
  CHECK_THROWS_WITH(scene::check_range(camera_of(Wide::fisheye, true)),
                    Catch::Contains("fisheye is not orthographic"));
}

}  // namespace scene_projection_tests
