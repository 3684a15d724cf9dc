#pragma once
// Scenes made by tests from quads and boxes: rooms with interreflections.
#include <array>
#include <cmath>

#include "base/math.h"
#include "scene/scene.h"

namespace lucerna::test {

/// Without gloss.
inline scene::Material diffuse(const vec3& color, const vec3& emission = vec3(0)) {
  scene::Material m;
  m.base_color = vec4(color, 1), m.emission = emission;
  m.roughness = 1, m.metallic = 0, m.specular = 0;
  return m;
}

/// Adds a mesh with one instance.
inline void add_mesh(scene::Scene& s, const char* name, const scene::Primitive& p) {
  s.meshes.push_back({name, {p}});
  s.instances.push_back({name, scene::Id(s.meshes.size() - 1), mat4(1), false});
}

/// A parallelogram, counter-clockwise from its front, textured from 0 to 1.
inline void add_quad(scene::Scene& s, const vec3& a, const vec3& u, const vec3& v, uint32_t material = 0) {
  scene::Primitive p;
  p.material = material;
  p.positions = {a, a + u, a + u + v, a + v};
  p.normals.assign(4, normalize(cross(u, v)));
  p.tangents.assign(4, vec4(normalize(u), 1));
  p.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  p.triangles = {{0, 1, 2}, {0, 2, 3}};
  add_mesh(s, "quad", p);
}

/// The six sides of a box face inwards, like a room's. `open`: without the upper one.
inline void add_box(scene::Scene& s, const vec3& lo, const vec3& hi, uint32_t material = 0,
                    bool open = false) {
  scene::Primitive p;
  p.material = material;
  for (int k = 0; k < 8; ++k)
    p.positions.emplace_back(k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z);
  for (const auto& [a, b, c, d] : {std::array{0u, 1u, 3u, 2u},
                                   {4u, 6u, 7u, 5u},
                                   {0u, 2u, 6u, 4u},
                                   {1u, 5u, 7u, 3u},
                                   {0u, 4u, 5u, 1u},
                                   {2u, 3u, 7u, 6u}})
    p.triangles.emplace_back(a, b, c), p.triangles.emplace_back(a, c, d);
  if (open) p.triangles.resize(10);
  add_mesh(s, "box", p);
}

/// A ball of `rings` times twice as many quads, with the normals of a sphere.
inline void add_ball(scene::Scene& s, const vec3& at, float radius, uint32_t material, uint32_t rings = 24) {
  scene::Primitive p;
  p.material = material;
  const uint32_t around = 2 * rings;
  for (uint32_t i = 0; i <= rings; ++i)
    for (uint32_t k = 0; k <= around; ++k) {
      const float theta = k_pi * float(i) / float(rings), phi = 2 * k_pi * float(k % around) / float(around);
      const vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      p.positions.push_back(at + radius * n);
      p.normals.push_back(n);
    }
  for (uint32_t i = 0; i < rings; ++i)
    for (uint32_t k = 0; k < around; ++k) {
      const uint32_t a = i * (around + 1) + k, b = a + around + 1;
      if (i > 0) p.triangles.emplace_back(a, a + 1, b);
      if (i + 1 < rings) p.triangles.emplace_back(a + 1, b + 1, b);
    }
  add_mesh(s, "ball", p);
}

/// At `eye`; its right is +x, its up -z.
inline scene::Camera looking_down(const vec3& eye, float yfov) {
  scene::Camera c;
  c.yfov = yfov;
  c.to_world = mat4(vec4(1, 0, 0, 0), vec4(0, 0, -1, 0), vec4(0, 1, 0, 0), vec4(eye, 1));
  return c;
}

/// A room of four metres with a block in it and a lamp under its ceiling; its cameras are "front" and,
/// looking down, "above". `open`: an uneven environment instead of a ceiling, and the block has material 1,
/// which can be emissive.
inline scene::Scene block_room(bool open = false) {
  scene::Scene s;
  s.name = "room", s.file = "room.gltf";
  s.materials = {diffuse({0.7f, 0.6f, 0.5f})};
  if (open) s.materials.push_back(diffuse({0.2f, 0.5f, 0.8f})), s.materials[1].double_sided = true;
  add_box(s, {-2, 0, -2}, {2, 2.5f, 2}, 0, open);
  add_box(s, {-0.5f, 0, -1}, {0.5f, 1, 0}, open ? 1 : 0);
  s.lights.push_back({.name = "lamp", .intensity = vec3(5), .position = {1, 2, 1}});
  scene::Camera front;
  front.name = "front", front.yfov = 1.3f, front.to_world[3] = vec4(0, 1.5f, 1.9f, 1);
  s.cameras = {front, looking_down({-1, 2.2f, -1}, 1.3f)};
  s.cameras[1].name = "above";
  s.environment.given = true;
  if (!open) return s;
  scene::Image sky;
  sky.name = "sky", sky.width = 8, sky.height = 4;
  for (int i = 0; i < 32; ++i) {
    const float value = 0.2f + 0.1f * float(i % 8);
    sky.floats.insert(sky.floats.end(), {value, value, 1.5f * value, 1});
  }
  s.images.push_back(sky);
  s.environment.image = 0;
  return s;
}

/// block_room(true) with a distant lamp, the moon, straight above.
inline scene::Scene room_under_moon() {
  scene::Scene s = block_room(true);
  s.lights.push_back({.name = "moon", .kind = scene::LightKind::directional, .intensity = vec3(0.5f)});
  s.lights.back().direction = {0, -1, 0};
  return s;
}

/// A closed room of 2 x 1 x 2 m around `at`, the middle of its floor, with an emissive panel `below` the
/// ceiling's right half; the camera is under the ceiling and looks down: right is +x, up in the picture -z.
/// Its materials: 0 walls, 1 panel; its meshes: floor, ceiling, back, front, left, right, panel.
struct PanelRoom {
  scene::Scene s;
  vec3 at;
  explicit PanelRoom(const vec3& place = vec3(0), bool lit = true, float below = 0.01f) : at(place) {
    s.name = "room", s.file = "room.gltf";
    s.materials = {diffuse(vec3(0.7f)), diffuse(vec3(0), vec3(lit ? 10.0f : 0.0f))};
    s.environment.given = true;
    const vec3 x(2, 0, 0), y(0, 1, 0), z(0, 0, 2), o(-1, 0, -1);
    quad(o, z, x), quad(o + y, x, z);
    quad(o, x, y), quad(o + z, y, x);
    quad(o, y, z), quad(o + x, z, y);
    quad({0.3f, 1 - below, -0.5f}, {0.6f, 0, 0}, {0, 0, 1}, 1);
    s.cameras = {looking_down(at + vec3(0, 0.98f, 0), 1.4f)};
  }
  void quad(const vec3& a, const vec3& u, const vec3& v, uint32_t material = 0) {
    add_quad(s, at + a, u, v, material);
  }
  /// A wall in the middle, from z0 to z1 and up to `height`, of that thickness; 0 gives a single sheet.
  void wall(float z0, float z1, float height, float thickness) {
    const vec3 w(0, 0, z1), z(0, 0, z0 - z1), h(0, height, 0), t(thickness / 2, 0, 0);
    quad(w - t, h, z);
    if (thickness <= 0) return;
    quad(w + t, z, h);
    quad(w + h - t, 2.0f * t, z);
    quad(vec3(0, 0, z1) - t, 2.0f * t, h), quad(vec3(0, 0, z0) - t, h, 2.0f * t);
  }
};

/// That room with another wall in front of its back wall, which fills the camera's view and has material 2
/// with a normal map of 8 x 8 texels: a quarter of them untilted, the others tilted by `degrees` in different
/// directions.
inline scene::Scene mapped_room(float degrees) {
  PanelRoom room;
  scene::Scene& s = room.s;
  scene::Image map;
  map.name = "tilted", map.width = map.height = 8;
  const float tilt = degrees * k_pi / 180;
  for (int i = 0; i < 64; ++i) {
    const int kind = i % 2 + 2 * (i / 8 % 2), turn = (i / 2 + i / 16) % 4;
    const float a = turn * k_pi / 2 + 0.4f, t = kind == 0 ? 0 : tilt;
    const vec3 n(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
    for (int k = 0; k < 3; ++k) map.bytes.push_back(uint8_t(std::lround(127.5f * n[k] + 127.5f)));
    map.bytes.push_back(255);
  }
  s.images = {map};
  s.textures = {{.image = 0, .nearest = true}};
  s.materials.push_back(s.materials[0]);
  s.materials.back().normal_texture.texture = 0;
  room.quad({-0.99f, 0.01f, -0.98f}, {1.98f, 0, 0}, {0, 0.98f, 0}, 2);
  s.cameras[0].to_world = mat4(1);
  s.cameras[0].to_world[3] = vec4(0, 0.5f, 0.2f, 1);
  s.cameras[0].yfov = 0.7f;
  return s;
}

}  // namespace lucerna::test
