// links: scene
// When an edit scales all light by a factor, and by which.
#include <catch2/catch.hpp>

#include "scene/light_factor.h"

namespace scene_light_factor_tests {

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

std::optional<vec3> light_factor(const Scene& before, const Scene& after) {
  const auto factors = light_factors(before, after);
  return factors ? std::optional(factors->at(0)) : std::nullopt;
}

/// With one triangle of every material.
Scene shining(std::vector<vec3> emission, std::vector<vec3> lamps = {}) {
  Scene s = lit(std::move(lamps));
  s.materials.assign(emission.size(), {});
  s.meshes.emplace_back();
  for (Id m = 0; m < emission.size(); ++m) {
    s.materials[m].emission = emission[m];
    s.meshes[0].primitives.emplace_back().material = m;
  }
  s.instances.emplace_back().mesh = 0;
  return s;
}

}  // namespace

TEST_CASE("strength and colour of the only lamp are factors of all light") {
  CHECK(light_factor(lit({vec3(2)}), lit({vec3(5)})) == vec3(2.5f));
  CHECK(light_factor(lit({{1, 2, 4}}), lit({{2, 1, 0}})) == vec3(2, 0.5f, 0));
  CHECK_FALSE(light_factor(lit({{1, 0, 1}}), lit({{1, 1, 1}})));  // a colour that was absent before
  CHECK(light_factor(lit({{1, 0, 1}}), lit({{2, 0, 2}})) == vec3(2, 1, 2));
  Scene off = lit({vec3(3)});
  off.lights[0].enabled = false;
  CHECK(light_factor(lit({vec3(3)}), off) == vec3(0));
  CHECK_FALSE(light_factor(off, lit({vec3(3)})));
  // A lamp that is off does not matter.
  Scene two = lit({vec3(3), vec3(9)}), brighter = lit({vec3(6), vec3(7)});
  two.lights[1].enabled = brighter.lights[1].enabled = false;
  CHECK(light_factor(two, brighter) == vec3(2));
}

TEST_CASE("with several emitters, or one that moves, there is no factor") {
  CHECK_FALSE(light_factor(lit({vec3(1), vec3(1)}), lit({vec3(2), vec3(1)})));
  CHECK_FALSE(light_factor(lit({vec3(1)}, 1), lit({vec3(2)}, 1)));
  CHECK(light_factor(lit({vec3(1), vec3(3)}, 2), lit({vec3(2), vec3(6)}, 4)) == vec3(2));
  Scene moved = lit({vec3(1)});
  moved.lights[0].position.x = 1;
  CHECK_FALSE(light_factor(lit({vec3(1)}), moved));
  for (const auto& shine :
       {+[](Material& m) { m.emission = vec3(1); }, +[](Material& m) { m.unlit = true; }}) {
    Scene before = shining({vec3(0)}, {vec3(1)}), after = shining({vec3(0)}, {vec3(2)});
    shine(before.materials[0]), shine(after.materials[0]);
    CHECK_FALSE(light_factor(before, after));
  }
}

TEST_CASE("scaling the environment gives a factor, rotating it does not") {
  CHECK(light_factor(lit({}, 2), lit({}, 3)) == vec3(1.5f));
  CHECK(light_factor(lit({vec3(0)}, 2), lit({vec3(0)}, 1)) == vec3(0.5f));
  CHECK_FALSE(light_factor(lit({}, 0), lit({}, 1)));
  Scene turned = lit({}, 2);
  turned.environment.rotation = 10;
  CHECK_FALSE(light_factor(lit({}, 2), turned));
  CHECK_FALSE(light_factor(lit({}), lit({})));
}

TEST_CASE("emissive surfaces count as lights; other surfaces must not change") {
  CHECK(light_factor(shining({vec3(2), vec3(0)}), shining({vec3(1), vec3(0)})) == vec3(0.5f));
  CHECK(light_factor(shining({vec3(2), vec3(4)}), shining({vec3(1), vec3(2)})) == vec3(0.5f));
  CHECK_FALSE(light_factor(shining({vec3(2), vec3(4)}), shining({vec3(1), vec3(4)})));
  CHECK_FALSE(light_factor(shining({vec3(2), vec3(0)}), shining({vec3(2), vec3(1)})));
  CHECK(light_factor(shining({vec3(2)}, {vec3(3)}), shining({vec3(1)}, {vec3(1.5f)})) == vec3(0.5f));
  Scene red = shining({vec3(2), vec3(0)});
  red.materials[1].base_color = vec4(1, 0, 0, 1);
  CHECK_FALSE(light_factor(shining({vec3(2), vec3(0)}), red));
}

TEST_CASE("by light groups each has its own factor") {
  Scene before = shining({vec3(2), vec3(0), vec3(8)}, {vec3(1), vec3(5)});
  before.materials[0].name = "panel", before.materials[2].name = "strip";
  before.lights[0].name = "spot.001", before.lights[1].name = "spot.002";
  before.environment.radiance = vec3(1), before.environment.scale = 2;
  const LightGroups groups = group_lights(before);
  REQUIRE(groups.groups.size() == 4);
  const auto of = [&](const std::optional<std::vector<vec3>>& factors, const char* name) {
    return factors->at(groups.find(name));
  };
  Scene after = before;
  after.materials[2].emission = vec3(2);
  after.environment.scale = 6;
  after.lights[0].intensity = vec3(2), after.lights[1].intensity = vec3(10);
  const auto factors = light_factors(before, after, &groups);
  REQUIRE(factors);
  CHECK(of(factors, "panel") == vec3(1));
  CHECK(of(factors, "strip") == vec3(0.25f));
  CHECK(of(factors, "sky") == vec3(3));
  CHECK(of(factors, "spot") == vec3(2));
  CHECK_FALSE(common_factor(*factors));
  CHECK_FALSE(light_factors(before, after));
  after.lights[1].intensity = vec3(5);  // one of two in a group
  CHECK_FALSE(light_factors(before, after, &groups));
  after = before;
  CHECK(common_factor(*light_factors(before, after, &groups)) == vec3(1));
}

}  // namespace scene_light_factor_tests
