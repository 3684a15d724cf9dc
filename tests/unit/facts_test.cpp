// links: plan
// What scenes call for: each effect by the objects that prove it, and scenes without an effect.
#include <catch2/catch.hpp>

#include "plan/facts_text.h"
#include "scene/light_picture.h"

namespace facts_tests {

using namespace lucerna;
using plan::SceneFacts, plan::facts_of;

namespace {

/// Triangles with materials "A", "B", ...: dark dielectrics without a coat.
scene::Scene triangles(size_t count) {
  scene::Scene s;
  scene::Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.triangles = {{0, 1, 2}};
  scene::Mesh mesh{"mesh", {}};
  for (size_t i = 0; i < count; ++i) {
    scene::Material m;
    m.name = std::string(1, char('A' + i));
    m.base_color = vec4(0, 0, 0, 1);
    m.metallic = 0, m.specular = 0;
    s.materials.push_back(m);
    p.material = scene::Id(i);
    mesh.primitives.push_back(p);
  }
  s.meshes = {mesh};
  s.instances = {{"node", 0, mat4(1), false}};
  return s;
}

size_t called_for(const scene::Scene& s) {
  size_t count = 0;
  for (const plan::Effect& e : facts_of(s).effects) count += e.called_for();
  return count;
}

}  // namespace

TEST_CASE("a black scene calls for nothing, and every effect says what is missing") {
  const SceneFacts facts = facts_of(triangles(2));
  for (const plan::Effect& e : facts.effects) {
    INFO(e.key);
    CHECK_FALSE(e.called_for());
    CHECK_FALSE(e.missing.empty());
    CHECK(plan::evidence_text(e).empty());
  }
  CHECK_THROWS_AS(facts.effect("nothing"), std::out_of_range);
}

TEST_CASE("an effect is called for by the objects that have it, and by no others") {
  scene::Scene s = triangles(3);
  s.materials[1].base_color = vec4(0.5f);
  CHECK_FALSE(facts_of(s).has("secondary"));  // no light
  s.lights.resize(2);
  s.lights[1].name = "key";
  s.lights[0].enabled = false;
  {
    const SceneFacts facts = facts_of(s);
    CHECK(facts.has("secondary"));
    CHECK(facts.has("tertiary"));
    CHECK_FALSE(facts.has("caustic"));
    REQUIRE(facts.effect("point").evidence.size() == 1);
    CHECK(facts.effect("point").evidence[0].index == 1);
    CHECK(plan::evidence_text(facts.effect("point")) == "lamp 'key'");
    CHECK(plan::evidence_text(facts.effect("diffuse")) == "material 'B'");
  }
  // Rough metal focuses no light; a mirror does, also that of a lamp without size.
  s.materials[2].metallic = 1, s.materials[2].roughness = 0.9f;
  CHECK(facts_of(s).has("metal"));
  CHECK_FALSE(facts_of(s).has("caustic"));
  s.materials[2].roughness = 0;
  CHECK(facts_of(s).has("caustic"));
  CHECK(facts_of(s).has("point_caustic"));
  s.lights.front().kind = s.lights.back().kind = scene::LightKind::sphere;
  CHECK(facts_of(s).has("caustic"));
  CHECK_FALSE(facts_of(s).has("point_caustic"));
  CHECK(facts_of(s).has("shaped"));
  // Without the lamp there is nothing to focus; an emitter has a size.
  s.lights.clear();
  CHECK_FALSE(facts_of(s).has("caustic"));
  s.materials[0].emission = vec3(1);
  CHECK(facts_of(s).has("caustic"));
  CHECK_FALSE(facts_of(s).has("point_caustic"));
  // A material that no surface has does not count.
  s.materials.resize(4);
  s.materials[3].transmission = 1, s.materials[3].thickness = 1;
  CHECK_FALSE(facts_of(s).has("solid_glass"));
  s.meshes = {scene::Mesh{"mesh", {s.meshes[0].primitives[0]}}};
  CHECK_FALSE(facts_of(s).has("metal"));
}

TEST_CASE("evidence names the first objects and counts the rest") {
  scene::Scene s = triangles(5);
  for (scene::Material& m : s.materials) m.alpha_mode = scene::AlphaMode::mask;
  const SceneFacts facts = facts_of(s);
  CHECK(plan::evidence_text(facts.effect("alpha_mask"), 2) == "material 'A', 'B' and 3 more");
  CHECK(plan::evidence_text(facts.effect("alpha_mask"), 5) == "material 'A', 'B', 'C', 'D', 'E'");
  const std::string text = plan::effects_text(facts, {"alpha_mask"});
  CHECK(text.find("Cut-outs") < text.find("not called for"));
  CHECK(text.find("(off)") != std::string::npos);
  const auto json = plan::effects_json(facts, {"alpha_mask"});
  CHECK(json["alpha_mask"]["evidence"].size() == 5);
  CHECK(json["alpha_mask"]["off"] == true);
  CHECK(json["alpha_blend"]["called_for"] == false);
  CHECK_FALSE(json["metal"].contains("off"));
}

TEST_CASE("without an effect, a scene no longer calls for it, and keeps all others") {
  scene::Scene full = triangles(2);
  full.images = std::vector<scene::Image>{{"image", 1, 1, {255, 255, 255, 255}, {}}};
  full.textures = std::vector<scene::Texture>{{.image = 0}};
  scene::Material& m = full.materials[0];
  m.base_color = vec4(0.5f), m.specular = 1;
  m.diffuse_transmission = 0.5f;
  m.emission = vec3(1);
  m.alpha_mode = scene::AlphaMode::mask;
  m.clearcoat = 0.5f, m.sheen_color = vec3(0.5f), m.anisotropy = 0.5f, m.iridescence = 0.5f;
  for (const scene::TextureSlot& slot : scene::k_texture_slots)
    if (slot.use != &scene::Material::transmission_texture) (m.*slot.use).texture = 0;
  m.diffuse_roughness = 0.5f, m.height = 0.01f;
  scene::Material& glass = full.materials[1];
  glass.height_texture.texture = 0, glass.height = 0.01f, glass.deep_relief = true;
  glass.shadow_catcher = true;
  glass.transmission = 1, glass.thickness = 1, glass.attenuation_distance = 1, glass.roughness = 0.3f;
  glass.dispersion = 0.3f, glass.attenuation_color = vec3(0.5f), glass.alpha_mode = scene::AlphaMode::blend;
  glass.transmission_texture.texture = 0;
  full.lights.resize(5);
  full.lights[3].kind = scene::LightKind::disk, full.lights[4].kind = scene::LightKind::profile;
  full.lights[1].picture = std::make_shared<const scene::LightPicture>(
      scene::make_picture(1, 1, {vec3(1)}, "full.lights[1].picture"));
  full.lights[1].kind = scene::LightKind::spot, full.lights[2].kind = scene::LightKind::directional;
  full.environment.radiance = vec3(1);
  full.portals.resize(1);
  const auto scene = std::make_shared<const scene::Scene>(full);
  const SceneFacts facts = facts_of(full);
  size_t tried = 0;
  for (const plan::Effect& e : facts.effects) {
    if (!e.can_be_off) continue;
    INFO(e.key);
    ++tried;
    REQUIRE(e.called_for());
    const auto without = plan::without_effects(scene, {std::string(e.key)});
    REQUIRE(without != scene);
    CHECK_FALSE(facts_of(*without).has(e.key));
    // What depends on it goes with it: portals with the sky, a texture with its lobe.
    CHECK(called_for(*without) + 4 >= called_for(full));
    // A scene without the effect is left as it is.
    CHECK(plan::without_effects(without, {std::string(e.key)}) == without);
  }
  CHECK(tried >= 30);
  CHECK(plan::without_effects(scene, {}) == scene);
}

TEST_CASE("lists of effects: blanks and repetitions, unknown effects, effects that cannot be off") {
  CHECK(plan::parse_effects("", "here").empty());
  CHECK(plan::parse_effects(" normal_map , point,normal_map,", "here") ==
        std::vector<std::string>{"normal_map", "point"});
  CHECK_THROWS_WITH(plan::parse_effects("normal_map, shine", "effects.off"),
                    Catch::Contains("effects.off") && Catch::Contains("'shine'") &&
                        Catch::Contains("there is no such effect") && Catch::Contains("normal_map"));
  CHECK_THROWS_WITH(plan::parse_effects("metal", "effects.off"), Catch::Contains("cannot be off"));
}

TEST_CASE("cameras call for a lens, a lens shift and a section plane, each by its name") {
  scene::Scene s = triangles(1);
  s.cameras.resize(4);
  for (size_t i = 0; i < 4; ++i) s.cameras[i].name = std::string(1, char('a' + i));
  s.cameras[0].lens = {.f_number = 0, .focus_distance = 2, .blades = 6};  // a pinhole
  s.cameras[1].lens = {.f_number = 2, .focus_distance = 2};
  s.cameras[2].shift = {0, 0.25f};
  s.cameras[3].section = {.normal = {0, 1, 0}};
  CHECK(plan::evidence_text(facts_of(s).effect("depth_of_field")) == "camera 'b'");
  CHECK(plan::evidence_text(facts_of(s).effect("lens_shift")) == "camera 'c'");
  CHECK(plan::evidence_text(facts_of(s).effect("section")) == "camera 'd'");
  s.cameras[1].orthographic = true;
  CHECK_FALSE(facts_of(s).has("depth_of_field"));
}

}  // namespace facts_tests
