// links: plan
// The plan: which solver computes each component, and which light none can find. Also default light for
// scenes without lights.
#include <catch2/catch.hpp>
#include <cmath>

#include "plan/plan.h"
#include "scene/default_light.h"

namespace plan_tests {

using namespace lucerna;

namespace {

scene::Scene one_triangle() {
  scene::Scene s;
  s.file = "one.gltf";
  s.materials.resize(1);
  scene::Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.triangles = {{0, 1, 2}};
  s.meshes = {{"mesh", {p}}};
  s.instances = {{"node", 0, mat4(1), false}};
  return s;
}

plan::Plan make_plan(const plan::Settings& settings) {
  static const plan::SceneFacts facts = plan::facts_of(one_triangle());
  return plan::make_plan(facts, settings);
}

}  // namespace

TEST_CASE("every component has one solver of the registry, or none") {
  plan::Settings settings;
  CHECK(make_plan(settings).enabled() == 15);
  settings.set("components.secondary", "off");
  const plan::Plan p = make_plan(settings);
  CHECK(p.enabled() == 13);
  CHECK(p.solver[1] == nullptr);
  REQUIRE(p.solver[0] != nullptr);
  CHECK(p.solver[0]->name == "path");
  // A component that is off has a bias of zero; a solver without an estimate has none.
  CHECK(p.bias(0) == 0.0);
  CHECK_FALSE(p.bias(1).has_value());
  solvers::SolverInfo reuses{
      .name = "reuses", .serves = {true, true, true, true}, .primary_part = "", .looked_up = true};
  plan::Plan biased;
  biased.solver[2] = &reuses;
  CHECK_FALSE(biased.bias(2).has_value());
  // The settings offer the solvers that the registry has for the component.
  for (const int c : k_components) {
    const auto* option = plan::find_option(std::string("components.") + paths::k_component_names[c]);
    REQUIRE(option != nullptr);
    size_t served = 0;
    for (const solvers::SolverInfo* info : solvers::registered()) served += info->serves[c];
    CHECK(option->choices.size() == served + 2 + (c == 3));  // auto, off; light+photons
    CHECK(option->choices.back() == "off");
  }
}

TEST_CASE(
    "a solver of primary light that needs lookups of secondary light is replaced by paths without them") {
  plan::Settings settings;
  const auto primary = [&] { return make_plan(settings).solver[0]->name; };
  settings.set("components.primary", "cache");
  CHECK(primary() == "path");
  settings.set("components.secondary", "cache");
  CHECK(primary() == "cache");
  settings.set("components.secondary", "off");
  CHECK(primary() == "path");  // tertiary light is path traced
  settings.set("components.tertiary", "cache");
  CHECK(primary() == "cache");
  settings.set("components.primary", "photons");
  settings.set("components.secondary", "path");
  CHECK(primary() == "photons");
}

TEST_CASE("light that the chosen solvers cannot find causes a warning, and nothing else does") {
  const plan::Plan p = make_plan({});
  scene::Scene s = one_triangle();
  CHECK(plan::unreachable_light(p, s).empty());
  s.lights.resize(2);
  CHECK(plan::unreachable_light(p, s).empty());
  // Rough surfaces scatter light where camera paths can sample it.
  s.materials[0].transmission = 1, s.materials[0].thickness = 0.1f;
  CHECK(plan::unreachable_light(p, s).empty());
  // Glass, a mirror, varnish.
  s.materials[0].roughness = 0;
  REQUIRE(plan::unreachable_light(p, s).size() == 1);
  CHECK(plan::unreachable_light(p, s)[0].find("one.gltf: tertiary and caustic light") == 0);
  // Paths can hit a lamp with a size, unless it is invisible to them.
  for (scene::Light& light : s.lights) light.kind = scene::LightKind::sphere;
  CHECK(plan::unreachable_light(p, s).empty());
  s.lights[1].visible = false;
  REQUIRE(plan::unreachable_light(p, s).size() == 1);
  CHECK(plan::unreachable_light(p, s)[0].find("the light of 1 lamp") != std::string::npos);
  for (scene::Light& light : s.lights) light = {};
  s.materials[0].transmission = 0, s.materials[0].thickness = 0, s.materials[0].metallic = 1;
  CHECK(plan::unreachable_light(p, s).size() == 1);
  s.materials[0].metallic = 0;
  CHECK(plan::unreachable_light(p, s).size() == 1);
  s.materials[0].specular = 0;
  CHECK(plan::unreachable_light(p, s).empty());
  s.materials[0].specular = 1;
  // A polished material that no surface uses.
  scene::Scene unused = s;
  unused.materials.insert(unused.materials.begin(), scene::Material{});
  unused.materials[0].roughness = 1;
  CHECK(plan::unreachable_light(p, unused).empty());
  // Components that are off cause no warning.
  plan::Settings some;
  for (const char* key : {"components.primary", "components.tertiary"}) some.set(key, "off");
  REQUIRE(plan::unreachable_light(make_plan(some), s).size() == 1);
  CHECK(plan::unreachable_light(make_plan(some), s)[0].find("tertiary") == std::string::npos);
  some.set("components.caustic", "off");
  CHECK(plan::unreachable_light(make_plan(some), s).empty());
  // Photons find it, for the components that they compute.
  plan::Settings photons;
  photons.set("components.caustic", "photons");
  REQUIRE(plan::unreachable_light(make_plan(photons), s).size() == 1);
  CHECK(plan::unreachable_light(make_plan(photons), s)[0].find("one.gltf: tertiary light") == 0);
  photons.set("components.tertiary", "photons");
  CHECK(plan::unreachable_light(make_plan(photons), s).empty());
  photons.set("components.caustic", "light+photons");
  CHECK(plan::unreachable_light(make_plan(photons), s).empty());
  photons.set("components.caustic", "light");  // except for its mirror images
  REQUIRE(plan::unreachable_light(make_plan(photons), s).size() == 1);
  CHECK(plan::unreachable_light(make_plan(photons), s)[0].find("light+photons") != std::string::npos);
  for (scene::Light& l : s.lights) l.enabled = false;
  CHECK(plan::unreachable_light(p, s).empty());
}

TEST_CASE("a scene without light gets a studio with a message; a scene with any light keeps its own") {
  scene::Scene dark = one_triangle();
  CHECK_FALSE(scene::has_light(dark));
  REQUIRE(scene::add_default_light(dark));
  CHECK(scene::has_light(dark));
  CHECK(dark.warnings.size() == 1);
  REQUIRE(dark.environment.image != scene::k_none);
  const scene::Image& image = dark.images[dark.environment.image];
  CHECK(image.floats.size() == size_t(image.width) * image.height * 4);
  for (const float f : image.floats) CHECK((std::isfinite(f) && f >= 0));
  CHECK_FALSE(scene::add_default_light(dark));  // only once

  scene::Scene lamp = one_triangle();
  lamp.lights.resize(1);
  CHECK_FALSE(scene::add_default_light(lamp));
  scene::Scene emissive = one_triangle();
  emissive.materials[0].emission = vec3(0, 0, 1);
  CHECK_FALSE(scene::add_default_light(emissive));
  scene::Scene display = one_triangle();
  display.materials[0].emission = vec3(1);
  display.materials[0].emission_texture.texture = 0;
  CHECK(scene::add_default_light(display));
  scene::Scene sky = one_triangle();
  sky.environment.radiance = vec3(0.1f);
  CHECK_FALSE(scene::add_default_light(sky));
  scene::Scene black = one_triangle();
  black.environment.given = true;  // black on purpose
  CHECK_FALSE(scene::add_default_light(black));
  scene::Scene unlit = one_triangle();
  unlit.materials[0].unlit = true;
  CHECK_FALSE(scene::add_default_light(unlit));
}

TEST_CASE("two solvers joined by a plus share a component, and both are used") {
  plan::Settings settings;
  settings.set("components.caustic", "light+photons");
  const plan::Plan both = make_plan(settings);
  const solvers::SolverInfo &light = *solvers::find("light"), &photons = *solvers::find("photons");
  CHECK(both.components_of(light) == 0b1000);
  CHECK(both.components_of(photons) == 0b1000);
  CHECK(both.rests_of(light) == 0);
  CHECK(both.rests_of(photons) == 0b1000);
  CHECK(both.at_work().size() == 3);
  CHECK_FALSE(both.bias(3).has_value());  // that of photons
  settings.set("components.caustic", "light");
  CHECK(make_plan(settings).bias(3) == 0.0);
  CHECK_THROWS_WITH(settings.set("components.caustic", "photons+light"), Catch::Contains("light+photons"));
  CHECK_THROWS(settings.set("components.secondary", "light"));
  CHECK(solvers::chooses("light+photons", "light"));
  CHECK(solvers::chooses("light+photons", "photons"));
  CHECK(solvers::chooses("light", "light"));
  CHECK_FALSE(solvers::chooses("light+photons", "path"));
  CHECK_FALSE(solvers::chooses("path", "light"));
}

}  // namespace plan_tests
