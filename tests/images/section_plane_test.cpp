// links: session
// A plane that cuts the view and not the light: a room is seen from outside through its wall, with the light
// of the closed room, by paths and by light tracing.
#include <catch2/catch.hpp>
#include <cmath>

#include "session/pick.h"
#include "support/caustics.h"

namespace section_plane_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_side = 32;

/// A closed room whose +z wall is at z = 2, with a lamp and a block; the camera is outside, 8 m before that
/// wall.
scene::Scene closed_room() {
  scene::Scene s = test::block_room();
  scene::Camera outside;
  outside.yfov = 0.4f, outside.to_world[3] = vec4(0, 1.25f, 10, 1);
  s.cameras = {outside};
  s.environment.given = true;
  return s;
}
constexpr scene::Section k_cut{.normal = {0, 0, -1}, .offset = -1.9f};  // keeps z < 1.9

double mean_of_all(const film::Image& image) {
  double sum = 0;
  for (size_t i = 0; i < image.samples.size(); ++i) sum += double(luminance(test::sum_at(image, i)));
  return sum / double(image.samples.size());
}

}  // namespace

TEST_CASE("through a section plane the camera sees the room with the light of the closed room") {
  // From the plane's middle, inside the room, the same rays start without a plane.
  scene::Scene s = closed_room();
  s.cameras[0].orthographic = true, s.cameras[0].xmag = s.cameras[0].ymag = 1.2f;
  scene::Scene inside = s;
  inside.cameras[0].to_world[3].z = 1.9f;
  s.cameras[0].section = k_cut;
  const test::Settings settings{{"components.secondary", "path"}};
  const film::Image cut = test::render(s, settings, 16, k_side).image,
                    same = test::render(inside, settings, 16, k_side).image;
  double off = 0;
  for (size_t i = 0; i < cut.samples.size(); ++i)
    off = std::max(off, double(glm::length(test::sum_at(cut, i) - test::sum_at(same, i))));
  // The same random numbers: only rounding differs.
  CHECK(mean_of_all(same) > 0.01);
  CHECK(mean_of_all(cut) == Approx(mean_of_all(same)).epsilon(0.002));
  CHECK(off < 0.2 * mean_of_all(same) + 0.05);
  // The wall hides the room otherwise; from before the plane nothing is cut.
  scene::Scene plain = s;
  plain.cameras[0].section = {};
  CHECK(mean_of_all(test::render(plain, settings, 4, k_side).image) < 0.5 * mean_of_all(cut));
  inside.cameras[0].section = {.normal = {0, 0, -1}, .offset = -5};
  CHECK(test::identical(test::render(inside, settings, 16, k_side).image.components[1], same.components[1]));
}

TEST_CASE("a section plane behind all surfaces, or turned away from the view, leaves nothing to see") {
  scene::Scene s = closed_room();
  for (const scene::Section& section : {scene::Section{.normal = {0, 0, -1}, .offset = 50},
                                        scene::Section{.normal = {0, 0, 1}, .offset = 50}}) {
    s.cameras[0].section = section;
    CHECK(mean_of_all(test::render(s, {}, 2, k_side).image) == 0);
  }
}

TEST_CASE("light tracing splats what the plane shows, and not what it hides") {
  // A floor lit by the turned sun; a board above it hides half of it from the camera, unless the plane cuts
  // it off.
  scene::Scene s = test::turned_sun(vec3(1));
  scene::Scene straight = s;
  straight.meshes.clear(), straight.instances.clear();
  test::add_quad(straight, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 0);
  straight.lights[0].direction = {0, -1, 0};
  for (scene::Scene* scene : {&s, &straight}) {
    // Lit by the beam too: its light must not appear where the plane cuts it off. It stops the beam.
    test::add_quad(*scene, {0, 0.4f, 1}, {0.5f, 0, 0}, {0, 0, -2}, 0);
    scene->cameras[0].section = {.normal = {0, -1, 0}, .offset = -0.2f};
  }
  const test::Result by_light =
      test::render(s, {{"components.caustic", "light"}, {"light.per_round", "40000"}}, 16, k_side);
  const test::Result by_paths = test::render(straight, {}, 64, k_side);
  bool dark = false, bright = false;
  for (uint32_t block = 0; block < 16; ++block) {
    const uint32_t x = block % 4 * 8, y = block / 4 * 8;
    const test::MeanOf light = test::mean_of(by_light.image, 3, x, y, x + 8, y + 8),
                       path = test::mean_of(by_paths.image, 0, x, y, x + 8, y + 8);
    INFO("block " << block << ": " << light.value.y << " +- " << light.noise.y << ", by paths "
                  << path.value.y);
    CHECK(std::abs(light.value.y - path.value.y) <=
          5 * std::hypot(light.noise.y, path.noise.y) + 0.004 * path.value.y);
    dark = dark || path.value.y < 0.1, bright = bright || path.value.y > 0.5;
  }
  CHECK(bright);
  CHECK(dark);
}

TEST_CASE("picking begins at the section plane too") {
  scene::Scene s = closed_room();
  const auto wall = session::pick(s, s.cameras[0], 0.5f, 0.5f, 1);
  REQUIRE(wall);
  s.cameras[0].section = k_cut;
  const auto within = session::pick(s, s.cameras[0], 0.5f, 0.5f, 1);
  REQUIRE(within);
  CHECK(within->position.z < 1.9f);
  CHECK(wall->position.z > within->position.z);
  s.cameras[0].section.normal = {0, 0, 1}, s.cameras[0].section.offset = 50;
  CHECK_FALSE(session::pick(s, s.cameras[0], 0.5f, 0.5f, 1));
}

}  // namespace section_plane_tests
