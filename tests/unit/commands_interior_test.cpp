// links: commands
// Navigation in rooms: walls stop the camera, which slides along them; stairs can be climbed; tables are no
// floor; framing stays in front of walls; orbiting keeps the point under the pointer.
#include "commands/interior.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/core.h"
#include "session/pick.h"

namespace commands_interior_tests {

using namespace lucerna;
using namespace lucerna::commands;

namespace {

void add_box(scene::Scene& s, const vec3& lo, const vec3& hi) {
  scene::Primitive p;
  for (int i = 0; i < 8; ++i)
    p.positions.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
  p.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  p.material = static_cast<scene::Id>(s.materials.size());
  s.materials.emplace_back();
  s.instances.push_back({.name = "", .mesh = static_cast<scene::Id>(s.meshes.size())});
  s.meshes.push_back({.name = "", .primitives = {p}});
}

/// A room of 8 x 3 x 6 metres around the origin, with walls of 0.2 m; inside a dividing wall with a passage
/// at z > 1, a table, and stairs of five steps along +z in the corner at +x.
struct Room {
  scene::Scene scene;
  std::unique_ptr<session::Probe> probe;
  enum : uint32_t { floor, ceiling, west, east, north, south, across, table };
  /// `far`: adds a wall at that distance, if not 0.
  explicit Room(float far = 0) {
    add_box(scene, {-4.2f, -0.2f, -3.2f}, {4.2f, 0, 3.2f});
    add_box(scene, {-4.2f, 3, -3.2f}, {4.2f, 3.2f, 3.2f});
    add_box(scene, {-4.2f, 0, -3.2f}, {-4, 3, 3.2f});
    add_box(scene, {4, 0, -3.2f}, {4.2f, 3, 3.2f});
    add_box(scene, {-4, 0, -3.2f}, {4, 3, -3});
    add_box(scene, {-4, 0, 3}, {4, 3, 3.2f});
    add_box(scene, {0, 0, -3}, {0.2f, 3, 1});
    add_box(scene, {-2.5f, 0.7f, -1}, {-1.5f, 0.75f, 1});
    for (int i = 0; i < 5; ++i) {
      const float z = -1.5f + 0.3f * static_cast<float>(i);
      add_box(scene, {3, 0, z}, {4, 0.18f * static_cast<float>(i + 1), z + 0.3f});
    }
    if (far > 0) add_box(scene, {far, -far, 0}, {far + 1, far, far});
    probe = std::make_unique<session::Probe>(std::make_shared<scene::Scene>(scene));
  }
  Look look(uint32_t but = ~0u) const {
    return [this, but](const vec3& o, const vec3& d, float limit) -> std::optional<Obstacle> {
      const auto hit =
          probe->nearest(o, d, limit, [&](const session::Picked& p) { return p.instance != but; });
      if (!hit) return std::nullopt;
      return Obstacle{hit->distance, hit->normal};
    };
  }
  Viewpoint view(const vec3& eye, const vec3& target) const {
    scene::Camera camera;
    camera.to_world = glm::inverse(glm::lookAt(eye, target, vec3(0, 1, 0)));
    camera.yfov = 1;
    return make_viewpoint(camera, scene::core_bounds(scene));
  }
};

Box box_of(const vec3& lo, const vec3& hi) {
  Box box;
  box.grow(lo), box.grow(hi);
  return box;
}

void walk_far(Viewpoint& v, const Look& look, const vec2& metres, bool through = false) {
  for (int i = 0; i < 100; ++i) walk(v, look, metres / 100.0f, k_eye_height, through);
}

}  // namespace

TEST_CASE("walking stays on the floor, stops in front of a wall, and slides along it") {
  const Room room;
  Viewpoint v = room.view({-3, 1.65f, 2}, {-3, 1.2f, -2});  // looks slightly down, to the north
  walk_far(v, room.look(), {0, 9});
  CHECK(eye_of(v.camera).z == Approx(-3 + clearance(v.extent)).margin(0.01));
  CHECK(eye_of(v.camera).y == Approx(1.65).margin(1e-3));
  CHECK(eye_of(v.camera).x == Approx(-3).margin(1e-3));
  // At an angle: only the part along the wall is walked.
  walk_far(v, room.look(), {2, 2});
  CHECK(eye_of(v.camera).x == Approx(-1).margin(0.02));
  CHECK(eye_of(v.camera).z >= -3 + 0.9f * clearance(v.extent));
  // A corner stops the walk.
  walk_far(v, room.look(), {9, 9});
  CHECK(eye_of(v.camera).x == Approx(-clearance(v.extent)).margin(0.02));
  CHECK(eye_of(v.camera).z >= -3 + 0.9f * clearance(v.extent));
  // A step larger than the room does not cross its wall,
  Viewpoint leap = room.view({-3, 1.65f, 2}, {-3, 1.65f, -2});
  CHECK(walk(leap, room.look(), {0, 100}, k_eye_height, false));
  CHECK(eye_of(leap.camera).z > -3);
  // except with collisions off.
  CHECK_FALSE(walk(leap, room.look(), {0, 100}, k_eye_height, true));
  CHECK(eye_of(leap.camera).z < -90);
}

TEST_CASE("stairs can be climbed in both directions; walking crosses a table's place below it, not on top") {
  const Room room;
  Viewpoint v = room.view({3.5f, 1.65f, -2.5f}, {3.5f, 1.65f, 2});  // to the south, up the stairs
  float highest = 0;
  for (int i = 0; i < 200; ++i) {
    walk(v, room.look(), {0, 0.012f}, k_eye_height, false);
    highest = std::max(highest, eye_of(v.camera).y);
  }
  CHECK(highest == Approx(1.65f + 5 * 0.18f).margin(1e-3));
  walk_far(v, room.look(), {0, 2});
  CHECK(eye_of(v.camera).y == Approx(1.65f).margin(1e-3));  // over the edge, on the floor again
  CHECK(eye_of(v.camera).z > 1.5f);

  v = room.view({-2, 1.65f, 2}, {-2, 1.65f, -2});
  for (int i = 0; i < 300; ++i) {
    walk(v, room.look(), {0, 0.01f}, k_eye_height, false);
    REQUIRE(eye_of(v.camera).y == Approx(1.65f).margin(1e-3));
  }
  CHECK(eye_of(v.camera).z == Approx(-1).margin(0.01));
  // Without a floor the height stays.
  Viewpoint outside = room.view({20, 1.65f, 0}, {20, 1, -5});
  walk_far(outside, room.look(), {0, 3});
  CHECK(eye_of(outside.camera).y == Approx(1.65f));
  CHECK(floor_below(room.look(), {-2, 1.65f, 0}, 0.8f, 5) == Approx(0.9f).margin(1e-3));  // the table
  CHECK(floor_below(room.look(), {-2, 1.65f, 0}, 1.25f, 5) ==
        Approx(1.65f).margin(1e-3));  // the floor under the table
  CHECK_FALSE(floor_below(room.look(), {20, 1.65f, 0}, 1, 5));
}

TEST_CASE("orbiting about a point keeps its place in the picture") {
  const Room room;
  Viewpoint v = room.view({-3, 1.65f, 2}, {-2, 1, -2});
  const vec3 point(-2.2f, 0.75f, 0.4f);
  const auto seen = [&] { return vec3(glm::inverse(v.camera.to_world) * vec4(point, 1)); };
  const vec3 before = seen();
  for (int i = 0; i < 40; ++i) orbit_about(v, point, {0.05f, i < 20 ? 0.02f : -0.03f});
  CHECK(glm::length(seen() - before) < 1e-3f);
  CHECK(v.distance == Approx(-before.z).epsilon(1e-3));
  CHECK(std::abs(up_of(v.camera).y) > 0.3f);
  CHECK(right_of(v.camera).y == Approx(0).margin(1e-4));  // the horizon stays level
  for (int i = 0; i < 100; ++i) orbit_about(v, point, {0, 0.2f});
  CHECK(forward_of(v.camera).y == Approx(-std::sin(89 * k_pi / 180)).margin(1e-3));
}

TEST_CASE("moving closer goes towards the point, and always makes progress") {
  const Room room;
  Viewpoint v = room.view({-3, 1.65f, 2}, {-2, 1, -2});
  const vec3 point(-2.2f, 0.75f, 0.4f), from = eye_of(v.camera), ahead = forward_of(v.camera);
  dolly_towards(v, point, 1);
  CHECK(glm::length(eye_of(v.camera) - glm::mix(from, point, 0.1f)) < 1e-4f);
  CHECK(forward_of(v.camera) == ahead);
  dolly_towards(v, point, -1);
  CHECK(glm::length(eye_of(v.camera) - from) < 1e-3f);
  for (int i = 0; i < 200; ++i) dolly_towards(v, point, 1);
  CHECK(glm::length(eye_of(v.camera) - point) < 0.1f);
}

TEST_CASE("framing never ends behind a wall or inside one") {
  const Room room;
  const auto free_between = [&](const Viewpoint& v, const vec3& centre, uint32_t but) {
    const vec3 way = centre - eye_of(v.camera);
    return !room.look(but)(eye_of(v.camera), glm::normalize(way), glm::length(way) * 0.999f);
  };
  const auto inside = [](const vec3& p) {
    return std::abs(p.x) < 4 && p.y > 0 && p.y < 3 && std::abs(p.z) < 3;
  };
  const Box table = box_of({-2.5f, 0.7f, -1}, {-1.5f, 0.75f, 1});
  for (int i = 0; i < 72; ++i) {
    INFO(i);
    const float a = static_cast<float>(i) * k_pi / 36;
    Viewpoint v = room.view(
        {-2 + 0.5f * std::cos(a), 1.4f + 0.01f * static_cast<float>(i), 0.5f * std::sin(a)}, {-2, 0.72f, 0});
    frame_clear(v, table, 1.5f, room.look(Room::table));
    CHECK(inside(eye_of(v.camera)));
    CHECK(free_between(v, table.centre(), Room::table));
    CHECK(glm::dot(glm::normalize(table.centre() - eye_of(v.camera)), forward_of(v.camera)) > 0.999f);
    CHECK(glm::length(table.centre() - eye_of(v.camera)) > 0.5f);
  }
  // With enough room it equals plain framing.
  Viewpoint a = room.view({-2, 1.5f, 0.3f}, {-2, 0.72f, 0}), b = a;
  const Box small = box_of({-2.05f, 0.75f, -0.05f}, {-1.95f, 0.8f, 0.05f});
  frame_clear(a, small, 1.5f, room.look(Room::table));
  frame(b, small, 1.5f);
  CHECK(glm::length(eye_of(a.camera) - eye_of(b.camera)) < 1e-4f);
  // The whole scene, from inside: as far back as there is room.
  Viewpoint whole = room.view({-2, 1.65f, 0}, {-3.9f, 1.65f, 0});
  CHECK(enclosed(room.look(), eye_of(whole.camera), whole.extent));
  frame_inside(whole, scene::bounds(room.scene), 1.5f, room.look());
  CHECK(inside(eye_of(whole.camera)));
  CHECK(eye_of(whole.camera).x == Approx(-clearance(whole.extent)).margin(0.01));
  CHECK_FALSE(enclosed(room.look(), {12, 1, 0}, whole.extent));
}

TEST_CASE("a far object changes neither speed, nor steps, nor framing") {
  const Room alone;
  const Look look = alone.look();
  for (const float far : {2e3f, 2e4f, 1e5f}) {
    INFO("a wall at " << far << " m");
    const Room beside(far);
    CHECK(scene::bounds(beside.scene).radius() > 100 * scene::bounds(alone.scene).radius());
    Viewpoint a = alone.view({-3, 1.65f, 2}, {-3, 1.2f, -2}), b = beside.view({-3, 1.65f, 2}, {-3, 1.2f, -2});
    CHECK(b.extent == a.extent);
    CHECK(b.distance == a.distance);
    CHECK(walking_speed(b.extent) == walking_speed(a.extent));
    walk_far(a, look, {2, 9}), walk_far(b, beside.look(), {2, 9});
    CHECK(glm::distance(eye_of(b.camera), eye_of(a.camera)) < 1e-3f);
    for (Viewpoint* v : {&a, &b}) dolly(*v, 3), dolly(*v, -5);
    CHECK(glm::distance(eye_of(b.camera), eye_of(a.camera)) < 1e-3f);
    CHECK(enclosed(beside.look(), {0, 1, 0}, b.extent));
    CHECK_FALSE(enclosed(beside.look(), {12, 1, 0}, b.extent));
    frame(a, scene::core_bounds(alone.scene), 1.5f), frame(b, scene::core_bounds(beside.scene), 1.5f);
    CHECK(b.distance == a.distance);
  }
}

}  // namespace commands_interior_tests
