// links: transport
// The kinds of hits, and which get separate kernels.
#include <catch2/catch.hpp>

#include "shaders/shared/transport.h"
#include "transport/hit_classes.h"
#include "upload/material_kinds.h"

namespace hit_classes_tests {

using namespace lucerna;
using namespace lucerna::upload;
using transport::choose_hit_classes;
using transport::HitClass;
using transport::HitClasses;

namespace {

using Counts = std::array<uint64_t, shared::k_hit_kinds>;
using Features = std::array<uint32_t, shared::k_hit_kinds>;

constexpr uint32_t k_matt = k_feature_light_samples, k_gloss = k_matt | k_feature_specular,
                   k_textured = k_gloss | k_feature_base_texture, k_pane = k_gloss | k_feature_thin_glass;

scene::Material material(float specular) {
  scene::Material m;
  m.metallic = 0, m.specular = specular;
  return m;
}

}  // namespace

TEST_CASE("materials that need the same features are one kind") {
  std::vector<scene::Material> materials(4, material(0));
  materials[1].base_color = vec4(0.5f);
  materials[2].specular = 1;
  materials[3].roughness = 0;
  const MaterialKinds kinds = material_kinds(materials);
  CHECK(kinds.of_material == std::vector<uint32_t>{1, 1, 2, 1});
  CHECK(kinds.features[shared::k_kind_sky] == 0);
  CHECK(kinds.features[1] == k_matt);
  CHECK(kinds.features[2] == k_gloss);
  CHECK(kinds.features[3] == 0);
}

TEST_CASE("kinds beyond the limit share the last one, which has every feature") {
  std::vector<scene::Material> materials;
  for (uint32_t i = 0; i < 64; ++i) {
    scene::Material m = material(float(i & 1));
    m.unlit = i & 2, m.diffuse_transmission = i & 4 ? 0.5f : 0.0f, m.emission = vec3(i & 8 ? 1.0f : 0.0f);
    if (i & 16) m.alpha_mode = scene::AlphaMode::blend;
    if (i & 32) m.base_color_texture.texture = 0;
    materials.push_back(m);
  }
  const MaterialKinds kinds = material_kinds(materials);
  const uint32_t last = shared::k_hit_kinds - 1;
  CHECK(kinds.features[last] == k_all_features);
  CHECK(kinds.of_material.back() == last);
  for (size_t i = 0; i < materials.size(); ++i)
    CHECK((features_of(materials[i]) & ~kinds.features[kinds.of_material[i]]) == 0);
}

TEST_CASE("surfaces that scatter only in single directions take no light samples") {
  scene::Material m;
  m.metallic = 1, m.roughness = 0;
  CHECK(!(features_of(m) & k_feature_light_samples));
  m.metallic_roughness_texture.texture = 0;
  CHECK(features_of(m) & k_feature_light_samples);
  m = material(1);
  m.roughness = 0;
  CHECK(features_of(m) & k_feature_light_samples);  // below the coat
  m.transmission = 1;
  CHECK(!(features_of(m) & k_feature_light_samples));
  m.roughness = 0.2f;
  CHECK(features_of(m) & k_feature_light_samples);
}

TEST_CASE("kinds with many hits get classes, others use a kernel that lacks no feature") {
  Features features{0, k_matt, k_gloss, k_textured, k_pane};
  features[5] = k_matt | k_feature_normal_map;
  Counts hits{100, 500, 10, 300, 80, 10};
  const HitClasses chosen = choose_hit_classes(features, hits);
  REQUIRE(chosen.classes ==
          std::vector<HitClass>{{k_matt, false}, {k_textured, false}, {0, true}, {k_pane, false}});
  // Gloss: panes and textures cost one feature more each; the first is chosen. A normal map: none.
  CHECK(chosen.of_kind[0] == 3);
  CHECK(chosen.of_kind[1] == 1);
  CHECK(chosen.of_kind[2] == 2);
  CHECK(chosen.of_kind[3] == 2);
  CHECK(chosen.of_kind[4] == 4);
  CHECK(chosen.of_kind[5] == 0);
  CHECK(packed(chosen) == std::array<uint32_t, 4>{0x042213, 0, 0, 0});
}

TEST_CASE("paths that leave the scene are shaded with surfaces only by the kernel for all") {
  Features features{0, k_matt, k_pane};
  const HitClasses chosen = choose_hit_classes(features, Counts{1, 99, 0});
  CHECK(chosen.classes == std::vector<HitClass>{{k_matt, false}});
  CHECK(chosen.of_kind[0] == 0);
  CHECK(choose_hit_classes(features, Counts{}).classes.empty());
}

TEST_CASE("if all hits are alike there are no classes") {
  CHECK(choose_hit_classes(Features{0, k_matt, k_matt | k_feature_emission}, Counts{10, 80, 10})
            .classes.empty());
  CHECK(choose_hit_classes(Features{0, k_textured, k_matt}, Counts{2, 90, 8}).classes.empty());
  CHECK(choose_hit_classes(Features{0, k_textured, k_matt}, Counts{2, 50, 48}).classes.size() == 2);
}

TEST_CASE("there are no more classes than kernels") {
  Features features{};
  Counts hits{};
  for (uint32_t k = 1; k < 12; ++k) features[k] = 1u << k, hits[k] = 100;
  const HitClasses chosen = choose_hit_classes(features, hits);
  CHECK(chosen.classes.size() == shared::k_hit_classes - 1);
  for (const uint32_t c : chosen.of_kind) CHECK(c < shared::k_hit_classes);
}

TEST_CASE("surfaces that only scatter are known, unless hits need more than shading") {
  Features features;
  features.fill(k_all_features);
  features[1] = k_matt, features[2] = k_matt | k_feature_base_texture | k_feature_normal_map;
  features[3] = k_gloss, features[4] = k_matt | k_feature_emission, features[5] = k_matt | k_feature_alpha;
  features[shared::k_kind_sky] = 0;
  features[6] = k_pane;
  for (const gpu::Defines& defines : {gpu::Defines{}, gpu::Defines{{"LUCERNA_SHAPES", "0"}}}) {
    CHECK(transport::dark_kinds(features, defines).diffuse == 0b110);
    CHECK(transport::dark_kinds(features, defines).all == 0b1110);
  }
  for (const char* name : {"LUCERNA_PATH_EVENTS", "LUCERNA_SHAPES", "LUCERNA_NO_AUTOMATON"}) {
    CHECK(transport::dark_kinds(features, {{name, "1"}}).diffuse == 0);
    CHECK(transport::dark_kinds(features, {{name, "1"}}).all == 0);
  }
}

TEST_CASE("a class's kernel keeps what light samples read of emissive surfaces") {
  gpu::Defines all{{"LUCERNA_EMISSIVE", "1"}, {"LUCERNA_ALPHA", "1"},    {"LUCERNA_TEX_BASE", "1"},
                   {"LUCERNA_LIGHTS", "1"},   {"LUCERNA_SPECULAR", "1"}, {"LUCERNA_VERTEX_EXTRA", "0"}};
  gpu::Defines matt = transport::defines_of({k_matt, false}, all);
  CHECK(matt["LUCERNA_ALPHA"] == "1");
  CHECK(matt["LUCERNA_TEX_BASE"] == "1");
  CHECK(matt["LUCERNA_SPECULAR"] == "0");
  CHECK(matt["LUCERNA_SCENE_GLOSSY"] == "1");
  CHECK(matt["LUCERNA_HITS_EMISSIVE"] == "0");
  CHECK(matt["LUCERNA_HITS_SKY"] == "0");
  all["LUCERNA_PLAIN_EMITTERS"] = "1";
  CHECK(transport::defines_of({k_matt, false}, all)["LUCERNA_ALPHA"] == "0");
  all["LUCERNA_EMISSIVE"] = "0";
  matt = transport::defines_of({k_matt, false}, all);
  CHECK(matt["LUCERNA_ALPHA"] == "0");
  CHECK(matt["LUCERNA_TEX_BASE"] == "0");
  CHECK(transport::defines_of({0, true}, all)["LUCERNA_HITS_SURFACES"] == "0");
}

}  // namespace hit_classes_tests
