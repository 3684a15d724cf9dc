// links: commands
// Materials by command: all their numbers, textures by file, copies of other materials.
#include "unit/scene_support.h"
#include "unit/workspace_bench.h"

namespace commands_material_tests {

using namespace lucerna;
using namespace lucerna::commands;
using namespace lucerna::test;
using Catch::Contains;
using Kind = scene::TextureSource::Kind;

TEST_CASE("every number of a material can be set, and is sent") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  b.run(
      "material.set 1 ior=1.7 specular=0.5 specular_color=1,2,0.5 transmission=0.9 thickness=0.02 "
      "absorb_color=0.5,0.9,0.7 absorb_distance=0.3 dispersion=0.4");
  b.run(
      "material.set 1 alpha=mask coverage=0.6 cutoff=0.3 normal_scale=2 two_sided=true "
      "diffuse_transmission=0.25 diffuse_transmission_color=0.1,0.2,0.3");
  b.run(
      "material.set 1 clearcoat_normal_scale=0.5 film_ior=1.4 film_thickness=300 film_thickness_min=50 "
      "diffuse_roughness=0.7 height=-0.03");
  REQUIRE(b.settled());
  const scene::Material m = b.session.scene()->materials[0];
  CHECK((m.ior == 1.7f && m.specular == 0.5f && m.specular_color == vec3(1, 2, 0.5f)));
  CHECK((m.transmission == 0.9f && m.thickness == 0.02f && m.dispersion == 0.4f));
  CHECK((m.attenuation_color == vec3(0.5f, 0.9f, 0.7f) && m.attenuation_distance == 0.3f));
  CHECK((m.alpha_mode == scene::AlphaMode::mask && m.base_color.w == 0.6f && m.alpha_cutoff == 0.3f));
  CHECK((m.normal_scale == 2 && m.double_sided));
  CHECK((m.diffuse_transmission == 0.25f && m.diffuse_transmission_color == vec3(0.1f, 0.2f, 0.3f)));
  CHECK((m.clearcoat_normal_scale == 0.5f && m.iridescence_ior == 1.4f));
  CHECK((m.iridescence_minimum == 50 && m.iridescence_maximum == 300));
  CHECK((m.diffuse_roughness == 0.7f && m.height == -0.03f));
  b.run("material.set 1 absorb_distance=0");
  CHECK(b.work.open.material(0).attenuation_distance == k_infinity);
  for (int i = 0; i < 4; ++i) b.run("undo");
  REQUIRE(b.settled());
  CHECK(b.work.open.document() == before);
  CHECK_THAT(b.failure("material.set 1 ior=0.5"), Contains("a number from 1 to 100"));
  CHECK_THAT(b.failure("material.set 1 alpha=half"), Contains("opaque, mask, blend"));
}

TEST_CASE("a height texture has a height at once, and deep relief is never inside out") {
  TempFolder folder;
  write_image<uint8_t>(folder / "bricks.png", 2, 1, 4, {0, 0, 0, 255, 255, 255, 255, 255});
  WorkspaceBench b;
  b.open();
  const std::string file = "material.set 1 height_texture=" + (folder / "bricks.png").string();
  b.run(file);
  REQUIRE(b.settled());
  CHECK(b.session.scene()->materials[0].height == 0.01f);
  CHECK(scene::has_relief(b.session.scene()->materials[0]));
  b.run(file + " height=-0.25");
  b.run("material.set 1 deep_relief=true");
  REQUIRE(b.settled());
  CHECK(b.session.scene()->materials[0].height == 0.25f);
  b.run("material.set 1 height_texture=none");
  REQUIRE(b.settled());
  CHECK_FALSE(scene::has_relief(b.session.scene()->materials[0]));
}

TEST_CASE("textures come from files, and scripts find them from any folder") {
  TempFolder folder;
  write_image<uint8_t>(folder / "wood.png", 1, 1, 4, {200, 100, 50, 255});
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  const std::string file = (folder / "wood.png").string();
  b.run("material.set 1 base_color_texture=" + file + " roughness=0.4");
  REQUIRE(b.settled());
  const scene::Scene& edited = *b.session.scene();
  const scene::TextureUse& use = edited.materials[0].base_color_texture;
  REQUIRE(use);
  CHECK(edited.images[edited.textures[use.texture].image].name == file);
  CHECK(b.work.open.textures(0) == scene::TextureSources{{0, {Kind::file, file}}});
  CHECK_THAT(b.work.history.script().back(), Contains("base_color_texture=" + file));
  // The other material takes all of it.
  b.run("material.set 2 like=1");
  REQUIRE(b.settled());
  CHECK(b.session.scene()->materials[1].base_color_texture == use);
  CHECK(b.session.scene()->materials[1].roughness == 0.4f);
  CHECK(b.session.scene()->materials[1].name == edited.materials[1].name);
  b.run("material.set 2 like=plain metallic=1 color=0.9,0.7,0.3");
  REQUIRE(b.settled());
  CHECK_FALSE(b.session.scene()->materials[1].base_color_texture);
  CHECK(b.session.scene()->materials[1].roughness == 1);
  b.run("material.set 1 base_color_texture=none");
  CHECK(b.work.history.script().back() == "material.set 1 base_color_texture=none");
  REQUIRE(b.settled());
  CHECK_FALSE(b.session.scene()->materials[0].base_color_texture);
  for (int i = 0; i < 4; ++i) b.run("undo");
  REQUIRE(b.settled());
  CHECK(b.work.open.document() == before);
  CHECK(b.session.scene()->images.size() == b.work.open.loaded->images.size());

  // A file that is gone is refused, and is no step.
  const size_t steps = b.work.history.undo_steps();
  b.work.run("material.set 1 base_color_texture=" + (folder / "gone.png").string());
  REQUIRE(b.until([&] { return b.work.history.undo_steps() == steps && b.errors > 0; }));
  REQUIRE(b.settled());
  CHECK(b.work.open.document() == before);
  CHECK_THAT(b.failure("material.set 1 like=marmalade"), Contains("no material 'marmalade'"));
}

}  // namespace commands_material_tests
