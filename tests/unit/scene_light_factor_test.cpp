// links: scene
// When an edit multiplies all light by a number, and by which.
#include <catch2/catch.hpp>

#include "scene/light_factor.h"

using namespace lucerna;
using namespace lucerna::scene;

namespace {

Scene lit(std::vector<vec3> lamps, float sky = 0) {
  Scene s;
  for (const vec3& intensity : lamps) s.lights.push_back({.intensity = intensity});
  s.environment.radiance = vec3(sky > 0 ? 1 : 0), s.environment.scale = sky;
  s.materials.resize(1);
  return s;
}

}  // namespace

TEST_CASE("the only lamp's strength and colour are factors of all light") {
  CHECK(light_factor(lit({vec3(2)}), lit({vec3(5)})) == vec3(2.5f));
  CHECK(light_factor(lit({{1, 2, 4}}), lit({{2, 1, 0}})) == vec3(2, 0.5f, 0));
  CHECK_FALSE(light_factor(lit({{1, 0, 1}}), lit({{1, 1, 1}})));  // a colour that there was none of
  CHECK(light_factor(lit({{1, 0, 1}}), lit({{2, 0, 2}})) == vec3(2, 1, 2));
  Scene off = lit({vec3(3)});
  off.lights[0].enabled = false;
  CHECK(light_factor(lit({vec3(3)}), off) == vec3(0));
  CHECK_FALSE(light_factor(off, lit({vec3(3)})));
  // One that is off beside it does not matter.
  Scene two = lit({vec3(3), vec3(9)}), brighter = lit({vec3(6), vec3(7)});
  two.lights[1].enabled = brighter.lights[1].enabled = false;
  CHECK(light_factor(two, brighter) == vec3(2));
}

TEST_CASE("of several emitters, or one that moves, nothing can be said") {
  CHECK_FALSE(light_factor(lit({vec3(1), vec3(1)}), lit({vec3(2), vec3(1)})));
  CHECK_FALSE(light_factor(lit({vec3(1)}, 1), lit({vec3(2)}, 1)));
  CHECK(light_factor(lit({vec3(1), vec3(3)}, 2), lit({vec3(2), vec3(6)}, 4)) == vec3(2));
  Scene moved = lit({vec3(1)});
  moved.lights[0].position.x = 1;
  CHECK_FALSE(light_factor(lit({vec3(1)}), moved));
  for (const auto& shine :
       {+[](Material& m) { m.emission = vec3(1); }, +[](Material& m) { m.unlit = true; }}) {
    Scene before = lit({vec3(1)}), after = lit({vec3(2)});
    shine(before.materials[0]), shine(after.materials[0]);
    CHECK_FALSE(light_factor(before, after));
  }
}

TEST_CASE("the sky alone scales, and turned it does not") {
  CHECK(light_factor(lit({}, 2), lit({}, 3)) == vec3(1.5f));
  CHECK(light_factor(lit({vec3(0)}, 2), lit({vec3(0)}, 1)) == vec3(0.5f));
  CHECK_FALSE(light_factor(lit({}, 0), lit({}, 1)));
  Scene turned = lit({}, 2);
  turned.environment.rotation = 10;
  CHECK_FALSE(light_factor(lit({}, 2), turned));
  CHECK_FALSE(light_factor(lit({}), lit({})));
}
