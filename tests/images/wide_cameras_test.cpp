// links: session
// Panorama and fisheye through the whole renderer: each pixel shows what lies in its direction, at its
// distance; light paths that are connected to the camera find the same brightness as in a plane picture; the
// cached and the path-traced picture agree.
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/projection.h"
#include "session/pick.h"
#include "support/caustics.h"
#include "support/rooms.h"

namespace wide_cameras_tests {

using namespace lucerna;
using scene::Wide;

namespace {

constexpr Wide k_kinds[] = {Wide::panorama, Wide::fisheye};

/// The room from its middle.
scene::Scene room_seen_by(Wide wide) {
  scene::Scene s = test::block_room(false);
  s.cameras.resize(1);
  s.cameras[0].wide = wide;
  s.cameras[0].to_world[3] = vec4(0.7f, 1.3f, 0.9f, 1);
  return s;
}

float distance_at(const scene::Scene& s, float x, float y, float aspect) {
  const auto hit = session::pick(s, s.cameras[0], x, y, aspect);
  return hit ? hit->distance : 0;
}

}  // namespace

TEST_CASE("a pixel shows the surface in its direction") {
  constexpr uint32_t k_width = 48, k_height = 24;
  for (const Wide wide : k_kinds) {
    INFO(scene::k_projection_names[size_t(wide)]);
    const scene::Scene s = room_seen_by(wide);
    session::Renderer r(test::renderer_options());
    r.set_size(k_width, k_height);
    r.set_scene(std::make_shared<scene::Scene>(s));
    test::set(r, {{"samples", "16"}});
    const film::Image image = test::finish(r);
    uint32_t compared = 0, black = 0;
    for (uint32_t y = 0; y < k_height; ++y)
      for (uint32_t x = 0; x < k_width; ++x) {
        const size_t i = size_t{y} * k_width + x;
        float lo = k_infinity, hi = 0;
        for (int k = 0; k < 9; ++k) {
          const float d = distance_at(s, (float(x) + 0.5f * float(k % 3)) / k_width,
                                      (float(y) + 0.5f * float(k / 3)) / k_height, float(k_width) / k_height);
          lo = std::min(lo, d), hi = std::max(hi, d);
        }
        INFO(x << " " << y);
        if (hi == 0) {
          // Outside the circle there is neither surface nor light.
          ++black;
          REQUIRE(image.depth[i] == 0);
          for (const auto& component : image.components) REQUIRE(component[i] == vec3(0));
        } else if (lo > 0 && hi < 1.2f * lo) {
          ++compared;
          CHECK(image.depth[i] >= 0.97f * lo);
          CHECK(image.depth[i] <= 1.03f * hi);
        }
      }
    CHECK(compared > (wide == Wide::panorama ? 800u : 200u));
    CHECK(black >= (wide == Wide::panorama ? 0u : 500u));
    CHECK(r.device().validation_messages() == 0);
  }
}

TEST_CASE("light paths find the brightness of a beam in wide pictures too") {
  const vec3 radiance = vec3(0.8f, 0.5f, 0.2f) * vec3(3, 4, 5) * vec3(0.9f, 0.8f, 0.7f) / k_pi;
  constexpr uint32_t k_side = 24;
  for (const Wide wide : k_kinds) {
    INFO(scene::k_projection_names[size_t(wide)]);
    scene::Scene s = test::turned_sun();
    s.cameras[0].wide = wide;
    const test::Result r =
        test::render(s, {{"components.caustic", "light"}, {"light.per_round", "100000"}}, 24, k_side);
    glm::dvec3 sum(0);
    uint32_t lit = 0;
    for (uint32_t y = 0; y < k_side; ++y)
      for (uint32_t x = 0; x < k_side; ++x) {
        // Pixels with all corners on the floor, which is lit everywhere.
        bool on = true;
        for (int k = 0; k < 4; ++k) {
          const auto ray =
              scene::view_ray(s.cameras[0], float(x + k % 2) / k_side, float(y + k / 2) / k_side, 1);
          const vec3 at = ray ? ray->origin - ray->origin.y / ray->direction.y * ray->direction : vec3(9);
          on = on && ray && ray->direction.y < 0 && std::abs(at.x) < 0.95f && std::abs(at.z) < 0.95f;
        }
        if (!on) continue;
        ++lit;
        sum += glm::dvec3(r.image.components[3][size_t{y} * k_side + x]);
      }
    REQUIRE(lit >= (wide == Wide::panorama ? 40u : 80u));
    for (int c = 0; c < 3; ++c) CHECK(sum[c] / lit == Approx(double(radiance[c])).epsilon(0.01));
    CHECK(r.stats.dropped == 0);
  }
}

TEST_CASE("a cached panorama agrees with the path-traced one") {
  const scene::Scene s = room_seen_by(Wide::panorama);
  const test::Settings cached{{"components.secondary", "cache"}, {"components.tertiary", "cache"}};
  const test::Result by_paths = test::render(s, {}, 128, 32), by_cache = test::render(s, cached, 16, 32);
  for (const size_t c : {size_t{1}, size_t{2}})
    CHECK(double(luminance(vec3(test::mean_of(by_cache.image, int(c)).value))) ==
          Approx(double(luminance(vec3(test::mean_of(by_paths.image, int(c)).value)))).epsilon(0.05));
}

}  // namespace wide_cameras_tests
