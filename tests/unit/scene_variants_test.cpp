// links: scene scene_io plan
// Variants of materials (KHR_materials_variants) and clay.
#include <catch2/catch.hpp>

#include "plan/traced_scene.h"
#include "scene/variants.h"
#include "unit/scene_support.h"

namespace scene_variants_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

json matt(const char* name) { return {{"name", name}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}}; }

/// A triangle in oak, that can be of walnut; another without variants.
Asset cupboard() {
  Asset asset;
  asset.textured_triangle(matt("oak"));
  asset.textured_triangle(matt("plaster"));
  const int walnut = asset.add("materials", matt("walnut"));
  asset.doc["extensionsUsed"] = {"KHR_materials_variants"};
  asset.doc["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "summer"}},
                                                                   {{"name", "winter"}}};
  asset.doc["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", walnut}, {"variants", {1}}}};
  return asset;
}

std::string material_of(const scene::Scene& s, size_t mesh) {
  return s.materials[s.meshes[mesh].primitives[0].material].name;
}

}  // namespace

TEST_CASE("a variant changes the materials that it names, and no other") {
  const auto scene = std::make_shared<const scene::Scene>(cupboard().load());
  CHECK(scene->variants == std::vector<std::string>{"summer", "winter"});
  CHECK(scene->unknown_extensions.empty());
  CHECK(scene::with_variant(scene, "", "here") == scene);
  const auto summer = scene::with_variant(scene, "summer", "here"),
             winter = scene::with_variant(scene, "winter", "here");
  CHECK(material_of(*scene, 0) == "oak");
  CHECK(material_of(*summer, 0) == "oak");
  CHECK(material_of(*winter, 0) == "walnut");
  CHECK(material_of(*winter, 1) == "plaster");
  plan::Settings settings;
  CHECK(plan::traced_scene(scene, settings) == scene);
  const std::string key = plan::traced_scene_key(settings);
  settings.set("scene.variant", "winter", "");
  CHECK(material_of(*plan::traced_scene(scene, settings), 0) == "walnut");
  CHECK(plan::traced_scene_key(settings) != key);
}

TEST_CASE("variants that are missing or cannot be read are located") {
  const auto scene = std::make_shared<const scene::Scene>(cupboard().load());
  CHECK_THROWS_WITH(
      scene::with_variant(scene, "autumn", "scene.variant"),
      Catch::Contains("scene.variant") && Catch::Contains("'autumn'") && Catch::Contains("summer, winter"));
  const auto bare = std::make_shared<const scene::Scene>();
  CHECK_THROWS_WITH(scene::with_variant(bare, "autumn", "x"), Catch::Contains("it has none"));
  Asset beyond = cupboard();
  json& mapping =
      beyond.doc["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"][0];
  mapping["variants"] = {2};
  CHECK(failure(beyond).find("variants") != std::string::npos);
  mapping["variants"] = {1}, mapping["material"] = 7;
  CHECK(failure(beyond).find("material") != std::string::npos);
  Asset nameless = cupboard();
  nameless.doc["extensions"]["KHR_materials_variants"]["variants"][0] = json::object();
  CHECK(failure(nameless).find("name") != std::string::npos);
}

TEST_CASE("clay is matt and grey, and leaves glass, emitters and holes") {
  scene::Scene s;
  s.materials.resize(4);
  s.materials[0].clearcoat = 1, s.materials[0].sheen_color = vec3(1);
  s.materials[1].transmission = 1;
  s.materials[2].emission = vec3(2);
  s.materials[3].alpha_mode = scene::AlphaMode::mask, s.materials[3].base_color_texture.texture = 0;
  const auto scene = std::make_shared<const scene::Scene>(s);
  const auto clay = scene::in_clay(scene);
  CHECK(clay->materials[0].base_color == vec4(0.5f, 0.5f, 0.5f, 1));
  CHECK(clay->materials[0].clearcoat == 0);
  CHECK(clay->materials[0].metallic == 0);
  CHECK(clay->materials[0].specular == 0);
  CHECK(clay->materials[1] == s.materials[1]);
  CHECK(clay->materials[2] == s.materials[2]);
  CHECK(clay->materials[3].alpha_mode == scene::AlphaMode::mask);
  CHECK(clay->materials[3].base_color_texture == s.materials[3].base_color_texture);
}

}  // namespace scene_variants_tests
