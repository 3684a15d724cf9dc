// links: ui
// Drags of an object's handles, from rays alone.
#include "ui/gizmo.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/projection.h"
#include "ui/object_handles.h"
#include "ui/surface_snap.h"

namespace gizmo_tests {

using namespace lucerna;
using namespace lucerna::ui;
using scene::ObjectPlace;

namespace {

Box unit_box() {
  Box b;
  b.grow(vec3(-1)), b.grow(vec3(1));
  return b;
}

scene::Camera camera() {
  scene::Camera c;
  c.to_world = glm::inverse(glm::lookAt(vec3(3, 4, 9), vec3(0), vec3(0, 1, 0)));
  return c;
}

/// The ray through a point of the scene.
session::PickRay at(const vec3& point) {
  const auto place = scene::place_in_picture(camera(), point, 1.5f);
  REQUIRE(place);
  return session::pick_ray(camera(), place->x, place->y, 1.5f);
}

ObjectPlace drag(GizmoMode mode, GizmoPart part, const vec3& from, const vec3& to, bool snap = false,
                 const mat4& to_world = mat4(1), const ObjectPlace& start = {}) {
  const Gizmo g = make_gizmo(mode, unit_box(), to_world, camera(), 1.5f);
  return dragged_place(g, part, start, at(from), at(to), snap);
}

void check_near(const vec3& a, const vec3& b) {
  INFO(a.x << ' ' << a.y << ' ' << a.z);
  for (int k = 0; k < 3; ++k) CHECK(a[k] == Approx(b[k]).margin(2e-3));
}

}  // namespace

TEST_CASE("arrows move along their axes, squares in their planes, the middle along the picture") {
  check_near(drag(GizmoMode::move, GizmoPart::x, {1, 0, 0}, {1.73f, 0, 0}).moved, {0.73f, 0, 0});
  check_near(drag(GizmoMode::move, GizmoPart::y, {0, 1, 0}, {0, -0.4f, 0}).moved, {0, -1.4f, 0});
  // Beside the axis, the closest point of it counts.
  const vec3 beside = drag(GizmoMode::move, GizmoPart::z, {0, 0, 1}, {0.2f, 0.3f, 2}).moved;
  CHECK(beside.x == 0);
  CHECK(beside.y == 0);
  CHECK(beside.z > 0.4f);
  check_near(drag(GizmoMode::move, GizmoPart::zx, {0.5f, 0, 0.5f}, {1, 0, -0.25f}).moved, {0.5f, 0, -0.75f});
  check_near(drag(GizmoMode::move, GizmoPart::xy, {0.5f, 0.5f, 0}, {1, 1, 0}, true).moved, {0.5f, 0.5f, 0});
  check_near(drag(GizmoMode::move, GizmoPart::x, {1, 0, 0}, {1.73f, 0, 0}, true).moved, {0.7f, 0, 0});
  const vec3 along = drag(GizmoMode::move, GizmoPart::middle, {0, 0, 0}, {1, 0, 0}).moved;
  CHECK(std::abs(glm::dot(along, glm::normalize(vec3(3, 4, 9)))) < 1e-4f);
  CHECK(along.x > 0.5f);
  // From a place.
  check_near(
      drag(GizmoMode::move, GizmoPart::x, {1, 0, 0}, {2, 0, 0}, false, mat4(1), {.moved = {5, 6, 7}}).moved,
      {6, 6, 7});
}

TEST_CASE("rings turn about the world's axes, with Ctrl in steps") {
  const auto on_ring = [](float degrees) {
    const float a = glm::radians(degrees);
    return 1.5f * vec3(std::cos(a), 0, -std::sin(a));
  };
  check_near(drag(GizmoMode::turn, GizmoPart::y, on_ring(-60), on_ring(-20)).turned, {0, 40, 0});
  check_near(drag(GizmoMode::turn, GizmoPart::y, on_ring(-60), on_ring(-20), true).turned, {0, 45, 0});
  check_near(drag(GizmoMode::turn, GizmoPart::y, on_ring(-20), on_ring(-60)).turned, {0, -40, 0});
  // After another turn, about the world's axis again.
  const ObjectPlace start{.turned = {0, 0, 90}};
  const ObjectPlace both =
      drag(GizmoMode::turn, GizmoPart::y, on_ring(-60), on_ring(30), false, mat4(1), start);
  const vec3 up(scene::rotation_of(both.turned) * glm::dvec3(1, 0, 0));
  check_near(up, {0, 1, 0});
}

TEST_CASE("arms size along the object's axes, and never to nothing") {
  const mat4 turned = glm::rotate(mat4(1), glm::radians(30.0f), vec3(0, 1, 0));
  const vec3 x(turned[0]);
  check_near(drag(GizmoMode::size, GizmoPart::x, x, 1.5f * x, false, turned).scaled, {1.5f, 1, 1});
  check_near(drag(GizmoMode::size, GizmoPart::x, x, 1.52f * x, true, turned).scaled, {1.5f, 1, 1});
  check_near(drag(GizmoMode::size, GizmoPart::x, x, 2.0f * x, false, turned, {.scaled = {-2, 1, 1}}).scaled,
             {-4, 1, 1});
  const vec3 none = drag(GizmoMode::size, GizmoPart::y, {0, 1, 0}, {0, -2, 0}).scaled;
  CHECK(none.y > 0);
  CHECK(drag(GizmoMode::size, GizmoPart::y, {0, 1, 0}, {0, -2, 0}, true).scaled.y == k_step_factor);
  const vec3 larger = drag(GizmoMode::size, GizmoPart::middle, {0, 0, 0}, {0.5f, 0.5f, 0}, false, mat4(1),
                           {.scaled = {1, 2, -3}})
                          .scaled;
  CHECK(larger.x > 1.1f);
  CHECK(larger.y == Approx(2 * larger.x));
  CHECK(larger.z == Approx(-3 * larger.x));
}

TEST_CASE("rays that determine nothing leave the object where it is") {
  const Gizmo g = make_gizmo(GizmoMode::move, unit_box(), mat4(1), camera(), 1);
  const session::PickRay along{{5, 0, 0}, {-1, 0, 0}}, nothing{{0, 0, 0}, {0, 0, 0}},
      away{{0, 5, 0}, {0, 1, 0}};
  CHECK(dragged_place(g, GizmoPart::x, {}, along, along, false) == ObjectPlace{});
  CHECK(dragged_place(g, GizmoPart::x, {}, at({1, 0, 0}), nothing, false) == ObjectPlace{});
  CHECK(dragged_place(g, GizmoPart::zx, {}, at({1, 0, 1}), away, false) == ObjectPlace{});
  CHECK(dragged_place(g, GizmoPart::zx, {}, at({1, 0, 1}), along, false) == ObjectPlace{});
}

TEST_CASE("a drag is followed at rest in quick scenes, and when it ends in slow ones") {
  RebuildTime time;
  CHECK_FALSE(time.follows(0.1));
  CHECK(time.follows(0.2));
  time.begin(5, 10);
  CHECK_FALSE(time.follows(9));  // one at a time
  time.follow(4, 10.2);
  CHECK_FALSE(time.follows(9));
  time.follow(5, 10.4);
  CHECK(time.seconds == Approx(0.4));
  CHECK_FALSE(time.follows(0.3));
  CHECK(time.follows(0.4));
  time.begin(6, 20), time.follow(7, 23);
  CHECK_FALSE(time.follows(60));
}

TEST_CASE("a snapped object touches the surface with its lowest vertex, its middle before the point") {
  scene::Mesh mesh;
  mesh.primitives.resize(1);
  mesh.primitives[0].positions = {{-1, -1, -1}, {1, 1, 1}, {-1, 1, -1}, {1, -1, 1}, {0, 0, -1}};
  const mat4 loaded = glm::translate(mat4(1), vec3(5, 2, 1));
  ObjectPlace start;
  start.moved = {0.5f, 0, 0}, start.turned = {20, 30, 40}, start.scaled = {1, 2, 0.5f};
  for (const vec3& normal : {vec3(0, 1, 0), vec3(-1, 0, 0), glm::normalize(vec3(1, 2, -3))}) {
    const SurfacePoint surface{{7, -3, 2}, normal};
    const ObjectPlace put = put_on_surface(mesh, unit_box(), loaded, start, surface);
    CHECK(put.turned == start.turned);
    CHECK(put.scaled == start.scaled);
    const mat4 to_world = scene::placed(loaded, unit_box(), put);
    float lowest = k_infinity;
    for (const vec3& v : mesh.primitives[0].positions)
      lowest = std::min(lowest, glm::dot(vec3(to_world * vec4(v, 1)) - surface.position, normal));
    CHECK(lowest == Approx(0).margin(1e-5));
    const vec3 way = scene::middle_of(unit_box(), to_world) - surface.position;
    check_near(glm::cross(way, normal), vec3(0));
    CHECK(glm::dot(way, normal) > 0.5f);
  }
  CHECK(put_on_surface({}, Box(), loaded, start, {}) == start);
}

TEST_CASE("a snapped lamp is just off the surface, with all of its shape") {
  const SurfacePoint wall{{1, 2, 3}, {1, 0, 0}};
  scene::Light lamp;
  lamp.direction = {0, 0, -1}, lamp.right = {1, 0, 0}, lamp.width = 1.2f, lamp.height = 0.4f,
  lamp.radius = 0.3f;
  const auto off = [&](scene::LightKind kind) {
    lamp.kind = kind;
    const vec3 at = lamp_on_surface(lamp, wall, 0.01f);
    CHECK(at.y == 2);
    CHECK(at.z == 3);
    return at.x - 1.01f;
  };
  using scene::LightKind;
  CHECK(off(LightKind::point) == Approx(0).margin(1e-6));
  CHECK(off(LightKind::sphere) == Approx(0.3));
  CHECK(off(LightKind::rectangle) == Approx(0.6));
  CHECK(off(LightKind::disk) == Approx(0.3));
  CHECK(off(LightKind::tube) == Approx(0.6));
  lamp.direction = {1, 0, 0}, lamp.right = {0, 0, 1};
  CHECK(off(LightKind::rectangle) == Approx(0).margin(1e-6));
  CHECK(off(LightKind::disk) == Approx(0).margin(1e-6));
  CHECK(off(LightKind::tube) == Approx(0.3));
}

}  // namespace gizmo_tests
