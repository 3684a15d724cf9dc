// links: session
// Light samples drawn from candidates by what each light would send (shaders/lib/lights.glsl): the same
// picture as by power alone, of less noise, also where paths meet the lights themselves.
#include <catch2/catch.hpp>

#include "support/render.h"
#include "support/rooms.h"

using namespace lucerna;
using namespace lucerna::test;

namespace {

/// A room with nine panels of two strengths under its ceiling, two lamps and a sun that does not reach it;
/// the floor is polished, so that both ways of finding a panel count.
scene::Scene lit_room() {
  scene::Scene s;
  s.name = "room", s.file = "room.gltf";
  s.materials = {diffuse(vec3(0.6f)), diffuse(vec3(0), vec3(2, 1.5f, 1)), diffuse(vec3(0), vec3(1, 2, 6))};
  scene::Material floor;
  floor.base_color = vec4(0.8f, 0.8f, 0.8f, 1), floor.metallic = 1, floor.roughness = 0.35f;
  s.materials.push_back(floor);
  s.materials[2].double_sided = true;
  add_box(s, {-4, 0, -4}, {4, 3, 4});
  add_quad(s, {-4, 0.01f, 4}, {8, 0, 0}, {0, 0, -8}, 3);
  for (int i = 0; i < 9; ++i)
    add_quad(s, {float(i % 3) * 3 - 3.3f, 2.8f - 0.6f * float(i % 2), float(i / 3) * 3 - 3.3f}, {0.5f, 0, 0},
             {0, 0, 0.3f}, 1 + uint32_t(i % 2));
  s.lights.push_back({.name = "lamp", .intensity = vec3(0.5f), .position = {-3, 1, 3}});
  s.lights.push_back({.name = "spot",
                      .kind = scene::LightKind::spot,
                      .intensity = vec3(4),
                      .position = {3, 2.5f, -3},
                      .direction = {0, -1, 0},
                      .inner_cone = 0.3f,
                      .outer_cone = 0.6f});
  s.lights.push_back({.name = "sun",
                      .kind = scene::LightKind::directional,
                      .intensity = vec3(3),
                      .direction = glm::normalize(vec3(0.2f, -1, 0.1f))});
  scene::Camera front;
  front.name = "front", front.yfov = 1.2f, front.to_world[3] = vec4(0, 1.4f, 3.9f, 1);
  s.cameras = {front};
  s.environment.given = true;
  return s;
}

/// Largest difference of blocks in standard errors, and the noise of both, squared.
struct Comparison {
  double worst = 0, noise_a = 0, noise_b = 0;
};
Comparison compare(const film::Image& a, const film::Image& b) {
  Comparison c;
  for (int component = 0; component < 2; ++component)
    for (uint32_t y = 0; y < a.height / 8; ++y)
      for (uint32_t x = 0; x < a.width / 8; ++x) {
        const Mean p = block_mean(a, component, x, y), q = block_mean(b, component, x, y);
        const double noise = std::hypot(p.noise, q.noise);
        if (noise > 0) c.worst = std::max(c.worst, std::abs(p.value - q.value) / noise);
        c.noise_a += p.noise * p.noise, c.noise_b += q.noise * q.noise;
      }
  return c;
}

}  // namespace

TEST_CASE("light samples from candidates make the same picture with less noise") {
  const scene::Scene s = lit_room();
  const Render how{.scene = {}, .width = 64, .height = 48, .samples = 128, .settings = {}, .defines = {}};
  Render by_power = how;
  by_power.defines = {{"LUCERNA_LIGHT_CANDIDATES", "0"}};
  by_power.settings = {{"seed", "7"}};
  const Result a = render(how, &s), b = render(by_power, &s);
  const Comparison c = compare(a.image, b.image);
  // 96 blocks of some 64 degrees of freedom: 5.5 come by chance in one of 10^4 such tests.
  CHECK(c.worst < 5.5);
  INFO(c.noise_a << " from candidates, " << c.noise_b << " by power");
  CHECK(c.noise_a < 0.7 * c.noise_b);
  // All that there is, to half a percent.
  CHECK(mean(a.image.components[0]) == Approx(mean(b.image.components[0])).epsilon(0.005));
}

TEST_CASE("light samples from candidates change nothing where lights are few") {
  scene::Scene s = block_room(false);
  const Render how{.scene = {}, .width = 32, .height = 24, .samples = 4, .settings = {}, .defines = {}};
  Render by_power = how;
  by_power.defines = {{"LUCERNA_LIGHT_CANDIDATES", "0"}};
  CHECK(identical(render(how, &s).image, render(by_power, &s).image));
}
