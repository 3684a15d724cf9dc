// links: scene
// Openings of rooms, found from rays: their places and sizes, and rooms without any.
#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "scene/openings.h"

namespace openings_tests {

using namespace lucerna;
using namespace lucerna::scene;

namespace {

const std::vector<vec3> k_axes{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

struct Hole {
  int axis;     // of the wall's normal
  bool high;    // of the two walls
  vec3 lo, hi;  // in the wall; along the axis not used
};

/// Rays from all over a box-shaped room from 0 to `size`, each in an even direction.
std::vector<RoomRay> rays_in(const vec3& size, const std::vector<Hole>& holes) {
  std::mt19937 random(7);
  const auto u = [&] { return float(random() >> 8) * 0x1p-24f; };
  std::vector<RoomRay> rays;
  for (int point = 0; point < 256; ++point) {
    const vec3 origin = size * vec3(0.01f + 0.98f * u(), 0.01f + 0.98f * u(), 0.01f + 0.98f * u());
    for (int i = 0; i < 256; ++i) {
      const float z = 2 * u() - 1, phi = 2 * std::numbers::pi_v<float> * u(), r = std::sqrt(1 - z * z);
      RoomRay ray{origin, {r * std::cos(phi), r * std::sin(phi), z}};
      int axis = 0;
      float nearest = k_infinity;
      for (int k = 0; k < 3; ++k) {
        const float t = ((ray.direction[k] > 0 ? size[k] : 0) - origin[k]) / ray.direction[k];
        if (t < nearest) nearest = t, axis = k;
      }
      const vec3 p = origin + nearest * ray.direction;
      for (const Hole& hole : holes) {
        bool in = hole.axis == axis && hole.high == (ray.direction[axis] > 0);
        for (int k = 0; k < 3; ++k) in &= k == axis || (p[k] > hole.lo[k] && p[k] < hole.hi[k]);
        ray.escapes |= in;
      }
      rays.push_back(ray);
    }
  }
  return rays;
}

/// The portal is the hole of that wall, and lights into the room.
void check_is(const Portal& portal, const Hole& hole, const vec3& size) {
  vec3 normal(0), lo = hole.lo, hi = hole.hi;
  normal[hole.axis] = hole.high ? -1.f : 1.f;
  lo[hole.axis] = hi[hole.axis] = hole.high ? size[hole.axis] : 0;
  CHECK(glm::dot(normal_of(portal), normal) > 0.999f);
  const vec3 half = glm::abs(portal.half_width) + glm::abs(portal.half_height);
  for (int k = 0; k < 3; ++k) {
    INFO("axis " << k << " from " << portal.centre[k] - half[k] << " to " << portal.centre[k] + half[k]);
    const float tolerance = k == hole.axis ? 0.01f : 0.05f;
    CHECK(std::abs(portal.centre[k] - half[k] - lo[k]) < tolerance);
    CHECK(std::abs(portal.centre[k] + half[k] - hi[k]) < tolerance);
  }
}

constexpr vec3 k_room{6, 3, 5};
const Hole k_window{0, true, {0, 1, 1}, {0, 2, 2.5f}};

}  // namespace

TEST_CASE("a window is found in its wall") {
  const auto found = find_openings(rays_in(k_room, {k_window}), k_axes);
  REQUIRE(found.size() == 1);
  check_is(found[0].portal, k_window, k_room);
  CHECK(found[0].share > 0.95);
}

TEST_CASE("two windows of one wall are two openings, the larger first") {
  const Hole small{0, true, {0, 1, 3.5f}, {0, 2, 4.5f}};
  const auto found = find_openings(rays_in(k_room, {small, k_window}), k_axes);
  REQUIRE(found.size() == 2);
  check_is(found[0].portal, k_window, k_room);
  check_is(found[1].portal, small, k_room);
  CHECK(found[0].share > found[1].share);
}

TEST_CASE("a small opening beside a large one is left out") {
  const Hole slot{0, true, {0, 2.2f, 3.5f}, {0, 2.5f, 3.9f}};
  auto found = find_openings(rays_in(k_room, {slot, k_window}), k_axes);
  REQUIRE(found.size() == 1);
  check_is(found[0].portal, k_window, k_room);
  // Alone, it is an opening.
  found = find_openings(rays_in(k_room, {slot}), k_axes);
  REQUIRE(found.size() == 1);
  check_is(found[0].portal, slot, k_room);
}

TEST_CASE("two windows with half a metre between them are two openings") {
  const Hole beside{0, true, {0, 1, 3}, {0, 2, 4.5f}};
  const auto found = find_openings(rays_in(k_room, {k_window, beside}), k_axes);
  REQUIRE(found.size() == 2);
  const bool first = found[0].portal.centre.z < 2.75f;
  check_is(found[first ? 0 : 1].portal, k_window, k_room);
  check_is(found[first ? 1 : 0].portal, beside, k_room);
}

TEST_CASE("a point in a gap of a wall is no opening") {
  std::vector<RoomRay> rays = rays_in(k_room, {k_window});
  for (size_t i = 0; i < 1024; ++i) {
    const float angle = 0.1f * float(i);
    rays.push_back(
        {{3, 0.01f, 2.5f}, glm::normalize(vec3(std::cos(angle), -1, 0.001f * float(i) - 0.5f)), true});
  }
  const auto found = find_openings(rays, k_axes);
  REQUIRE(found.size() == 1);
  check_is(found[0].portal, k_window, k_room);
}

TEST_CASE("a skylight and a door in other walls are found together") {
  const Hole skylight{1, true, {2, 0, 2}, {4, 0, 3}}, door{2, false, {4, 0, 0}, {5, 2, 0}};
  const auto found = find_openings(rays_in(k_room, {skylight, door}), k_axes);
  REQUIRE(found.size() == 2);
  const bool first = normal_of(found[0].portal).y < -0.9f;
  check_is(found[first ? 0 : 1].portal, skylight, k_room);
  check_is(found[first ? 1 : 0].portal, door, k_room);
}

TEST_CASE("openings are found in slanted walls") {
  // The room turned about y; axes of the scene come after its walls.
  const float c = std::cos(0.5f), s = std::sin(0.5f);
  const auto turned = [&](const vec3& v) { return vec3(c * v.x - s * v.z, v.y, s * v.x + c * v.z); };
  std::vector<RoomRay> rays = rays_in(k_room, {k_window});
  for (RoomRay& ray : rays) ray.origin = turned(ray.origin), ray.direction = turned(ray.direction);
  std::vector<vec3> walls;
  for (const vec3& axis : k_axes) walls.push_back(turned(axis));
  walls.insert(walls.end(), k_axes.begin(), k_axes.end());
  const auto found = find_openings(rays, walls);
  REQUIRE(found.size() == 1);
  CHECK(glm::dot(normal_of(found[0].portal), turned({-1, 0, 0})) > 0.999f);
  CHECK(glm::length(found[0].portal.centre - turned({6, 1.5f, 1.75f})) < 0.15f);
  CHECK(area_of(found[0].portal) == Approx(1.5).margin(0.3));
}

TEST_CASE("closed rooms, open air and no rays have no openings") {
  CHECK(find_openings(rays_in(k_room, {}), k_axes).empty());
  CHECK(find_openings({}, k_axes).empty());
  CHECK(find_openings(rays_in(k_room, {k_window}), {}).empty());
  // A low wall around a wide courtyard.
  const vec3 yard(20, 0.5f, 20);
  std::vector<RoomRay> rays = rays_in(yard, {{1, true, {0, 0, 0}, yard}});
  for (RoomRay& ray : rays)
    ray.direction.y = std::abs(ray.direction.y), ray.escapes |= ray.direction.y > 0.1f;
  CHECK(find_openings(rays, k_axes).empty());
  for (RoomRay& ray : rays) ray.escapes = true;
  CHECK(find_openings(rays, k_axes).empty());
}

TEST_CASE("rays of one point, or of one direction, are no openings") {
  std::vector<RoomRay> rays = rays_in(k_room, {k_window});
  for (RoomRay& ray : rays) ray.origin = vec3(1);
  CHECK(find_openings(rays, k_axes).empty());
  for (RoomRay& ray : rays) ray.direction = {1, 0, 0}, ray.escapes = true;
  CHECK(find_openings(rays, k_axes).empty());
}

}  // namespace openings_tests
