// links: scene_io
// Materials with their extensions, textures and images.
#include <cmath>

#include "scene/range.h"
#include "unit/scene_support.h"

namespace scene_material_tests {

using namespace lucerna;
using namespace lucerna::test;
using scene::Image;
using scene::Material;
using scene::Scene;
using scene::TextureUse;

namespace {

Material load_material(const json& material) {
  Asset asset;
  asset.textured_triangle(material);
  const Scene scene = asset.load();
  REQUIRE(scene.materials.size() == 1);
  return scene.materials[0];
}

json extension(const std::string& name, const json& content) { return {{"extensions", {{name, content}}}}; }

// A scene with one base colour texture from the given file; returns its image.
Image load_image(const std::filesystem::path& folder, const json& image, bool data = false) {
  Asset asset;
  const int texture = asset.add("textures", {{"source", asset.add("images", image)}});
  asset.textured_triangle(data
                              ? json{{"normalTexture", {{"index", texture}}}}
                              : json{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  write(folder / "a.gltf", asset.complete(true).dump());
  const Scene scene = scene::load(folder / "a.gltf");
  INFO((scene.warnings.empty() ? std::string() : scene.warnings[0]));
  REQUIRE(scene.images.size() == 1);
  CHECK(scene.warnings.empty());
  CHECK(scene.textures[0].srgb == !data);
  return scene.images[0];
}

vec2 apply(const TextureUse& use, vec2 uv) {
  return {use.m[0] * uv.x + use.m[1] * uv.y + use.m[2], use.m[3] * uv.x + use.m[4] * uv.y + use.m[5]};
}

}  // namespace

TEST_CASE("glTF's defaults, and the default material") {
  const Material m = load_material(json::object());
  CHECK(m.name == "material 0");
  CHECK(m.base_color == vec4(1));
  CHECK(m.metallic == 1);
  CHECK(m.roughness == 1);
  CHECK(m.emission == vec3(0));
  CHECK(m.alpha_mode == scene::AlphaMode::opaque);
  CHECK(m.alpha_cutoff == 0.5f);
  CHECK_FALSE(m.double_sided);
  CHECK(m.ior == 1.5f);
  CHECK(m.attenuation_distance == k_infinity);

  Asset asset;
  asset.triangle();
  asset.textured_triangle({{"name", "red"}});
  const Scene scene = asset.load();
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.materials[scene.meshes[0].primitives[0].material].name == "default material");
  CHECK(scene.materials[scene.meshes[1].primitives[0].material].name == "red");
}

TEST_CASE("core factors") {
  const Material m = load_material(
      {{"name", "m"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.25, 0.5, 0.75, 0.125}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.25}}},
       {"emissiveFactor", {1, 2, 3}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.75},
       {"doubleSided", true}});
  CHECK(m.name == "m");
  CHECK(m.base_color == vec4(0.25f, 0.5f, 0.75f, 0.125f));
  CHECK(m.metallic == 0.5f);
  CHECK(m.roughness == 0.25f);
  CHECK(m.emission == vec3(1, 2, 3));
  CHECK(m.alpha_mode == scene::AlphaMode::mask);
  CHECK(m.alpha_cutoff == 0.75f);
  CHECK(m.double_sided);
  CHECK(load_material({{"alphaMode", "BLEND"}}).alpha_mode == scene::AlphaMode::blend);
}

TEST_CASE("extensions of materials") {
  Material m =
      load_material({{"emissiveFactor", {1, 0.5, 0}},
                     {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 40}}}}}});
  CHECK(m.emission == vec3(40, 20, 0));
  CHECK(load_material(extension("KHR_materials_ior", {{"ior", 1.33}})).ior == 1.33f);
  CHECK(load_material(extension("KHR_materials_ior", {{"ior", 0}})).ior == 0);
  m = load_material(
      extension("KHR_materials_specular", {{"specularFactor", 0}, {"specularColorFactor", {1, 2, 0.5}}}));
  CHECK(m.specular == 0);
  CHECK(m.specular_color == vec3(1, 2, 0.5f));
  CHECK(load_material(extension("KHR_materials_transmission", {{"transmissionFactor", 0.5}})).transmission ==
        0.5f);
  m = load_material(extension(
      "KHR_materials_volume",
      {{"thicknessFactor", 0.1}, {"attenuationDistance", 2}, {"attenuationColor", {1, 0.5, 0.25}}}));
  CHECK(m.thickness == 0.1f);
  CHECK(m.attenuation_distance == 2);
  CHECK(m.attenuation_color == vec3(1, 0.5f, 0.25f));
  // A distance of 0: no absorption, and the file loads.
  CHECK(load_material(extension("KHR_materials_volume", {{"attenuationDistance", 0}})).attenuation_distance ==
        k_infinity);
  m = load_material(
      extension("KHR_materials_diffuse_transmission",
                {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {0.25, 0.5, 1}}}));
  CHECK(m.diffuse_transmission == 0.5f);
  CHECK(m.diffuse_transmission_color == vec3(0.25f, 0.5f, 1));
  m = load_material(
      extension("KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.25}}));
  CHECK(m.clearcoat == 0.5f);
  CHECK(m.clearcoat_roughness == 0.25f);
  m = load_material(extension("KHR_materials_sheen",
                              {{"sheenColorFactor", {0.25, 0.5, 1}}, {"sheenRoughnessFactor", 0.75}}));
  CHECK(m.sheen_color == vec3(0.25f, 0.5f, 1));
  CHECK(m.sheen_roughness == 0.75f);
  m = load_material(
      extension("KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 1.5}}));
  CHECK(m.anisotropy == 0.5f);
  CHECK(m.anisotropy_rotation == 1.5f);
  m = load_material(
      extension("KHR_materials_iridescence",
                {{"iridescenceFactor", 0.5}, {"iridescenceIor", 1.5}, {"iridescenceThicknessMaximum", 550}}));
  CHECK(m.iridescence == 0.5f);
  CHECK(m.iridescence_ior == 1.5f);
  CHECK(m.iridescence_minimum == 100);
  CHECK(m.iridescence_maximum == 550);
  CHECK(load_material(extension("KHR_materials_dispersion", {{"dispersion", 0.25}})).dispersion == 0.25f);
  for (const char* name : {"EXT_materials_diffuse_roughness", "KHR_materials_diffuse_roughness"})
    CHECK(load_material(extension(name, {{"diffuseRoughnessFactor", 0.25}})).diffuse_roughness == 0.25f);
  CHECK(load_material(extension("KHR_materials_unlit", json::object())).unlit);
}

TEST_CASE("relief by a height texture: from extras, in metres, shallow unless it says deep") {
  const auto with = [](const json& height) { return json{{"extras", {{"lucerna", {{"height", height}}}}}}; };
  Asset asset;
  const json texture{
      {"index", asset.add("textures", {{"source", asset.add("images", {{"uri", "no.png"}})}})}};
  asset.textured_triangle(with({{"texture", texture}, {"height", 0.02}, {"deep", true}}));
  asset.textured_triangle(with({{"texture", texture}, {"height", -0.02}}));
  asset.textured_triangle(with({{"texture", texture}, {"height", -0.02}, {"deep", true}}));
  asset.textured_triangle(with({{"texture", texture}, {"height", 1e9}}));
  asset.textured_triangle(with({{"height", 0.5}}));
  const Scene scene = asset.load();
  const auto& m = scene.materials;
  CHECK((m[0].height == 0.02f && m[0].deep_relief && has_relief(m[0])));
  CHECK((m[1].height == -0.02f && !m[1].deep_relief && has_relief(m[1])));
  // Deep relief lies below the surface: it has no negative height.
  CHECK((m[2].height == 0 && m[2].deep_relief && !has_relief(m[2])));
  CHECK(m[3].height == scene::k_max_height);
  CHECK_FALSE(has_relief(m[4]));
  CHECK(warnings_with(scene, "2 values of materials outside their range") == 1);
  for (const json& bad :
       {json{{"texture", texture}, {"height", "high"}}, json{{"texture", texture}, {"deep", 3}},
        json{{"texture", {{"index", 99}}}}, json(3)}) {
    INFO(bad.dump());
    Asset broken = asset;
    broken.doc["materials"][0]["extras"]["lucerna"]["height"] = bad;
    CHECK_THROWS_WITH(broken.load(), Catch::Contains("height"));
  }
}

TEST_CASE("values outside their range are clamped, with one warning") {
  Asset asset;
  asset.textured_triangle(
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {2, 0, 0, 1}}, {"roughnessFactor", -1}, {"metallicFactor", 0.5}}},
       {"emissiveFactor", {-1, 0, 0}},
       {"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}});
  const Scene scene = asset.load();
  const Material& m = scene.materials[0];
  CHECK(m.base_color == vec4(1, 0, 0, 1));
  CHECK(m.roughness == 0);
  CHECK(m.emission == vec3(0));
  CHECK(m.ior == 1);
  CHECK(warnings_with(scene, "4 values of materials outside their range") == 1);
  CHECK(scene.warnings.size() == 1);
}

TEST_CASE("only used materials are kept, and unnamed ones get names") {
  Asset asset;
  asset.add("materials",
            {{"name", "unused"},
             {"normalTexture",
              {{"index", asset.add("textures", {{"source", asset.add("images", {{"uri", "no.png"}})}})}}}});
  asset.textured_triangle(json::object());
  const Scene scene = asset.load();
  REQUIRE(scene.materials.size() == 1);
  CHECK(scene.materials[0].name == "material 1");
  CHECK(scene.images.empty());
  CHECK(scene.warnings.empty());
  CHECK(scene.meshes[0].name == "mesh 0");
  CHECK(scene.instances[0].name == "node 0");
}

TEST_CASE("KHR_texture_transform") {
  Asset asset;
  const int texture = asset.add("textures", {{"source", asset.add("images", {{"uri", "no.png"}})}});
  const auto info = [&](const json& transform) {
    return json{{"index", texture}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
  };
  const auto use_of = [&](const json& transform) {
    Asset a = asset;
    a.textured_triangle({{"pbrMetallicRoughness", {{"baseColorTexture", info(transform)}}}});
    return a.load().materials[0].base_color_texture;
  };
  const auto close = [](vec2 a, vec2 b) { return glm::length(a - b) < 1e-6f; };
  CHECK(close(apply(use_of(json::object()), {0.3f, 0.7f}), {0.3f, 0.7f}));
  CHECK(close(apply(use_of({{"offset", {0.5, 0.25}}}), {0.25f, 0.25f}), {0.75f, 0.5f}));
  CHECK(close(apply(use_of({{"scale", {2, 3}}}), {0.25f, 0.25f}), {0.5f, 0.75f}));
  // A quarter turn takes +u to -v, which is up in a picture: counter-clockwise.
  CHECK(close(apply(use_of({{"rotation", k_pi / 2}}), {1, 0}), {0, -1}));
  CHECK(close(apply(use_of({{"rotation", k_pi / 2}}), {0, 1}), {1, 0}));
  // First scale, then rotation, then offset.
  CHECK(close(apply(use_of({{"offset", {10, 20}}, {"rotation", k_pi / 2}, {"scale", {2, 3}}}), {1, 1}),
              {13, 18}));
  CHECK(use_of(json::object()).uv_set == 0);
  CHECK(use_of({{"texCoord", 1}}).uv_set == 1);
}

TEST_CASE("texture coordinates: the first set, and two with any numbers that a material reads") {
  Asset asset;
  const int texture = asset.add("textures", {{"source", asset.add("images", {{"uri", "no.png"}})}});
  asset.textured_triangle(
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}, {"texCoord", 1}}}}}});
  asset.textured_triangle(
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}, {"texCoord", 2}}}}}});
  json pbr{{"baseColorTexture", {{"index", texture}, {"texCoord", 0}}},
           {"metallicRoughnessTexture", {{"index", texture}, {"texCoord", 2}}}};
  asset.textured_triangle({{"pbrMetallicRoughness", pbr},
                           {"emissiveTexture", {{"index", texture}, {"texCoord", 1}}},
                           {"emissiveFactor", {1, 1, 1}}});
  const int second = asset.accessor<float>("VEC2", {5, 5, 6, 5, 5, 6});
  for (json& mesh : asset.doc["meshes"]) mesh["primitives"][0]["attributes"]["TEXCOORD_2"] = second;
  const Scene scene = asset.load();
  CHECK(scene.materials[0].base_color_texture.uv_set == 1);
  CHECK(scene.meshes[0].primitives[0].uv0.at(1) == vec2(1, 0));  // for textures that are added by hand
  CHECK(scene.meshes[0].primitives[0].uv1.size() == 3);
  CHECK(scene.materials[1].base_color_texture.uv_set == 0);
  CHECK(scene.meshes[1].primitives[0].uv0.at(1) == vec2(6, 5));
  CHECK(scene.meshes[1].primitives[0].uv1.empty());
  CHECK(scene.materials[2].base_color_texture.uv_set == 0);
  CHECK(scene.materials[2].metallic_roughness_texture.uv_set == 1);
  CHECK(scene.meshes[2].primitives[0].uv0.at(1) == vec2(1, 0));
  CHECK(scene.meshes[2].primitives[0].uv1.at(1) == vec2(6, 5));
  CHECK_FALSE(scene.materials[2].emission_texture);
  CHECK(warnings_with(scene, "1 textures that use a third set of texture coordinates") == 1);
}

TEST_CASE("tangents exist exactly where a normal texture needs them") {
  Asset asset;
  const int texture = asset.add("textures", {{"source", asset.add("images", {{"uri", "no.png"}})}});
  asset.textured_triangle({{"normalTexture", {{"index", texture}, {"scale", 0.5}}}});
  asset.textured_triangle(json::object());
  json& given = asset.triangle();
  given["material"] = 0;
  given["attributes"]["NORMAL"] = asset.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  given["attributes"]["TANGENT"] = asset.accessor<float>("VEC4", {0, 2, 0, -1, 0, 2, 0, -1, 0, 0, 1, 1});
  const Scene scene = asset.load();
  CHECK(scene.materials[0].normal_scale == 0.5f);
  CHECK(scene.meshes[0].primitives[0].tangents.size() == 3);
  CHECK(scene.meshes[1].primitives[0].tangents.empty());
  const std::vector<vec4>& tangents = scene.meshes[2].primitives[0].tangents;
  REQUIRE(tangents.size() == 3);
  CHECK(tangents[0] == vec4(0, 1, 0, -1));
  CHECK(std::abs(tangents[2].z) < 1e-6f);  // along the normal: replaced by a tangent in the surface
  CHECK(warnings_with(scene, "1 tangents without a direction") == 1);
  CHECK(warnings_with(scene, "1 primitives have a textured material but lack the texture coordinates") == 1);
}

TEST_CASE("samplers, and one image used as colour and as data") {
  TempFolder folder;
  write_image<uint8_t>(folder / "i.png", 1, 1, 3, {10, 20, 30});
  Asset asset;
  const int image = asset.add("images", {{"uri", "i.png"}});
  asset.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  const int plain = asset.add("textures", {{"source", image}});
  const int same = asset.add("textures", {{"source", image}});
  const int sampled = asset.add("textures", {{"source", image}, {"sampler", 0}});
  asset.textured_triangle(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", plain}}}, {"metallicRoughnessTexture", {{"index", same}}}}},
       {"emissiveFactor", {1, 1, 1}},
       {"emissiveTexture", {{"index", sampled}}},
       {"occlusionTexture", {{"index", plain}}}});
  asset.textured_triangle({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", same}}}}}});
  const Scene scene = scene::load(asset.gltf(folder));
  CHECK(scene.images.size() == 1);
  REQUIRE(scene.textures.size() == 3);
  const Material& m = scene.materials[0];
  const scene::Texture& color = scene.textures[m.base_color_texture.texture];
  const scene::Texture& data = scene.textures[m.metallic_roughness_texture.texture];
  const scene::Texture& emission = scene.textures[m.emission_texture.texture];
  CHECK(color.srgb);
  CHECK_FALSE(data.srgb);
  CHECK(color.wrap_u == scene::Wrap::repeat);
  CHECK_FALSE(color.nearest);
  CHECK(emission.srgb);
  CHECK(emission.wrap_u == scene::Wrap::clamp);
  CHECK(emission.wrap_v == scene::Wrap::mirror);
  CHECK(emission.nearest);
  CHECK(scene.materials[1].base_color_texture.texture == m.base_color_texture.texture);
}

TEST_CASE("channels: grey, grey with alpha, RGB, RGBA with straight alpha") {
  TempFolder folder;
  const std::filesystem::path root = (folder / "x").parent_path();
  write_image<uint8_t>(folder / "1.png", 2, 1, 1, {10, 200});
  CHECK(load_image(root, {{"uri", "1.png"}}).bytes ==
        std::vector<uint8_t>{10, 10, 10, 255, 200, 200, 200, 255});
  write_image<uint8_t>(folder / "2.png", 1, 1, 2, {10, 100});
  CHECK(load_image(root, {{"uri", "2.png"}}).bytes == std::vector<uint8_t>{10, 10, 10, 100});
  write_image<uint8_t>(folder / "3.png", 1, 1, 3, {10, 20, 30});
  CHECK(load_image(root, {{"uri", "3.png"}}).bytes == std::vector<uint8_t>{10, 20, 30, 255});
  write_image<uint8_t>(folder / "4.png", 1, 1, 4, {200, 100, 50, 10});
  CHECK(load_image(root, {{"uri", "4.png"}}).bytes == std::vector<uint8_t>{200, 100, 50, 10});
}

TEST_CASE("rows run from the top") {
  TempFolder folder;
  write_image<uint8_t>(folder / "i.png", 1, 2, 1, {10, 200});
  const Image image = load_image((folder / "x").parent_path(), {{"uri", "i.png"}});
  CHECK(image.width == 1);
  CHECK(image.height == 2);
  CHECK(image.bytes[0] == 10);
}

TEST_CASE("16-bit files: floats as data, bytes as colour; float files stay floats") {
  TempFolder folder;
  const std::filesystem::path root = (folder / "x").parent_path();
  write_image<uint16_t>(folder / "w.png", 1, 1, 3, {0, 32768, 65535});
  const Image data = load_image(root, {{"uri", "w.png"}}, true);
  REQUIRE(data.floats.size() == 4);
  CHECK(data.bytes.empty());
  CHECK(data.floats[1] == Approx(32768.0 / 65535));
  CHECK(load_image(root, {{"uri", "w.png"}}).bytes == std::vector<uint8_t>{0, 128, 255, 255});
  for (const char* name : {"f.exr", "f.hdr"}) {
    write_image<float>(folder / name, 1, 1, 3, {0.5f, 2.0f, 8.0f});
    const Image image = load_image(root, {{"uri", name}});
    CHECK(image.floats == std::vector<float>{0.5f, 2.0f, 8.0f, 1.0f});
  }
}

TEST_CASE("non-finite texels are replaced and counted") {
  TempFolder folder;
  write_image<float>(folder / "f.exr", 2, 1, 3, {NAN, INFINITY, -1, 1, 1, 1});
  Asset asset;
  asset.textured_triangle(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", asset.add("textures", {{"source", asset.add("images", {{"uri", "f.exr"}})}})}}}}}});
  const Scene scene = scene::load(asset.gltf(folder));
  REQUIRE(scene.images[0].floats.size() == 8);
  CHECK(std::vector<float>(scene.images[0].floats.begin(), scene.images[0].floats.begin() + 4) ==
        std::vector<float>{0, 65504, 0, 1});
  CHECK(warnings_with(scene, "3 texel values") == 1);
}

TEST_CASE("images in data URIs, buffer views, files with odd names, JPEG") {
  TempFolder folder;
  const std::filesystem::path root = (folder / "x").parent_path();
  write_image<uint8_t>(folder / "i.png", 1, 1, 3, {1, 2, 3});
  const std::vector<uint8_t> png = bytes_of(folder / "i.png");
  CHECK(load_image(root, {{"uri", "data:image/png;base64," + base64(png)}}).bytes ==
        std::vector<uint8_t>{1, 2, 3, 255});
  // The bytes determine the format, not the name.
  std::filesystem::rename(folder / "i.png", folder / "a b+%.jpg");
  const Image odd = load_image(root, {{"uri", "a%20b+%25.jpg"}});
  CHECK(odd.bytes == std::vector<uint8_t>{1, 2, 3, 255});
  CHECK(odd.name == "a b+%.jpg");
  std::filesystem::rename(folder / "a b+%.jpg", folder / "50%.png");
  CHECK(load_image(root, {{"uri", "50%.png"}}).width == 1);  // accepted although it should be encoded

  write_image<float>(folder / "f.exr", 1, 1, 3, {1, 2, 3});
  CHECK(load_image(root, {{"uri", "data:image/x-exr;base64," + base64(bytes_of(folder / "f.exr"))}}).floats ==
        std::vector<float>{1, 2, 3, 1});

  write_image<uint8_t>(folder / "j.jpg", 8, 8, 3, std::vector<uint8_t>(192, 100));
  const Image jpeg = load_image(root, {{"uri", "j.jpg"}});
  CHECK(jpeg.width == 8);
  CHECK(std::abs(int(jpeg.bytes[0]) - 100) <= 1);

  Asset asset;
  const int image =
      asset.add("images", {{"bufferView", asset.view(png)}, {"mimeType", "image/png"}, {"name", "inside"}});
  asset.textured_triangle(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", asset.add("textures", {{"source", image}})}}}}}});
  const Scene scene = scene::load(asset.glb(folder));
  REQUIRE(scene.images.size() == 1);
  CHECK(scene.images[0].name == "inside");
  CHECK(scene.images[0].bytes == std::vector<uint8_t>{1, 2, 3, 255});
}

TEST_CASE("missing images are replaced by neutral texels") {
  TempFolder folder;
  write_image<uint8_t>(folder / "i.png", 4, 4, 3, std::vector<uint8_t>(48, 9));
  Asset asset;
  asset.textured_triangle(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", asset.add("textures", {{"source", asset.add("images", {{"uri", "i.png"}})}})}}}}}});
  scene::LoadOptions options;
  options.images = false;
  const Scene scene = scene::load(asset.gltf(folder), options);
  REQUIRE(scene.images.size() == 1);
  CHECK(scene.images[0].width == 1);
  CHECK(scene.warnings.empty());
}

}  // namespace scene_material_tests
