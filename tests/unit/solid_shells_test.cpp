// links: upload scene
// Boxes around solids that can enclose the start of a path.
#include <catch2/catch.hpp>

#include "support/rooms.h"
#include "upload/media.h"

namespace solid_shells_tests {

using namespace lucerna;

TEST_CASE("boxes of solids include the margin of their own triangles, whatever is far away") {
  scene::Scene s;
  s.materials = {{}, test::diffuse(vec3(0.5f))};
  s.materials[0].metallic = 0, s.materials[0].transmission = 1, s.materials[0].thickness = 1;
  s.materials[0].attenuation_color = {0.9f, 0.5f, 0.1f}, s.materials[0].attenuation_distance = 0.1f;
  test::add_ball(s, {0.2f, 0.1f, 0}, 0.05f, 0, 12);
  const upload::FlatScene alone = upload::flatten(s);
  REQUIRE(alone.shells != nullptr);
  REQUIRE(alone.shells->boxes.size() == 1);
  const Box box = alone.shells->boxes[0];
  CHECK(box.size().x < 0.1001f);
  test::add_quad(s, {1e5f, 0, 0}, {0, 10, 0}, {0, 0, 10}, 1);
  const upload::FlatScene beside = upload::flatten(s);
  CHECK(beside.shells->boxes[0].lo == box.lo);
  CHECK(beside.shells->boxes[0].hi == box.hi);
  CHECK(beside.shells->nodes == alone.shells->nodes);
}

}  // namespace solid_shells_tests
