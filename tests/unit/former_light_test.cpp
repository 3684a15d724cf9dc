// links: session
// A return to former light is recognized by lights, materials, sky and settings, however it came about.
#include <catch2/catch.hpp>
#include <functional>

#include "session/former_light.h"

namespace former_light_tests {

using namespace lucerna;
using session::FormerLight, session::LightState;

namespace {

LightState state() {
  auto scene = std::make_shared<scene::Scene>();
  scene->meshes.push_back({});
  scene->materials.resize(2);
  scene->lights.resize(2);
  scene->images.push_back({.name = "a.png", .width = 2, .height = 2, .bytes = {}, .floats = {}});
  return {scene, {{"components.tertiary", "path"}, {"film.ev", "0"}, {"path.max_depth", "8"}}, {}, {}};
}

LightState edited(const LightState& from, const std::function<void(scene::Scene&)>& edit) {
  LightState other = from;
  auto scene = std::make_shared<scene::Scene>(*from.scene);
  edit(*scene);
  other.scene = scene;
  return other;
}

}  // namespace

TEST_CASE("light is the same after an edit and its reverse, and after changes of its computation") {
  const LightState before = state();
  FormerLight light;
  CHECK(light.present() == 0);
  const uint64_t first = light.begin(before);
  CHECK(first == light.present());
  const LightState moved = edited(before, [](scene::Scene& s) { s.lights[1].position.x += 1; });
  const uint64_t second = light.begin(moved);
  CHECK(second != first);
  // Copies, and an image that was read again.
  CHECK(light.begin(edited(moved, [](scene::Scene& s) {
    s.lights[1].position.x -= 1;
    s.images[0].bytes = {1};
  })) == first);
  CHECK(light.begin(moved) == second);
  LightState otherwise = before;
  otherwise.settings["components.tertiary"] = "cache";
  otherwise.settings["film.ev"] = "2";
  CHECK(light.begin(otherwise) == first);
  otherwise.settings["components.tertiary"] = "off";
  CHECK(light.begin(otherwise) != first);
}

TEST_CASE("whatever changes the light makes another one") {
  const LightState before = state();
  const auto is_other = [&](const LightState& after) {
    FormerLight light;
    const uint64_t first = light.begin(before);
    return light.begin(after) != first;
  };
  CHECK(is_other(edited(before, [](scene::Scene& s) { s.lights[0].enabled = false; })));
  CHECK(is_other(edited(before, [](scene::Scene& s) { s.lights.pop_back(); })));
  CHECK(is_other(edited(before, [](scene::Scene& s) { s.materials[1].base_color.x = 0.25f; })));
  CHECK(is_other(edited(before, [](scene::Scene& s) { s.environment.scale = 2; })));
  CHECK(is_other(edited(before, [](scene::Scene& s) { s.environment.sky.emplace(); })));
  CHECK(is_other(edited(before, [](scene::Scene& s) { s.images[0].name = "b.png"; })));
  CHECK(is_other(edited(before, [](scene::Scene& s) { s.textures.push_back({}); })));
  CHECK(is_other(edited(before, [](scene::Scene& s) { s.instances.push_back({}); })));
  LightState other = before;
  other.settings["path.max_depth"] = "4";
  CHECK(is_other(other));
  other = before, other.lens.f_number = 2;
  CHECK(is_other(other));
  other = before, other.weights = {vec3(2)};
  CHECK(is_other(other));
  CHECK(is_other(state()));  // a scene that was loaded again is another one
}

TEST_CASE("states of another scene are not kept") {
  FormerLight light;
  const LightState before = state();
  const std::weak_ptr<const scene::Scene> scene = before.scene;
  light.begin(LightState(before));
  const uint64_t present = light.begin(state());
  CHECK(light.present() == present);
  CHECK(scene.use_count() == 1);
}

}  // namespace former_light_tests
