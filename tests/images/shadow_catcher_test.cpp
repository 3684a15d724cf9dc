// links: session
// Shadow catchers: without objects they cannot be seen; shadows in closed form; objects do not see them;
// light focused onto them by light tracing and photons.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/caustics.h"

namespace shadow_catcher_tests {

using namespace lucerna;

namespace {

constexpr double k_pi_d = 3.14159265358979323846;

scene::Material catcher() {
  scene::Material m = test::diffuse({0.3f, 0.1f, 0.05f}, vec3(5));
  m.specular = 1, m.metallic = 0.5f;  // nothing of it is shown
  m.shadow_catcher = true;
  return m;
}

/// Looks along `forward`; orthographic, 2 * half metres.
scene::Camera view(const vec3& eye, const vec3& forward, float half) {
  scene::Camera c;
  const vec3 z = -normalize(forward), x = normalize(cross(vec3(0, 0, -1), z)), y = cross(z, x);
  c.to_world = mat4(vec4(x, 0), vec4(y, 0), vec4(z, 0), vec4(eye, 1));
  c.orthographic = true, c.xmag = c.ymag = half;
  return c;
}

/// A floor below a sky whose radiance is 1 + sky * y; seen from above.
scene::Scene ground(float sky) {
  scene::Scene s;
  s.name = "ground";
  s.materials = {catcher(), test::diffuse(vec3(0))};
  test::add_quad(s, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, 0);
  s.cameras = {view({0, 3, 0}, {0.1f, -1, 0.05f}, 0.2f)};
  scene::Image image;
  image.name = "sky", image.width = 64, image.height = 256;
  for (uint32_t i = 0; i < image.width * image.height; ++i) {
    const auto value = float(1 + double(sky) * std::cos((i / image.width + 0.5) / image.height * k_pi_d));
    image.floats.insert(image.floats.end(), {value, value, 0.5f * value, 1});
  }
  s.images.push_back(image);
  s.environment.image = 0, s.environment.given = true;
  return s;
}

double all(const test::Result& r) {
  double sum = 0;
  for (int c = 0; c < 4; ++c) sum += test::mean_of(r.image, c).value.y;
  return sum;
}

scene::Light lamp(scene::LightKind kind, const vec3& intensity) {
  scene::Light l{.name = "lamp", .kind = kind, .intensity = intensity, .position = {0.5f, 2, 0.3f}};
  l.direction = normalize(vec3(-0.25f, -1, -0.15f));
  return l;
}

}  // namespace

TEST_CASE("without objects a shadow catcher cannot be seen") {
  scene::Scene s = ground(0.8f);
  s.lights = {lamp(scene::LightKind::directional, vec3(2, 1, 3)), lamp(scene::LightKind::point, vec3(5)),
              lamp(scene::LightKind::spot, {1, 2, 3})};
  s.lights[2].outer_cone = 1;
  scene::Scene without = s;
  without.meshes = {}, without.instances = {};
  test::add_quad(without, {-90, 0, 0}, {1, 0, 0}, {0, 0, 1}, 1);
  const test::Result a = test::render(s, {}, 64, 32), b = test::render(without, {}, 4, 32);
  for (int c = 0; c < 3; ++c) {
    const auto sum = [&](const test::Result& r) {
      double light = 0;
      for (int k = 0; k < 4; ++k) light += test::mean_of(r.image, k).value[c];
      return light;
    };
    CHECK(sum(a) == Approx(sum(b)).epsilon(0.01));
  }
  // It is a diffuse surface's direct light, shown by any solver for it; no deeper light is there.
  for (int k = 1; k < 4; ++k) CHECK(test::mean_of(a.image, k).value.y == 0);
}

TEST_CASE("its shadows are the share of the light that is missing") {
  // A black square of 2 m, 1 m above: its form factor from below its middle, and a sun that it hides.
  scene::Scene s = ground(0);
  test::add_quad(s, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, 1);
  s.cameras = {view({0, 0.8f, 0}, {0.01f, -1, 0.01f}, 0.02f)};
  const double side = 1, t = std::sqrt(1 + side * side);
  const double factor = 4 * (1 / (2 * k_pi_d)) * (2 * (side / t) * std::atan(side / t));
  CHECK(all(test::render(s, {}, 512, 16)) == Approx(1 - factor).epsilon(0.02));
  s.lights = {lamp(scene::LightKind::directional, vec3(2))};
  s.lights[0].direction = {0, -1, 0};
  CHECK(all(test::render(s, {}, 512, 16)) == Approx((1 - factor) * k_pi_d / (k_pi_d + 2)).epsilon(0.02));
  // A white one gives light back: what it gets from the sky below, which the catcher does not hide.
  s.lights.clear();
  s.materials[1].base_color = vec4(1);
  CHECK(all(test::render(s, {}, 512, 16)) == Approx(1).epsilon(0.02));
}

TEST_CASE("objects are lit through it, and lamps through it too") {
  for (const bool catches : {false, true}) {
    scene::Scene s = ground(-0.5f);
    if (!catches) s.meshes = {}, s.instances = {};
    s.materials[1] = test::diffuse(vec3(0.5f));
    test::add_quad(s, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, 1);
    s.lights = {lamp(scene::LightKind::point, vec3(3))};
    s.lights[0].position = {0, -1, 0};
    s.cameras = {view({0, 0.5f, 0}, {0.01f, 1, 0.01f}, 0.1f)};
    // Light arrives from below only: of a sky of 1 - y / 2, and of the lamp.
    const double sky = k_pi_d + 2 * k_pi_d / 3 * 0.5, of_lamp = 3 / 4.0;
    INFO("catches " << catches);
    CHECK(all(test::render(s, {}, 64, 16)) == Approx(0.5 / k_pi_d * (sky + of_lamp)).epsilon(0.015));
  }
}

TEST_CASE("light that a mirror throws onto a catcher brightens it") {
  scene::Scene s = test::turned_sun(vec3(1));
  s.materials[0] = catcher();
  s.environment.radiance = vec3(2);
  // By the sun's light on the mirror alone; the mirror hides a part of the sky, and shows it instead.
  for (const char* solver : {"light", "photons"}) {
    const auto render = [&](const scene::Scene& lit) {
      return test::render(lit,
                          {{"components.primary", "off"},
                           {"components.secondary", "off"},
                           {"components.tertiary", "off"},
                           {"components.caustic", solver},
                           {"photons.efficiency", "false"},
                           {"light.per_round", "200000"},
                           {"photons.per_round", "200000"},
                           {"photons.radius", "0.3"}},
                          32, 32, false);
    };
    const test::Result r = render(s);
    INFO(solver);
    // The sun passes over the floor: E is the sky's. The sky in the mirror is a caustic too.
    scene::Scene dark = s;
    dark.lights.clear();
    const double of_sun = test::mean_of(r.image, 3).value.y - test::mean_of(render(dark).image, 3).value.y;
    CHECK(of_sun == Approx(2 * 4 / (k_pi_d * 2)).epsilon(0.02));
  }
}

}  // namespace shadow_catcher_tests
