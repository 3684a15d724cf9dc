// links: session
// Picking: instances and their matrices, the nearest surface, holes of masked materials, both projections.
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "session/pick.h"

namespace commands_pick_tests {

using namespace lucerna;

namespace {

/// A square of side 2 in the plane z = 0, facing +z, with texture coordinates 0..1.
scene::Primitive square(uint32_t material) {
  scene::Primitive p;
  p.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  p.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  p.triangles = {{0, 1, 2}, {0, 2, 3}};
  p.material = material;
  return p;
}

/// Three squares one behind the other, at z = 0, -1, -2; the second scaled by 3 and mirrored.
scene::Scene make_scene() {
  scene::Scene s;
  s.materials.resize(3);
  for (uint32_t i = 0; i < 3; ++i) s.meshes.push_back({.name = "", .primitives = {square(i)}});
  s.instances.resize(3);
  for (uint32_t i = 0; i < 3; ++i) {
    s.instances[i].mesh = i;
    s.instances[i].to_world = glm::translate(mat4(1), vec3(0, 0, -float(i)));
  }
  s.instances[1].to_world = glm::scale(s.instances[1].to_world, vec3(-3, 3, 3));
  return s;
}

scene::Camera camera(bool orthographic = false) {
  scene::Camera c;
  c.to_world = glm::translate(mat4(1), vec3(0, 0, 4));
  c.yfov = 1.2f;
  c.orthographic = orthographic;
  c.ymag = 2;
  return c;
}

}  // namespace

TEST_CASE("the nearest surface under the point is found, in world space") {
  const scene::Scene s = make_scene();
  for (const bool orthographic : {false, true}) {
    const auto middle = session::pick(s, camera(orthographic), 0.5f, 0.5f, 1.5f);
    REQUIRE(middle);
    CHECK(middle->instance == 0);
    CHECK(middle->material == 0);
    CHECK(middle->distance == Approx(4));
    CHECK(glm::length(middle->position) < 1e-5f);
  }
  // Beside the first square, on the second: its scale counts.
  const auto beside = session::pick(s, camera(true), 0.5f + 1.5f / 6, 0.25f, 1.5f);
  REQUIRE(beside);
  CHECK(beside->instance == 1);
  CHECK(beside->distance == Approx(5));
  CHECK(glm::length(beside->position - vec3(1.5f, 1, -1)) < 1e-5f);
  CHECK_FALSE(session::pick(s, camera(), 0.5f, 0.5f, 1.5f).value().instance == 1);
  scene::Camera away = camera();
  away.to_world = glm::rotate(away.to_world, k_pi, vec3(0, 1, 0));
  CHECK_FALSE(session::pick(s, away, 0.5f, 0.5f, 1.5f));
  CHECK_FALSE(session::pick(scene::Scene{}, camera(), 0.5f, 0.5f, 1.5f));
}

TEST_CASE("a perspective ray passes through the requested point") {
  const scene::Scene s = make_scene();
  const scene::Camera c = camera();
  const vec3 wanted(0.6f, -0.3f, 0);  // on the first square
  const float half = 4 * std::tan(0.5f * c.yfov), aspect = 16.0f / 9;
  const auto hit =
      session::pick(s, c, 0.5f + 0.5f * wanted.x / (half * aspect), 0.5f - 0.5f * wanted.y / half, aspect);
  REQUIRE(hit);
  CHECK(hit->instance == 0);
  CHECK(glm::length(hit->position - wanted) < 1e-5f);
}

TEST_CASE("picking sees through the holes of a mask and through thin coverage") {
  scene::Scene s = make_scene();
  s.images.push_back({.name = "", .width = 2, .height = 1, .bytes = {255, 255, 255, 255, 255, 255, 255, 0}});
  s.textures.push_back({.image = 0});
  s.materials[0].alpha_mode = scene::AlphaMode::mask;
  s.materials[0].base_color_texture.texture = 0;
  const auto at = [&](float x) {
    return session::pick(s, camera(true), 0.5f + x / 6, 0.5f, 1.5f).value().instance;
  };
  CHECK(at(-0.5f) == 0);  // the left texel covers
  CHECK(at(0.5f) == 1);   // the right one is a hole
  s.materials[1].alpha_mode = scene::AlphaMode::blend;
  s.materials[1].base_color.w = 0.2f;
  CHECK(at(0.5f) == 2);
  s.materials[0].base_color_texture.m = {1, 0, 0.5f, 0, 1, 0};  // shifted by half: wraps around
  CHECK(at(-0.5f) == 2);
  CHECK(at(0.5f) == 0);
}

TEST_CASE("many rays with the tree give the result of one ray against all triangles") {
  auto s = std::make_shared<scene::Scene>(make_scene());
  // The first square has holes: a checkerboard of 8 x 8 texels.
  scene::Image image;
  image.width = image.height = 8;
  for (uint32_t i = 0; i < 64; ++i)
    for (int c = 0; c < 4; ++c) image.bytes.push_back((i + i / 8) % 2 ? 255 : 0);
  s->images.push_back(image);
  s->textures.push_back({.image = 0});
  s->materials[0].alpha_mode = scene::AlphaMode::mask;
  s->materials[0].base_color_texture.texture = 0;
  s->instances[2].to_world = glm::rotate(s->instances[2].to_world, 0.4f, vec3(1, 2, 0));
  const session::Probe probe(s);
  int hits = 0, first = 0, second = 0;
  for (int i = 0; i < 4000; ++i) {
    const float x = (float(i % 80) + 0.37f) / 80, y = (float(i / 80) + 0.41f) / 50;
    const session::PickRay ray = session::pick_ray(camera(), x, y, 1.5f);
    const auto expected = session::pick(*s, camera(), x, y, 1.5f);
    const auto found = probe.nearest(ray.origin, ray.direction);
    INFO(x << ' ' << y);
    REQUIRE(found.has_value() == expected.has_value());
    if (!found) continue;
    REQUIRE(found->instance == expected->instance);
    REQUIRE(found->distance == Approx(expected->distance).epsilon(1e-5));
    REQUIRE(glm::length(found->normal - expected->normal) < 1e-4f);
    REQUIRE(glm::dot(found->normal, ray.direction) < 0);
    ++hits, first += found->instance == 0, second += found->instance == 1;
    CHECK_FALSE(probe.nearest(ray.origin, ray.direction, 0.999f * found->distance));
    const auto behind = probe.nearest(ray.origin, ray.direction, k_infinity, [&](const session::Picked& p) {
      return p.instance != found->instance;
    });
    if (behind) REQUIRE(behind->distance > found->distance);
  }
  CHECK(hits > 1000);
  CHECK(first > 20);
  CHECK(second > 200);
}

}  // namespace commands_pick_tests
