// links: session
// Lamps with a shape through the whole renderer: compared with the same light from shining surfaces, by every
// solver, and as seen by the camera.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/caustics.h"

namespace shaped_lights_tests {

using namespace lucerna;

using scene::LightKind;
using test::mean_of, test::MeanOf, test::with;

namespace {

const char* const k_names[] = {"primary", "secondary", "tertiary", "caustic"};

/// A room with a glass ball, a mirror and a glossy floor, without lights.
scene::Scene room() {
  scene::Scene s;
  s.name = "room", s.file = "room.gltf";
  s.materials = {test::diffuse({0.7f, 0.6f, 0.5f}), test::diffuse(vec3(0), vec3(20, 16, 12)), {}, {}, {}};
  s.materials[2].metallic = 0, s.materials[2].roughness = 0, s.materials[2].transmission = 1;
  s.materials[2].thickness = 1;
  s.materials[3].metallic = 1, s.materials[3].roughness = 0, s.materials[3].base_color = vec4(0.9f);
  s.materials[4].metallic = 0, s.materials[4].roughness = 0.4f, s.materials[4].base_color = vec4(0.4f);
  test::add_box(s, {-2, 0, -2}, {2, 2.5f, 2});
  test::add_ball(s, {0.5f, 0.6f, 0}, 0.5f, 2);
  test::add_quad(s, {-1.9f, 0.1f, -1}, {0, 2, 0}, {0, 0, 2}, 3);
  test::add_quad(s, {-2, 0.01f, 2}, {4, 0, 0}, {0, 0, -4}, 4);
  scene::Camera front;
  front.yfov = 1.2f, front.to_world[3] = vec4(0, 1.2f, 1.95f, 1);
  s.cameras = {front};
  s.environment.given = true;
  return s;
}

/// The panel under the ceiling, 0.8 m by 0.5 m.
scene::Scene with_surface(bool shines) {
  scene::Scene s = room();
  if (!shines) s.materials[1].emission = vec3(0);
  test::add_quad(s, {-0.4f, 2.499f, -0.25f}, {0.8f, 0, 0}, {0, 0, 0.5f}, 1);
  return s;
}
scene::Light panel() {
  scene::Light l{.name = "panel", .kind = LightKind::rectangle, .intensity = 0.4f * vec3(20, 16, 12)};
  l.position = {0, 2.4985f, 0}, l.direction = {0, -1, 0}, l.right = {1, 0, 0};
  l.width = 0.8f, l.height = 0.5f;
  return l;
}

/// One lamp of each shape.
scene::Scene with_shapes() {
  scene::Scene s = room();
  scene::Light sphere{.name = "globe", .kind = LightKind::sphere, .intensity = {1, 0.6f, 0.2f}};
  sphere.position = {-1, 1.8f, -0.6f}, sphere.radius = 0.15f;
  scene::Light disk{.name = "disk", .kind = LightKind::disk, .intensity = {0.2f, 0.7f, 1}};
  disk.position = {1.2f, 1.7f, -1.2f}, disk.radius = 0.3f, disk.two_sided = true;
  disk.direction = vec3(glm::normalize(glm::dvec3(-0.6, -0.7, 0.5)));
  disk.right = vec3(glm::normalize(glm::cross(glm::dvec3(disk.direction), glm::dvec3(0, 1, 0))));
  scene::Light tube{.name = "tube", .kind = LightKind::tube, .intensity = {0.8f, 0.8f, 0.8f}};
  tube.position = {0.2f, 2.2f, -1.5f}, tube.direction = {0, -1, 0}, tube.width = 1.5f, tube.radius = 0.04f;
  s.lights = {sphere, panel(), disk, tube};
  s.lights[1].intensity *= 0.2f;
  return s;
}

void check_alike(const film::Image& a, const film::Image& b, double bias = 0.0) {
  for (int component = 0; component < 4; ++component) {
    const MeanOf x = mean_of(a, component), y = mean_of(b, component);
    for (int c = 0; c < 3; ++c) {
      INFO(k_names[component] << ", channel " << c << ": " << x.value[c] << " +- " << x.noise[c] << " and "
                              << y.value[c] << " +- " << y.noise[c]);
      CHECK(std::abs(x.value[c] - y.value[c]) <
            4 * std::hypot(x.noise[c], y.noise[c]) + bias * std::abs(x.value[c]) + 1e-6);
    }
  }
}

constexpr uint32_t k_side = 32, k_samples = 96;

const test::Result& shapes_by_paths() {
  static const test::Result r =
      test::render(with_shapes(), {{"seed", "4"}, {"lights.sampling", "power"}}, 3 * k_samples, k_side);
  return r;
}

}  // namespace

TEST_CASE("a rectangle under the ceiling gives the light of a shining surface there, in all components") {
  const test::Result surface = test::render(with_surface(true), {{"seed", "3"}}, k_samples, k_side);
  // The lamp blocks nothing itself: a black surface lies behind it.
  scene::Scene s = with_surface(false);
  s.lights = {panel()};
  const test::Result lamp = test::render(s, {}, k_samples, k_side);
  CHECK(lamp.stats.dropped == 0);
  CHECK(mean_of(lamp.image, 3).value.y > 1e-3);
  check_alike(surface.image, lamp.image);
  // Among other lamps, of which some are resampled, and in a separate light group.
  for (int i = 0; i < 6; ++i) {
    scene::Light other{.name = "dim", .intensity = vec3(1e-4f)};
    other.position = {0.3f * float(i) - 1, 1, 1};
    s.lights.push_back(other);
  }
  s.lights[0].group = "panel";
  for (const char* groups : {"on", "compact"}) {
    INFO("groups " << groups);
    const test::Result grouped = test::render(s, {{"relight.enabled", groups}}, k_samples, k_side);
    CHECK(grouped.stats.dropped == 0);
    check_alike(surface.image, grouped.image, 2e-3);
  }
}

TEST_CASE("light of shapes is the same with learned lights and with light samples by power") {
  const test::Result learned =
      test::render(with_shapes(), {{"lights.sampling", "learned"}}, k_samples, k_side);
  check_alike(shapes_by_paths().image, learned.image);
}

TEST_CASE("photons and light tracing find the light of shapes") {
  const test::Result photons = test::render(with_shapes(),
                                            {{"components.secondary", "photons"},
                                             {"components.tertiary", "photons"},
                                             {"components.caustic", "photons"},
                                             {"photons.efficiency", "false"},
                                             {"photons.per_round", "50000"}},
                                            16, k_side);
  check_alike(shapes_by_paths().image, photons.image, 0.03);
  const test::Result light = test::render(
      with_shapes(), {{"components.caustic", "light"}, {"light.per_round", "100000"}}, 24, k_side);
  check_alike(shapes_by_paths().image, light.image, 0.01);
}

TEST_CASE("records hold the light of shapes once") {
  const test::Result cached = test::render(
      with_shapes(),
      test::dense_records({{"components.secondary", "cache"}, {"components.tertiary", "cache"}}), 32, k_side);
  check_alike(shapes_by_paths().image, cached.image, 0.03);
}

TEST_CASE("the camera sees a lamp's radiance, through glass and mirrors too, unless it is hidden") {
  scene::Scene s;
  s.name = "seen";
  s.materials = {test::diffuse(vec3(0))};
  test::add_quad(s, {-5, -5, -5}, {10, 0, 0}, {0, 10, 0}, 0);
  scene::Camera front;
  front.yfov = 0.6f, front.to_world[3] = vec4(0, 0, 3, 1);
  s.cameras = {front};
  s.environment.given = true;
  for (const LightKind kind : {LightKind::sphere, LightKind::rectangle, LightKind::disk, LightKind::tube}) {
    scene::Light l{.name = "lamp", .kind = kind, .intensity = {3, 2, 1}};
    l.direction = {0, 0, 1}, l.width = 1, l.height = 0.5f, l.radius = 0.3f;
    s.lights = {l};
    const auto pixel = [&](uint32_t x, uint32_t y) {
      return test::render(s, {}, 4, 32).image.components[0][size_t{y} * 32 + x];
    };
    const float area = kind == LightKind::rectangle ? 0.5f : kind == LightKind::tube ? 0.6f : 0.09f * k_pi;
    INFO(int(kind));
    CHECK(pixel(16, 16).x == Approx(3 / area).epsilon(1e-5));
    CHECK(pixel(16, 2) == vec3(0));
    s.lights[0].visible = false;
    CHECK(pixel(16, 16) == vec3(0));
    // From behind, only what has two sides or none.
    s.lights[0].visible = true, s.lights[0].direction = {0, 0, -1};
    const bool flat = kind == LightKind::rectangle || kind == LightKind::disk;
    CHECK((pixel(16, 16).x == 0) == flat);
    s.lights[0].two_sided = true;
    CHECK(pixel(16, 16).x > 0);
  }
}

}  // namespace shaped_lights_tests
