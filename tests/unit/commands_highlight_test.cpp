// links: commands
// Lights by their highlights: whose is at a point, and where a light goes for its highlight to be there,
// against the law of reflection.
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "base/error.h"
#include "commands/highlight.h"

namespace commands_highlight_tests {

using namespace lucerna;
using namespace lucerna::commands;

namespace {

/// Squares of side 2 `half`: the floor y = 0, and others as instances of it. Material 0: polished; 1: matt;
/// 2: a mirror; 3: emits.
scene::Scene room(uint32_t floor_material, float half = 10) {
  scene::Scene s;
  s.materials.resize(4);
  for (scene::Material& m : s.materials) m.base_color = vec4(0.5f, 0.5f, 0.5f, 1), m.metallic = 0;
  s.materials[0].roughness = 0.25f;
  s.materials[1].roughness = 1;
  s.materials[2].roughness = 0, s.materials[2].metallic = 1;
  s.materials[3].roughness = 1, s.materials[3].emission = vec3(10);
  for (uint32_t material = 0; material < 4; ++material) {
    scene::Primitive p;
    p.positions = {{-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}};
    p.normals.assign(4, vec3(0, 1, 0));
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    p.material = material;
    s.meshes.push_back({.name = "", .primitives = {p}});
  }
  s.instances.resize(1);
  s.instances[0].mesh = floor_material;
  return s;
}

void add(scene::Scene& s, uint32_t material, const mat4& place) {
  s.instances.emplace_back();
  s.instances.back().mesh = material;
  s.instances.back().to_world = place;
}

session::Probe probe_of(scene::Scene s) {
  return session::Probe(std::make_shared<const scene::Scene>(std::move(s)));
}

session::PickRay ray(const vec3& eye, const vec3& at) { return {eye, glm::normalize(at - eye)}; }

scene::Light lamp(scene::LightKind kind = scene::LightKind::point) {
  scene::Light light;
  light.kind = kind;
  light.position = {3, 4, 0};
  light.intensity = vec3(50);
  light.direction = {0, -1, 0};
  return light;
}

const Selection k_first{Kind::light, 0};
const vec3 k_eye{-3, 4, 0};  // the mirror image of a lamp at (3, 4, 0) is at the origin

}  // namespace

TEST_CASE("a highlight's lamp is found where the law of reflection has it, and only there") {
  const session::Probe polished = probe_of(room(0));
  CHECK(light_in_highlight(polished, {lamp()}, ray(k_eye, {0, 0, 0}), 1) == k_first);
  for (const vec3& beside : {vec3(2.5f, 0, 0), vec3(-2, 0, 0), vec3(0, 0, 2), vec3(0, 0, -2)})
    CHECK(light_in_highlight(polished, {lamp()}, ray(k_eye, beside), 1) == Selection{});
  SECTION("not on matt surfaces, nor when it is off, or too faint to be seen") {
    CHECK(light_in_highlight(probe_of(room(1)), {lamp()}, ray(k_eye, vec3(0)), 1) == Selection{});
    scene::Light off = lamp();
    off.enabled = false;
    CHECK(light_in_highlight(polished, {off}, ray(k_eye, vec3(0)), 1) == Selection{});
    CHECK(light_in_highlight(polished, {lamp()}, ray(k_eye, vec3(0)), 1e-4f) == Selection{});
  }
  SECTION("the brighter of two, with its number in the list") {
    scene::Light faint = lamp();
    faint.intensity = vec3(1);
    CHECK(light_in_highlight(polished, {faint, lamp()}, ray(k_eye, vec3(0)), 1) == Selection{Kind::light, 1});
  }
  SECTION("not behind a wall, but behind glass") {
    scene::Scene s = room(0);
    add(s, 1, glm::translate(mat4(1), vec3(2.25f, 3, 0)) * glm::scale(mat4(1), vec3(0.02f)));
    CHECK(light_in_highlight(probe_of(s), {lamp()}, ray(k_eye, vec3(0)), 1) == Selection{});
    s.materials[1].transmission = 1;
    CHECK(light_in_highlight(probe_of(s), {lamp()}, ray(k_eye, vec3(0)), 1) == k_first);
  }
  SECTION("a spot that looks elsewhere has none") {
    scene::Light spot = lamp(scene::LightKind::spot);
    spot.outer_cone = 0.5f;
    CHECK(light_in_highlight(polished, {spot}, ray(k_eye, vec3(0)), 1) == Selection{});
  }
  SECTION("the textured roughness counts") {
    scene::Scene s = room(0);
    s.images.push_back({.name = "", .width = 1, .height = 1, .bytes = {255, 255, 255, 255}, .floats = {}});
    s.textures.push_back({.image = 0});
    for (scene::Material& m : s.materials) m.metallic_roughness_texture.texture = 0, m.roughness = 0.25f;
    s.meshes[0].primitives[0].uv0.assign(4, vec2(0.5f));
    CHECK(light_in_highlight(probe_of(s), {lamp()}, ray(k_eye, vec3(0)), 1) == k_first);
    for (scene::Material& m : s.materials) m.roughness = 1;
    CHECK(light_in_highlight(probe_of(s), {lamp()}, ray(k_eye, vec3(0)), 1) == Selection{});
    s.images[0].bytes = {255, 64, 255, 255};
    CHECK(light_in_highlight(probe_of(s), {lamp()}, ray(k_eye, vec3(0)), 1) == k_first);
  }
}

TEST_CASE("reflections of emissive surfaces and of highlights are found through mirrors") {
  // A mirror for a floor; a small emissive square above, facing down, seen in it at the origin.
  scene::Scene s = room(2);
  add(s, 3, glm::translate(mat4(1), vec3(3, 4, 0)) * glm::scale(mat4(1), vec3(0.05f, -1, 0.05f)));
  const session::Probe probe = probe_of(s);
  CHECK(light_in_highlight(probe, {}, ray(k_eye, vec3(0)), 1) == Selection{Kind::material, 3});
  CHECK(light_in_highlight(probe, {}, ray(k_eye, {1, 0, 0}), 1) == Selection{});
  // Seen directly it is an object.
  CHECK(light_in_highlight(probe, {}, ray(k_eye, {3, 4, 0}), 1) == Selection{});
  // A polished ceiling at y = 8 with the highlight of a lamp, seen by way of the floor: the eye's image is at
  // (-3, -4, 0), so a lamp at (3, -4, 0) ... of the ceiling is one 12 below it.
  scene::Scene two = room(2);
  add(two, 0, glm::translate(mat4(1), vec3(0, 8, 0)));
  scene::Light light = lamp();
  light.position = {9, 4, 0};
  light.intensity = vec3(500);
  // Unfolded: from (-3, -4) up to the ceiling y = 8 and on to the lamp's image at (9, 12).
  const vec3 image{-3, -4, 0}, lamp_image{9, 12, 0};
  const float at_floor = 4.0f / 16;
  CHECK(light_in_highlight(probe_of(two), {light}, ray(k_eye, image + at_floor * (lamp_image - image)), 1) ==
        k_first);
}

TEST_CASE("a lamp goes where its highlight is at the point, as far away as before") {
  const session::Probe probe = probe_of(room(0, 100));
  std::mt19937 random(7);
  std::uniform_real_distribution<float> across(-4, 4), up(1, 5);
  using Kind = scene::LightKind;
  for (const Kind kind :
       {Kind::point, Kind::spot, Kind::sphere, Kind::rectangle, Kind::disk, Kind::directional})
    for (int trial = 0; trial < 20; ++trial) {
      scene::Light light = lamp(kind);
      light.width = light.height = 0.2f, light.radius = 0.1f;
      light.position = {across(random), up(random), across(random)};
      light.intensity = vec3(1000);
      if (kind == Kind::directional) light.sun = scene::SunTime();
      const vec3 eye{across(random), up(random), across(random)}, at{across(random), 0, across(random)};
      const float before = glm::distance(light.position, at);
      CHECK(place_highlight(probe, ray(eye, at), light));
      INFO("kind " << int(kind) << ", trial " << trial);
      // Angles in and out are equal, in one plane: the lamp lies on the line from the eye's image.
      const vec3 from_image = glm::normalize(at - vec3(eye.x, -eye.y, eye.z));
      const vec3 way = kind == Kind::directional ? -light.direction : glm::normalize(light.position - at);
      CHECK(glm::length(way - from_image) < 1e-3f);
      if (kind == Kind::directional) {
        CHECK(!light.sun);
      } else {
        CHECK(glm::distance(light.position, at) == Approx(before).epsilon(1e-3));
        if (kind != Kind::point && kind != Kind::sphere)
          CHECK(glm::length(light.direction + from_image) < 1e-3f);
      }
      CHECK(light_in_highlight(probe, {light}, ray(eye, at), 1) == k_first);
    }
}

TEST_CASE("a lamp stays in front of walls, and impossible highlights are refused") {
  scene::Scene s = room(0);
  add(s, 1, glm::translate(mat4(1), vec3(0, 2, 0)));  // a ceiling at 2 m, the eye below
  const session::Probe probe = probe_of(s);
  scene::Light light = lamp();
  light.position = {8, 1, 0};
  CHECK_FALSE(place_highlight(probe, ray({-1, 1, 0}, vec3(0)), light));
  CHECK(light.position.y < 2);
  CHECK(light.position.y > 1);
  CHECK(light.position.x == Approx(light.position.y).epsilon(1e-3));
  CHECK_THROWS_WITH(place_highlight(probe, ray({0, 1, 0}, {30, 1, 0}), light),
                    Catch::Contains("no surface at this point"));
  CHECK_THROWS_WITH(place_highlight(probe, {vec3(0), vec3(0)}, light), Catch::Contains("no surface"));
}

}  // namespace commands_highlight_tests
