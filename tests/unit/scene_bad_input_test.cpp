// links: scene_io
// Every kind of damage that the loader detects: one located message, no crash; or a warning with a count.
#include <cmath>

#include "unit/scene_support.h"

namespace scene_bad_input_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
using scene::Scene;

namespace {

Asset good() {
  Asset asset;
  asset.triangle();
  return asset;
}

// A triangle with one change.
template <class Change>
std::string broken(Change change) {
  Asset asset = good();
  change(asset);
  return failure(asset);
}

}  // namespace

TEST_CASE("the undamaged file loads") { CHECK(failure(good()).empty()); }

TEST_CASE("files that are missing, empty, or not glTF") {
  TempFolder folder;
  CHECK(failure(folder / "no.gltf") == (folder / "no.gltf").string() + ": no such file");
  write(folder / "empty.gltf", "");
  CHECK_THAT(failure(folder / "empty.gltf"), EndsWith("empty.gltf: the file is empty"));
  std::filesystem::create_directory(folder / "dir.gltf");
  CHECK_THAT(failure(folder / "dir.gltf"), EndsWith("dir.gltf: not a regular file"));
  write(folder / "text.gltf", "{\n\"asset\": oops\n}");
  CHECK_THAT(failure(folder / "text.gltf"), Contains("text.gltf:2: not valid JSON"));
  write(folder / "list.gltf", "[1, 2, 3]");
  CHECK_THAT(failure(folder / "list.gltf"), Contains("expected an object, found array"));
  write(folder / "deep.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"extras\": " + std::string(100000, '[') +
                                  std::string(100000, ']') + "}");
  CHECK_THAT(failure(folder / "deep.gltf"), Contains("nested more than 256 levels"));
  write(folder / "huge.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"x\": 1e999}");
  CHECK_THAT(failure(folder / "huge.gltf"), Contains("not valid JSON"));
  const std::string bad_utf8 = "{\"asset\": {\"version\": \"2.0\xff\"}}";
  write(folder / "utf8.gltf", bad_utf8);
  CHECK_THAT(failure(folder / "utf8.gltf"), Contains("not valid JSON"));
}

TEST_CASE("unsupported glTF versions") {
  CHECK_THAT(broken([](Asset& a) { a.doc.erase("asset"); }), Contains("'asset' is missing"));
  CHECK_THAT(broken([](Asset& a) { a.doc["asset"]["version"] = "1.0"; }),
             Contains("asset.version: '1.0', expected 2.0"));
  CHECK_THAT(broken([](Asset& a) { a.doc["asset"]["minVersion"] = "2.1"; }), Contains("asset.minVersion"));
}

TEST_CASE(".glb: header and chunks") {
  TempFolder folder;
  const std::vector<uint8_t> whole = good().glb_bytes();
  const auto with = [&](size_t at, uint8_t value) {
    std::vector<uint8_t> bytes = whole;
    bytes[at] = value;
    write(folder / "x.glb", bytes.data(), bytes.size());
    return failure(folder / "x.glb");
  };
  write(folder / "x.glb", whole.data(), whole.size());
  CHECK(failure(folder / "x.glb").empty());
  CHECK_THAT(with(4, 1), Contains("container version 1"));
  CHECK_THAT(with(10, 0xff), Contains("truncated .glb"));
  CHECK_THAT(with(14, 0xff), Contains("truncated .glb: chunk 0 claims"));
  CHECK_THAT(with(16, 'X'), Contains("first chunk of a .glb must be JSON"));
  write(folder / "x.glb", whole.data(), whole.size() - 1);
  CHECK_THAT(failure(folder / "x.glb"), Contains("x.glb: truncated .glb"));
  // The content counts, not the name.
  write(folder / "y.gltf", whole.data(), whole.size());
  CHECK(failure(folder / "y.gltf").empty());
}

TEST_CASE("positions that are not finite") {
  for (const float bad : {NAN, INFINITY, -INFINITY, 1e20f}) {
    Asset asset;
    asset.mesh(
        {{"attributes", {{"POSITION", asset.accessor<float>("VEC3", {0, 0, 0, 1, bad, 0, 0, 1, 0})}}}});
    CHECK_THAT(failure(asset),
               Contains("a.gltf: meshes[0].primitives[0].attributes.POSITION: vertex 1 is (1, "));
  }
}

TEST_CASE("indices out of range") {
  const auto with_index = [](auto value) {
    Asset asset = good();
    asset.doc["meshes"][0]["primitives"][0]["indices"] =
        asset.accessor<decltype(value)>("SCALAR", {0, 1, value});
    return failure(asset);
  };
  CHECK_THAT(with_index(uint8_t{3}),
             EndsWith("a.gltf: meshes[0].primitives[0].indices: index 2 is 3, but there are 3 vertices"));
  CHECK_THAT(with_index(uint16_t{65535}), Contains("index 2 is 65535"));
  CHECK_THAT(with_index(0xffffffffu), Contains("index 2 is 4294967295"));
  CHECK_THAT(broken([](Asset& a) {
               a.doc["meshes"][0]["primitives"][0]["indices"] = a.accessor<float>("SCALAR", {0, 1, 2});
             }),
             Contains("primitives[0].indices: expected scalars of an unsigned integer type"));
}

TEST_CASE("references to missing objects") {
  CHECK_THAT(broken([](Asset& a) { a.doc["scene"] = 3; }),
             Contains("a.gltf: scene: 3 is not an index of scenes (there are 1)"));
  CHECK_THAT(broken([](Asset& a) { a.doc["scenes"][0]["nodes"] = {7}; }),
             Contains("scenes[0].nodes[0]: 7 is not an index of nodes"));
  CHECK_THAT(broken([](Asset& a) { a.doc["nodes"][0]["mesh"] = 1; }),
             Contains("nodes[0].mesh: 1 is not an index of meshes"));
  CHECK_THAT(broken([](Asset& a) { a.doc["nodes"][0]["mesh"] = -1; }),
             Contains("nodes[0].mesh: -1 is not an index"));
  CHECK_THAT(broken([](Asset& a) { a.doc["nodes"][0]["camera"] = 0; }),
             Contains("nodes[0].camera: 0 is not an index of cameras"));
  CHECK_THAT(broken([](Asset& a) { a.doc["nodes"][0]["children"] = {9}; }),
             Contains("nodes[0].children[0]: 9"));
  CHECK_THAT(broken([](Asset& a) { a.doc["meshes"][0]["primitives"][0]["material"] = 0; }),
             Contains("primitives[0].material: 0 is not an index of materials"));
  CHECK_THAT(broken([](Asset& a) { a.doc["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 5; }),
             Contains("attributes.POSITION: 5 is not an index of accessors"));
  CHECK_THAT(broken([](Asset& a) { a.doc["accessors"][0]["bufferView"] = 4; }),
             Contains("accessors[0].bufferView: 4 is not an index of bufferViews"));
  CHECK_THAT(broken([](Asset& a) { a.doc["bufferViews"][0]["buffer"] = 1; }),
             Contains("bufferViews[0].buffer: 1 is not an index of buffers"));
  CHECK_THAT(broken([](Asset& a) {
               a.doc["meshes"][0]["primitives"][0]["material"] =
                   a.add("materials", {{"normalTexture", {{"index", 2}}}});
             }),
             Contains("materials[0].normalTexture.index: 2 is not an index of textures"));
  CHECK_THAT(broken([](Asset& a) { a.doc["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0; }),
             Contains("KHR_lights_punctual"));
}

TEST_CASE("values of a wrong type or size") {
  CHECK_THAT(broken([](Asset& a) {
               a.doc["nodes"][0]["matrix"] = {1, 2, 3};
             }),
             Contains("nodes[0].matrix: expected 16 numbers, found 3"));
  CHECK_THAT(broken([](Asset& a) {
               a.doc["nodes"][0]["translation"] = {1, "2", 3};
             }),
             Contains("nodes[0].translation[1]: expected a number, found string"));
  CHECK_THAT(broken([](Asset& a) { a.doc["nodes"] = 5; }),
             Contains("nodes: expected an array, found number"));
  CHECK_THAT(broken([](Asset& a) { a.doc["nodes"][0] = nullptr; }),
             Contains("nodes[0]: expected an object, found null"));
  CHECK_THAT(broken([](Asset& a) { a.doc["accessors"][0]["type"] = "VEC5"; }),
             Contains("accessors[0].type: 'VEC5'"));
  CHECK_THAT(broken([](Asset& a) { a.doc["accessors"][0]["type"] = "VEC2"; }),
             Contains("attributes.POSITION: 2 components, expected 3"));
  CHECK_THAT(broken([](Asset& a) { a.doc["accessors"][0]["componentType"] = 5130; }),
             Contains("accessors[0].componentType: 5130"));
  CHECK_THAT(broken([](Asset& a) { a.doc["accessors"][0]["count"] = 2.5; }),
             Contains("accessors[0].count: expected a whole number"));
  CHECK_THAT(broken([](Asset& a) { a.doc["meshes"][0]["primitives"] = json::array(); }),
             Contains("meshes[0].primitives: expected at least one"));
  CHECK_THAT(broken([](Asset& a) { a.doc["meshes"][0]["primitives"][0]["mode"] = 7; }),
             Contains("primitives[0].mode: 7 is outside 0 to 6"));
  CHECK_THAT(broken([](Asset& a) {
               a.doc["meshes"][0]["primitives"][0]["material"] = a.add("materials", {{"alphaMode", "GLASS"}});
             }),
             Contains("materials[0].alphaMode: 'GLASS', expected OPAQUE, MASK or BLEND"));
  CHECK_THAT(broken([](Asset& a) {
               a.doc["meshes"][0]["primitives"][0]["material"] =
                   a.add("materials", {{"pbrMetallicRoughness", {{"roughnessFactor", "x"}}}});
             }),
             Contains("materials[0].pbrMetallicRoughness.roughnessFactor: expected a number, found string"));
  // A whole number written as 3.0 is accepted.
  CHECK(broken([](Asset& a) { a.doc["accessors"][0]["count"] = 3.0; }).empty());
}

TEST_CASE("accessors beyond views, views beyond buffers, buffers shorter than they claim") {
  CHECK_THAT(
      broken([](Asset& a) { a.doc["accessors"][0]["count"] = 4; }),
      Contains("accessors[0]: 4 elements of 12 bytes from offset 0 go beyond the buffer view's 36 bytes"));
  CHECK_THAT(broken([](Asset& a) { a.doc["accessors"][0]["byteOffset"] = 1; }), Contains("accessors[0]"));
  CHECK_THAT(broken([](Asset& a) { a.doc["bufferViews"][0]["byteLength"] = 40; }),
             Contains("bufferViews[0]: bytes 0 to 40 are outside the buffer's 36 bytes"));
  CHECK_THAT(broken([](Asset& a) { a.doc["bufferViews"][0]["byteOffset"] = 4; }), Contains("bufferViews[0]"));
  CHECK_THAT(broken([](Asset& a) { a.doc["bufferViews"][0]["byteStride"] = 8; }),
             Contains("does not fit the view's byteStride of 8"));
  CHECK_THAT(broken([](Asset& a) {
               a.doc["accessors"][0]["sparse"] = {
                   {"count", 4}, {"indices", json::object()}, {"values", json::object()}};
             }),
             Contains("accessors[0].sparse.count: 4 is outside 0 to 3"));
  CHECK_THAT(broken([](Asset& a) {
               const int where = a.view(std::vector<uint16_t>{3});
               const int what = a.view(std::vector<float>{1, 2, 3});
               a.doc["accessors"][0]["sparse"] = {
                   {"count", 1},
                   {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                   {"values", {{"bufferView", what}}}};
             }),
             Contains("accessors[0].sparse.indices: entry 0 is 3, but the accessor has 3 elements"));
  CHECK_THAT(
      broken([](Asset& a) {
        a.doc["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = a.accessor<float>("VEC3", {0, 0, 1});
      }),
      Contains("attributes.NORMAL: 1 elements, but POSITION has 3"));

  TempFolder folder;
  Asset asset = good();
  json doc = asset.complete(false);
  doc["buffers"][0]["uri"] = "short.bin";
  write(folder / "short.bin", asset.bin.data(), 35);
  write(folder / "a.gltf", doc.dump());
  CHECK_THAT(failure(folder / "a.gltf"),
             Contains("a.gltf: buffers[0]: byteLength is 36, but only 35 bytes are there"));
  std::filesystem::remove(folder / "short.bin");
  CHECK_THAT(failure(folder / "a.gltf"), Contains("a.gltf: buffers[0].uri: no such file"));
  doc["buffers"][0]["uri"] = "/dev/zero";
  write(folder / "a.gltf", doc.dump());
  CHECK_THROWS_WITH(scene::load(folder / "a.gltf", {.outside = true}), Contains("not a regular file"));
  doc["buffers"][0]["uri"] = "data:application/octet-stream;base64,@@@@";
  write(folder / "a.gltf", doc.dump());
  CHECK_THAT(failure(folder / "a.gltf"),
             Contains("buffers[0].uri: character 37 of the data URI is not base64"));
  doc["buffers"][0].erase("uri");
  write(folder / "a.gltf", doc.dump());
  CHECK_THAT(failure(folder / "a.gltf"), Contains("buffers[0]: 'uri' is missing"));
  // More bytes than byteLength are allowed.
  asset.bin.resize(100);
  doc["buffers"][0]["uri"] = "data:;base64," + base64(asset.bin);
  write(folder / "a.gltf", doc.dump());
  CHECK(failure(folder / "a.gltf").empty());
}

TEST_CASE("absurd sizes are refused before memory is allocated") {
  CHECK_THAT(broken([](Asset& a) { a.doc["accessors"][0]["count"] = 1e18; }), Contains("accessors[0].count"));
  CHECK_THAT(broken([](Asset& a) {
               a.doc["accessors"][0] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 2000000000}};
             }),
             Contains("accessors[0]: 2000000000 elements without a buffer view"));
  CHECK_THAT(broken([](Asset& a) { a.doc["bufferViews"][0]["byteLength"] = 1e300; }),
             Contains("bufferViews[0].byteLength"));
  CHECK_THAT(broken([](Asset& a) { a.doc["bufferViews"][0]["byteOffset"] = 9007199254740991; }),
             Contains("bufferViews[0].byteOffset"));
  TempFolder folder;
  json doc = good().complete(true);
  doc["buffers"][0]["byteLength"] = 1000000000000;
  write(folder / "a.gltf", doc.dump());
  CHECK_THAT(failure(folder / "a.gltf"),
             Contains("buffers[0]: byteLength is 1000000000000, but only 36 bytes are there"));
}

TEST_CASE("matrices above a visible object") {
  CHECK_THAT(broken([](Asset& a) {
               a.doc["nodes"][0]["matrix"] = {1e38, 0, 0, 0, 0, 1e38, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
             }),
             Contains("nodes[0]: the node's matrix in the world is not finite"));
  CHECK_THAT(broken([](Asset& a) {
               a.doc["nodes"][0]["rotation"] = {0, 0, 0, 0};
             }),
             Contains("nodes[0].rotation: a quaternion of length 0"));
  // Harmless without children.
  CHECK(broken([](Asset& a) {
          a.doc["scenes"][0]["nodes"].push_back(a.add("nodes", {{"rotation", {0, 0, 0, 0}}}));
        }).empty());
  // Small but valid.
  CHECK(broken([](Asset& a) { a.doc["nodes"][0]["scale"] = {1e-4, 1e-4, 1e-4}; }).empty());
  // Each matrix is valid, their product is not finite.
  CHECK_THAT(broken([](Asset& a) {
               a.doc["nodes"][0]["translation"] = {1e12, 0, 0};
             }),
             Contains("places geometry beyond"));
}

TEST_CASE("node graphs that are no forest") {
  const auto with_nodes = [](const json& nodes, const json& roots) {
    Asset a = good();
    a.doc["nodes"] = nodes;
    a.doc["scenes"][0]["nodes"] = roots;
    return failure(a);
  };
  const json itself = json::array({{{"children", {0}}}}), root = json::array({0});
  CHECK_THAT(with_nodes(itself, root), Contains("nodes[0]: the node graph is cyclic"));
  const json ring = json::array({{{"children", {1}}}, {{"children", {2}}}, {{"children", {0}}}});
  CHECK_THAT(with_nodes(ring, root), Contains("nodes[0]: the node graph is cyclic"));
  CHECK_THAT(with_nodes({{{"children", {1}}}, {{"children", {0}}}, json::object()}, {2}),
             Contains("the node graph is cyclic"));
  CHECK_THAT(with_nodes({{{"children", {0}}}, json::object()}, {1}),
             Contains("nodes[0]: the node graph is cyclic"));
  CHECK_THAT(with_nodes({{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}}, {0, 1}),
             Contains("nodes[1].children[0]: node 2 already is a child of node 0"));
  CHECK_THAT(with_nodes({{{"children", {1, 1}}}, {{"mesh", 0}}}, {0}),
             Contains("nodes[0].children[1]: node 1 already is a child"));
  CHECK_THAT(with_nodes({{{"children", {1}}}, {{"mesh", 0}}}, {0, 1}),
             Contains("scenes[0].nodes[1]: node 1 is a child of node 0, not a root"));
  CHECK_THAT(with_nodes({{{"mesh", 0}}}, {0, 0}), Contains("scenes[0].nodes[1]: node 0 is listed twice"));
}

TEST_CASE("a hierarchy of 100 000 levels does not overflow the stack") {
  Asset a = good();
  json nodes = json::array();
  for (int i = 0; i < 100000; ++i) nodes.push_back({{"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}});
  a.doc["nodes"] = nodes;
  CHECK(scene::count_triangles(a.load()) == 1);
}

TEST_CASE("extensions: a required unknown one is an error, an optional unknown one a warning") {
  CHECK_THAT(
      broken([](Asset& a) { a.doc["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
      Contains(
          "extensionsRequired[0]: the file requires KHR_draco_mesh_compression, which is not known here"));
  Asset a = good();
  a.triangle();
  a.doc["extensionsUsed"] = {"KHR_materials_subsurface", "EXT_never", "KHR_materials_ior"};
  for (int i : {0, 1})
    a.doc["meshes"][i]["primitives"][0]["material"] =
        a.add("materials", {{"extensions", {{"KHR_materials_subsurface", json::object()}}}});
  const Scene scene = a.load();
  CHECK(warnings_with(scene, "KHR_materials_subsurface is not known and ignored") == 1);
  CHECK(warnings_with(scene, "EXT_never is not known") == 1);
  CHECK(scene.warnings.size() == 2);
  CHECK(scene.unknown_extensions == std::vector<std::string>{"EXT_never", "KHR_materials_subsurface"});
  CHECK(scene.extensions == std::vector<std::string>{"KHR_materials_ior"});
}

TEST_CASE("images that are missing, damaged or empty are replaced and counted") {
  TempFolder folder;
  Asset a;
  write(folder / "damaged.png", "\x89PNG this is none");
  write(folder / "empty.png", "");
  write(folder / "text.jpg", "no picture at all");
  write_image<uint8_t>(folder / "whole.png", 2, 2, 3, std::vector<uint8_t>(12, 77));
  const std::vector<uint8_t> png = bytes_of(folder / "whole.png");
  write(folder / "cut.png", png.data(), png.size() / 2);
  std::vector<uint8_t> zero = png;  // width and height are in bytes 16 to 23
  std::fill(zero.begin() + 16, zero.begin() + 24, uint8_t{0});
  write(folder / "zero.png", zero.data(), zero.size());
  std::vector<uint8_t> vast = png;
  std::fill(vast.begin() + 16, vast.begin() + 24, uint8_t{0x7f});
  write(folder / "vast.png", vast.data(), vast.size());
  const std::vector<std::string> names{"missing.png", "damaged.png", "empty.png", "text.jpg",
                                       "cut.png",     "zero.png",    "vast.png"};
  for (const std::string& name : names) {
    const int texture = a.add("textures", {{"source", a.add("images", {{"uri", name}})}});
    a.textured_triangle({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}},
                         {"normalTexture", {{"index", texture}}}});
  }
  const int no_data = a.add("textures", {{"source", a.add("images", {{"uri", "data:image/png;base64,"}})}});
  a.textured_triangle({{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", no_data}}}});
  a.textured_triangle(
      {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", a.add("textures", json::object())}}}});
  const Scene scene = scene::load(a.gltf(folder));
  CHECK(warnings_with(scene, "8 images cannot be used") == 1);
  CHECK(warnings_with(scene, "missing.png") == 1);
  CHECK(warnings_with(scene, "1 textures have no image") == 1);
  REQUIRE(scene.materials.size() == 9);
  for (const scene::Material& m : scene.materials) {
    if (m.emission != vec3(0)) {
      const scene::Image& image = scene.images[scene.textures[m.emission_texture.texture].image];
      CHECK(image.bytes == std::vector<uint8_t>{255, 255, 255, 255});
      continue;
    }
    const scene::Image& color = scene.images[scene.textures[m.base_color_texture.texture].image];
    const scene::Image& normal = scene.images[scene.textures[m.normal_texture.texture].image];
    CHECK(color.bytes == std::vector<uint8_t>{255, 255, 255, 255});
    CHECK(normal.bytes == std::vector<uint8_t>{128, 128, 255, 255});
    CHECK(normal.width == 1);
  }
}

TEST_CASE("invalid environments and settings") {
  TempFolder folder;
  const std::filesystem::path file = good().gltf(folder);
  const auto with = [&](const std::string& settings) {
    write(folder / "settings.json", settings);
    return failure(file);
  };
  CHECK(with("{}").empty());
  CHECK_THAT(with("{"), Contains("settings.json:1: not valid JSON"));
  CHECK_THAT(with("[]"), Contains("settings.json: expected an object, found array"));
  CHECK_THAT(with("{\"samples\": [1]}"),
             Contains("settings.json: samples: expected a number, a string, true or false, found array"));
  CHECK_THAT(with("{\"film\": {\"ev\": null}}"), Contains("settings.json: film.ev: expected"));
  CHECK_THAT(with("{\"environment\": 3}"), Contains("settings.json: environment: expected an object"));
  CHECK_THAT(with("{\"environment\": {}}"), Contains("environment: expected 'radiance', 'file' or 'sky'"));
  CHECK_THAT(with("{\"environment\": {\"radiance\": [1, 1]}}"),
             Contains("environment.radiance: expected 3 numbers, found 2"));
  CHECK_THAT(with("{\"environment\": {\"radiance\": [1, 1, -1]}}"),
             Contains("environment.radiance: radiance is negative"));
  CHECK_THAT(with("{\"environment\": {\"radiance\": [1, 1, 1], \"sun\": 2}}"),
             Contains("environment.sun: unknown key; known are radiance, file, sky, scale, rotation"));
  CHECK_THAT(with("{\"environment\": {\"radiance\": [1, 1, 1], \"file\": \"x.exr\"}}"),
             Contains("exclude each other"));
  CHECK_THAT(with("{\"environment\": {\"file\": \"no.exr\"}}"),
             Contains("settings.json: environment.file: no such file"));
  CHECK_THAT(with("{\"environment\": {\"radiance\": [1, 1, 1], \"scale\": -1}}"),
             Contains("environment.scale: -1 is negative"));
  write(folder / "bad.exr", "v/1\x01 not an image");
  CHECK_THAT(with("{\"environment\": {\"file\": \"bad.exr\"}}"),
             Contains("environment.file: the image cannot be decoded"));
  std::filesystem::remove(folder / "settings.json");
  Asset a = good();
  a.doc["scenes"][0]["extras"]["environment"] = {{"type", "equirectangular"}, {"file", "no.hdr"}};
  CHECK_THAT(failure(a.gltf(folder)), Contains("a.gltf: scenes[0].extras.environment.file: no such file"));
}

}  // namespace scene_bad_input_tests
