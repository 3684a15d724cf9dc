// links: scene
// Hashes of the parts of a scene that determine its light: each change of light changes the hash of its part
// and no other; a change without influence on light changes none.
#include <catch2/catch.hpp>
#include <functional>

#include "base/hash.h"
#include "scene/hash.h"

namespace scene_hash_tests {

using namespace lucerna;
using namespace lucerna::scene;

namespace {

Scene room() {
  Scene s;
  s.name = "room";
  s.images.resize(3);
  for (Image& image : s.images) image.width = image.height = 1;
  s.images[0].bytes = {1, 2, 3, 4};
  s.images[1].bytes = {5, 6, 7, 8};
  s.images[2].floats = {1, 2, 3, 1};
  s.textures = {{0}, {1}};
  s.materials.resize(2);
  s.materials[0].base_color_texture.texture = 0;
  Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  p.uv0 = {{0, 0}, {1, 0}, {0, 1}};
  p.triangles = {{0, 1, 2}};
  s.meshes = {{"mesh", {p}}, {"other", {p}}};
  s.meshes[1].primitives[0].positions[1].x = 2;
  s.instances = {{"a", 0, mat4(1), false}, {"b", 1, mat4(1), false}};
  s.lights.resize(2);
  s.lights[1].enabled = false;
  s.environment.radiance = vec3(1);
  s.cameras.resize(1);
  return s;
}

/// The hashes that a change changes: letters of "gmle".
std::string moved(const std::function<void(Scene&)>& change, Scene s = room()) {
  const LightHash before = light_hash(s);
  change(s);
  const LightHash after = light_hash(s);
  std::string reported;
  if (after.geometry != before.geometry) reported += 'g';
  if (after.materials != before.materials) reported += 'm';
  if (after.lights != before.lights) reported += 'l';
  if (after.environment != before.environment) reported += 'e';
  return reported;
}

}  // namespace

TEST_CASE("a change of light changes the hash of its part, and no other") {
  CHECK(moved([](Scene& s) { s.meshes[0].primitives[0].positions[1].x = 1.0001f; }) == "g");
  CHECK(moved([](Scene& s) { s.meshes[0].primitives[0].normals[1].x = 0.1f; }) == "g");
  CHECK(moved([](Scene& s) { s.meshes[0].primitives[0].uv0[1].x = 0.5f; }) == "g");
  CHECK(moved([](Scene& s) { s.meshes[0].primitives[0].colors.resize(3); }) == "g");
  CHECK(moved([](Scene& s) { s.meshes[0].primitives[0].triangles.pop_back(); }) == "g");
  CHECK(moved([](Scene& s) { s.meshes[0].primitives[0].material = 1; }) == "g");
  CHECK(moved([](Scene& s) { s.instances[1].to_world[3].y = 0.5f; }) == "g");
  CHECK(moved([](Scene& s) { s.instances[1].flipped = true; }) == "g");
  CHECK(moved([](Scene& s) { s.instances[1].hidden = true; }) == "g");
  CHECK(moved([](Scene& s) { std::swap(s.instances[0].mesh, s.instances[1].mesh); }) == "g");
  CHECK(moved([](Scene& s) { s.instances.pop_back(); }) == "g");
  CHECK(moved([](Scene& s) { s.materials[1].base_color.x = 0.5f; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].roughness = 0.5f; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].emission.y = 2; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].double_sided = true; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].attenuation_distance = 2; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].diffuse_transmission_color.z = 0; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].clearcoat = 1; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].sheen_color.y = 1; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].dispersion = 0.3f; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].diffuse_roughness = 0.3f; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].height = 0.1f; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].deep_relief = true; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[0].height_texture.texture = 1; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[1].iridescence_maximum = 300; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[0].anisotropy_texture.texture = 1; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[0].base_color_texture.texture = 1; }) == "m");
  CHECK(moved([](Scene& s) { s.materials[0].base_color_texture.m[2] = 0.5f; }) == "m");
  // The same image with another use.
  CHECK(moved([](Scene& s) {
          s.materials[0].normal_texture = s.materials[0].base_color_texture;
          s.materials[0].base_color_texture = {};
        }) == "m");
  CHECK(moved([](Scene& s) { s.textures[0].wrap_u = Wrap::mirror; }) == "m");
  CHECK(moved([](Scene& s) { s.textures[0].srgb = true; }) == "m");
  CHECK(moved([](Scene& s) { s.images[0].bytes[3] = 5; }) == "m");
  CHECK(moved([](Scene& s) { s.lights[0].intensity.x = 2; }) == "l");
  CHECK(moved([](Scene& s) { s.lights[0].position.x = 2; }) == "l");
  CHECK(moved([](Scene& s) { s.lights[0].enabled = false; }) == "l");
  CHECK(moved([](Scene& s) { s.lights[1].enabled = true; }) == "l");
  CHECK(moved([](Scene& s) { s.environment.radiance.x = 2; }) == "e");
  CHECK(moved([](Scene& s) { s.environment.scale = 2; }) == "e");
  CHECK(moved([](Scene& s) { s.environment.image = 2; }) == "e");
  Scene projector = room();
  projector.lights[0].kind = LightKind::spot;
  const auto picture = [](float red) {
    return std::make_shared<const LightPicture>(make_picture(2, 2, {4, vec3(red, 1, 1)}, "x"));
  };
  projector.lights[0].picture = picture(0.5f);
  CHECK(moved([&](Scene& s) { s.lights[0].picture = picture(0.6f); }, projector) == "l");
  CHECK(moved([&](Scene& s) { s.lights[0].right = {0, 1, 0}; }, projector) == "l");
  CHECK(moved([&](Scene& s) { s.lights[0].picture = picture(0.5f); }, projector).empty());
  Scene sky = room();
  sky.environment.image = 2;
  CHECK(moved([](Scene& s) { s.environment.rotation = 30; }, sky) == "e");
  CHECK(moved([](Scene& s) { s.images[2].floats[1] = 30; }, sky) == "e");
}

TEST_CASE("changes without influence on light change no hash") {
  CHECK(moved([](Scene& s) {
          s.name = s.file = s.meshes[0].name = s.instances[0].name = s.materials[0].name = s.lights[0].name =
              s.images[0].name = s.environment.file = "another";
          s.cameras[0].yfov = 1, s.cameras.resize(3);
          s.settings.push_back({"samples", "3"});
          s.warnings.push_back("a warning");
          s.lights[1].intensity = vec3(100);                    // it is off
          s.images[1].bytes[0] = 9, s.textures[1].srgb = true;  // no surface uses it
          s.environment.rotation = 30;                          // the environment is constant
        }).empty());
}

TEST_CASE("the hash is FNV-1a, whose values are stored in files") {
  Hash hash;
  hash.add_bytes("hello", 5);
  CHECK(hash.low() == 0xa430d84680aabd0bull);
}

}  // namespace scene_hash_tests
