// links: scene_io
// Loading takes no more memory, and no more time, than LoadOptions allows: small files that need too much are
// refused with the limit and the cause.
#include "unit/scene_support.h"

namespace scene_memory_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;

namespace {

constexpr uint64_t k_mib = 1 << 20;

std::string refusal(const Asset& asset, uint64_t bytes) {
  const TempFolder folder;
  try {
    scene::load(asset.gltf(folder), {.most_bytes = bytes});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

json instancing(int translations) {
  return {{"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", translations}}}}}}}};
}

}  // namespace

TEST_CASE("instances beyond any buffer are refused, however small the file") {
  Asset asset;
  asset.triangle(
      instancing(asset.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 1 << 24}})));
  CHECK_THAT(failure(asset),
             Contains("EXT_mesh_gpu_instancing.attributes: 16777216 instances, of which no attribute has a "
                      "buffer view"));
}

TEST_CASE("every instance counts with its world-space geometry") {
  Asset asset;
  const int places = asset.accessor<float>("VEC3", std::vector<float>(3 * 1000, 1.0f));
  asset.triangle(instancing(places));
  CHECK(refusal(asset, 2 * k_mib).empty());
  // 1000 triangles and 3000 vertices in world space.
  CHECK_THAT(refusal(asset, k_mib / 2),
             Contains("node 'node 0 #") &&
                 Contains("another instance of mesh 'mesh 0' with 1 triangles, would take 0.00 GiB more") &&
                 Contains("--scene-memory GIB allows more"));
  // Nodes that share an accessor and a mesh.
  for (int i = 0; i < 99; ++i) {
    json node = instancing(places);
    node["mesh"] = 0;
    asset.doc["scenes"][0]["nodes"].push_back(asset.add("nodes", node));
  }
  CHECK_THAT(refusal(asset, 4 * k_mib), Contains("EXT_mesh_gpu_instancing: 1000 instances would take"));
}

TEST_CASE("primitives that share accessors count with their own copies") {
  Asset asset;
  asset.triangle();
  constexpr size_t k_vertices = 40000;
  std::vector<float> line;
  for (size_t i = 0; i < 3 * k_vertices; ++i) line.push_back(static_cast<float>(i * i % 1013));
  const int shared = asset.accessor<float>("VEC3", line);
  json& primitives = asset.doc["meshes"][0]["primitives"];
  for (int i = 0; i < 20; ++i) primitives.push_back({{"attributes", {{"POSITION", shared}}}});
  CHECK(refusal(asset, 400 * k_mib).empty());
  // 40 000 vertices of at most 72 bytes, 3 of these per triangle: 20 times, plus world space.
  CHECK_THAT(refusal(asset, 30 * k_mib), Contains("meshes[0].primitives[") && Contains(" would take "));
}

TEST_CASE("primitives of few triangles in a large buffer take time for their triangles only") {
  // 3000 primitives of one triangle over 4 million vertices: visiting every vertex for each of them would be
  // 12 thousand million visits.
  Asset asset;
  asset.triangle();
  const int large = asset.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 1 << 22}});
  const int entries = asset.view(std::vector<uint32_t>{0, 1, 1 << 21, (1 << 22) - 1});
  const int values = asset.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 2, 0});
  asset.doc["accessors"][large]["sparse"] = {{"count", 4},
                                             {"indices", {{"bufferView", entries}, {"componentType", 5125}}},
                                             {"values", {{"bufferView", values}}}};
  const int indices = asset.accessor<uint32_t>("SCALAR", {0, 1u << 21, (1u << 22) - 1});
  json& primitives = asset.doc["meshes"][0]["primitives"];
  for (int i = 0; i < 3000; ++i)
    primitives.push_back({{"attributes", {{"POSITION", large}}}, {"indices", indices}});
  const TempFolder folder;
  // The sparse accessor is expanded once: 50 MB. Twice would exceed the limit.
  const scene::Scene scene = scene::load(asset.gltf(folder), {.most_bytes = 80 * k_mib});
  REQUIRE(scene.meshes[0].primitives.size() == 3001);
  CHECK(scene.meshes[0].primitives[3000].positions == std::vector<vec3>{{0, 0, 0}, {0, 1, 0}, {2, 2, 0}});
}

TEST_CASE("images and files count before they are decoded") {
  const TempFolder folder;
  write_image<uint8_t>(folder / "large.png", 2048, 2048, 4, std::vector<uint8_t>(size_t{4} << 22, 7));
  Asset asset;
  const int texture = asset.add("textures", {{"source", asset.add("images", {{"uri", "large.png"}})}});
  asset.textured_triangle({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  const auto file = asset.gltf(folder);
  CHECK(scene::load(file, {.most_bytes = 20 * k_mib}).images[0].width == 2048);
  CHECK_THROWS_WITH(
      scene::load(file, {.most_bytes = 10 * k_mib}),
      Contains("a.gltf: images[0]: an image of 2048 x 2048 would take 0.02 GiB more, beyond the "
               "0.01 GiB that a scene may have"));
  // A sparse file, which takes no disk space.
  json doc = asset.complete(false);
  doc["buffers"][0]["uri"] = "hole.bin";
  write(folder / "hole.gltf", doc.dump());
  write(folder / "hole.bin", "");
  std::filesystem::resize_file(folder / "hole.bin", uint64_t{1} << 36);
  CHECK_THROWS_WITH(
      scene::load(folder / "hole.gltf"),
      Contains("hole.gltf: buffers[0].uri: a file of 68719476736 bytes would take 64.00 GiB more, "
               "beyond the 8.00 GiB"));
}

}  // namespace scene_memory_tests
