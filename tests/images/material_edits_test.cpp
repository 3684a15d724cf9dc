// links: session
// Materials that are changed by hand: glass, cut-outs, textures by file. Each gives, bit for bit, the picture
// of a scene built that way.
#include <catch2/catch.hpp>
#include <fstream>

#include "film/io/image_file.h"
#include "scene/io/texture_file.h"
#include "scene/tangents.h"
#include "session/renderer.h"
#include "support/device.h"
#include "support/folder.h"
#include "support/render.h"
#include "support/rooms.h"

namespace material_edits_tests {

using namespace lucerna;
using Kind = scene::TextureSource::Kind;
using Catch::Contains;

namespace {

constexpr uint32_t k_block = 1, k_base = 0, k_normal = 2;  // the block's material; slots

/// A room with a block, both with texture coordinates; the walls are tiled.
scene::Scene textured_room() {
  scene::Scene s = test::block_room(true);
  for (scene::Mesh& mesh : s.meshes)
    for (scene::Primitive& p : mesh.primitives) {
      scene::make_flat_normals(p);
      for (const vec3& x : p.positions) p.uv0.emplace_back(x.x + 0.3f * x.y, x.z + 0.2f * x.y);
    }
  scene::Image tiles;
  tiles.name = "tiles", tiles.width = tiles.height = 2;
  tiles.bytes = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
  s.images.push_back(tiles);
  s.textures.push_back({.image = 1, .wrap_u = scene::Wrap::mirror, .srgb = true});
  s.materials[0].base_color_texture = {.texture = 0, .m = {2, 0, 0.25f, 0, 2, 0}};
  return s;
}

struct Bench {
  session::Renderer r;
  explicit Bench(const scene::Scene& s, bool photons = false) : r(test::renderer_options(true)) {
    r.set_size(40, 28);
    std::vector<session::SettingChange> set{
        {"samples", "4", ""}, {"path.batch", "2048", ""}, {"path.max_depth", "6", ""}};
    if (photons)
      set.push_back({"components.caustic", "photons", ""}), set.push_back({"photons.per_round", "4000", ""});
    r.set_scene(std::make_shared<scene::Scene>(s), {}, set);
  }
  film::Image image() {
    film::Image image = test::finish(r);
    REQUIRE(r.done());
    return image;
  }
};

bool same(const film::Image& a, const film::Image& b) { return a.components == b.components; }

double mean(const film::Image& image) {
  double sum = 0;
  for (const auto& component : image.components) sum += test::mean(component);
  return sum;
}

std::filesystem::path write_picture(const std::filesystem::path& file, uint32_t size = 4) {
  std::vector<uint8_t> rgba;
  for (uint32_t i = 0; i < size * size; ++i)
    for (const uint32_t x : {i * 37 % 256, i * 91 % 256, i * 53 % 256, 255u}) rgba.push_back(uint8_t(x));
  film::write_png(file, size, size, rgba);
  return file;
}

}  // namespace

TEST_CASE("surfaces become glass, thin panes, cut out and blended as if built that way") {
  const scene::Scene before = textured_room();
  using Edit = std::pair<const char*, std::function<void(scene::Material&)>>;
  const Edit edits[] = {
      {"solid glass",
       [](scene::Material& m) {
         m.transmission = 1, m.thickness = 1, m.roughness = 0;
         m.attenuation_color = {0.9f, 0.5f, 0.2f}, m.attenuation_distance = 0.5f;
       }},
      {"pane", [](scene::Material& m) { m.transmission = 0.9f, m.roughness = 0, m.ior = 1.2f; }},
      {"cut", [](scene::Material& m) { m.alpha_mode = scene::AlphaMode::mask, m.base_color.w = 0.4f; }},
      {"share", [](scene::Material& m) { m.alpha_mode = scene::AlphaMode::blend, m.base_color.w = 0.4f; }},
      {"leaf", [](scene::Material& m) { m.diffuse_transmission = 0.5f; }},
      {"brushed", [](scene::Material& m) { m.metallic = 1, m.roughness = 0.3f, m.anisotropy = 0.8f; }},
  };
  for (const bool photons : {false, true}) {
    Bench edited(before, photons);
    const film::Image old = edited.image();
    for (const auto& [name, edit] : edits) {
      CAPTURE(name, photons);
      scene::Scene after = before;
      edit(after.materials[k_block]);
      if (after.materials[k_block].anisotropy > 0)
        for (size_t i = 0; i < after.meshes.size(); ++i)
          for (scene::Primitive& p : after.meshes[i].primitives)
            if (p.material == k_block) scene::make_tangents(p, {});
      edited.r.set_material(k_block, after.materials[k_block]);
      const film::Image image = edited.image();
      CHECK(same(image, Bench(after, photons).image()));
      CHECK_FALSE(same(image, old));
      edited.r.set_material(k_block, before.materials[k_block]);
      CHECK(same(edited.image(), old));
    }
  }
}

TEST_CASE("a surface becomes glass or matt while photons are traced, as if built that way") {
  const scene::Scene matt = textured_room();
  scene::Scene glass = matt, tinted = matt;
  scene::Material& clear = glass.materials[k_block];
  clear.transmission = 1, clear.thickness = 1, clear.roughness = 0;
  tinted.materials[k_block] = clear;
  tinted.materials[k_block].attenuation_color = {0.9f, 0.5f, 0.2f};
  tinted.materials[k_block].attenuation_distance = 0.5f;
  // Without glass no photons are called for: they begin, begin again, and are dropped.
  const std::pair<const scene::Scene*, const scene::Scene*> edits[] = {
      {&matt, &glass}, {&glass, &tinted}, {&glass, &matt}};
  for (const auto& [from, to] : edits) {
    const film::Image expected = Bench(*to, true).image();
    for (const int steps : {1, 2, 4}) {
      CAPTURE(steps, from == &matt, to == &matt);
      Bench edited(*from, true);
      for (int i = 0; i < steps; ++i) REQUIRE(edited.r.step());
      REQUIRE_FALSE(edited.r.done());
      edited.r.set_material(k_block, to->materials[k_block]);
      CHECK(same(edited.image(), expected));
    }
  }
}

TEST_CASE("textures come from files and other materials, and leave nothing behind") {
  const test::Folder folder;
  const scene::Scene before = textured_room();
  const auto file = write_picture(folder / "wood.png"), other = write_picture(folder / "grain.png", 5);
  Bench edited(before);
  const film::Image old = edited.image();
  const scene::Material block = before.materials[k_block];
  const auto by_file = [](const std::filesystem::path& f) {
    return scene::TextureSource{Kind::file, f.string()};
  };

  // A colour, read by the first texture coordinates.
  scene::Scene made = before;
  made.images.push_back(scene::load_texture(file, true, 1 << 20));
  made.textures.push_back({.image = 2, .srgb = true});
  made.materials[k_block].base_color_texture.texture = 1;
  const film::Image wooden = Bench(made).image();
  edited.r.set_material(k_block, block, {{{k_base, by_file(file)}}});
  CHECK(same(edited.image(), wooden));
  CHECK_FALSE(same(wooden, old));
  CHECK(texture_sources(before, *edited.r.scene(), k_block) ==
        scene::TextureSources{{k_base, by_file(file)}});

  // On a material with a texture, by its transform and wraps.
  scene::Scene papered = made;
  papered.textures.push_back({.image = 2, .wrap_u = scene::Wrap::mirror, .srgb = true});
  papered.materials[0].base_color_texture.texture = 2;
  edited.r.set_material(0, before.materials[0], {{{k_base, by_file(file)}}});
  CHECK(edited.r.scene()->images.size() == 3);  // the file is read once
  CHECK(same(edited.image(), Bench(papered).image()));

  // An environment by file comes and goes beside them.
  film::FilmImage sky;
  sky.width = 2, sky.height = 1;
  for (const char* c : {"R", "G", "B"}) sky.channels.emplace_back(c, std::vector<float>{1, 2});
  film::write_exr(folder / "sky.exr", sky);
  edited.r.set_environment_file(folder / "sky.exr");
  CHECK(edited.r.scene()->images.size() == 4);
  edited.r.set_material(k_block, block, {{{k_base, by_file(other)}}});
  CHECK(edited.r.scene()->images.size() == 5);
  CHECK(edited.r.scene()->environment.file == (folder / "sky.exr").string());
  edited.r.set_material(k_block, block, {{{k_base, by_file(file)}}});
  edited.r.set_environment_file("");
  // The textures are at other places of their page now: the last digits of coordinates differ.
  CHECK(mean(edited.image()) == Approx(mean(Bench(papered).image())).epsilon(1e-3));

  // Of another material, removed, and its own again.
  edited.r.set_material(0, before.materials[0], scene::TextureSources());
  edited.r.set_material(k_block, block, {{{k_base, {Kind::material, "", 0}}}});
  scene::Scene tiled = before;
  tiled.materials[k_block].base_color_texture = before.materials[0].base_color_texture;
  CHECK(same(edited.image(), Bench(tiled).image()));
  edited.r.set_material(0, before.materials[0], {{{k_base, {.kind = Kind::none}}}});
  tiled.materials[0].base_color_texture = {};
  CHECK(same(edited.image(), Bench(tiled).image()));
  for (const uint32_t m : {0u, k_block})
    edited.r.set_material(m, before.materials[m], scene::TextureSources());
  CHECK(same(edited.image(), old));
  CHECK(edited.r.scene()->images.size() == before.images.size());
  CHECK(edited.r.scene()->textures.size() == before.textures.size());

  // A normal map gives the surfaces tangents.
  edited.r.set_material(k_block, block, {{{k_normal, by_file(file)}}});
  scene::Scene bumpy = before;
  bumpy.images.push_back(scene::load_texture(file, false, 1 << 20));
  bumpy.textures.push_back({.image = 2});
  bumpy.materials[k_block].normal_texture.texture = 1;
  for (size_t i = 0; i < bumpy.meshes.size(); ++i)
    for (scene::Primitive& p : bumpy.meshes[i].primitives)
      if (p.material == k_block) scene::make_tangents(p, {});
  CHECK(same(edited.image(), Bench(bumpy).image()));
}

TEST_CASE("textures that cannot be read change nothing") {
  const test::Folder folder;
  const scene::Scene before = textured_room();
  Bench edited(before);
  const film::Image old = edited.image();
  std::ofstream(folder / "text.png") << "no picture";
  std::ofstream(folder / "cut.png") << "\x89PNG\r\n\x1a\n";
  const auto failure = [&](const char* name) -> std::string {
    try {
      edited.r.set_material(k_block, before.materials[k_block],
                            {{{k_base, {Kind::file, (folder / name).string()}}}});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  CHECK_THAT(failure("gone.png"), Contains("gone.png: cannot be read"));
  CHECK_THAT(failure("text.png"), Contains("text.png: is neither PNG nor JPEG"));
  CHECK_THAT(failure("cut.png"), Contains("cut.png"));
  scene::Scene bare = before;
  for (scene::Mesh& mesh : bare.meshes)
    for (scene::Primitive& p : mesh.primitives)
      if (p.material == k_block) p.uv0.clear();
  Bench flat(bare);
  write_picture(folder / "wood.png");
  for (const scene::TextureSource& source : {scene::TextureSource{Kind::file, (folder / "wood.png").string()},
                                             scene::TextureSource{Kind::material, "", 0}})
    CHECK_THROWS_WITH(flat.r.set_material(k_block, bare.materials[k_block], {{{k_base, source}}}),
                      Contains("mesh 'box' has it and no texture coordinates"));
  CHECK_THROWS_WITH(
      edited.r.set_material(k_block, before.materials[k_block], {{{k_base, {Kind::material, "", 9}}}}),
      Contains("there is no material 9"));
  CHECK(same(edited.image(), old));
  CHECK(edited.r.scene()->images.size() == before.images.size());
}

}  // namespace material_edits_tests
