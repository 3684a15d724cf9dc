// links: scene_io
// Changes of meshes by nodes before placement: scale 0, skins, morph targets (glTF 2.0, 3.5.3, 3.7.2.2 and
// 3.7.3).
#include <cmath>

#include "unit/scene_support.h"

namespace scene_pose_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
using scene::Primitive;
using scene::Scene;

namespace {

bool close(const vec3& a, const vec3& b, float tolerance = 1e-5f) { return glm::length(a - b) < tolerance; }

void check_bounds(const Scene& scene, const vec3& lo, const vec3& hi) {
  const Box box = scene::bounds(scene);
  CAPTURE(box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z);
  CHECK(close(box.lo, lo));
  CHECK(close(box.hi, hi));
}

/// A unit cube with normals, with its corner (0, 0, 0) at `at`.
json cube(Asset& asset, const vec3& at = vec3(0)) {
  std::vector<float> positions, normals;
  std::vector<uint16_t> indices;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const auto first = static_cast<uint16_t>(positions.size() / 3);
      for (int corner = 0; corner < 4; ++corner) {
        vec3 p(0), n(0);
        p[axis] = static_cast<float>(side);
        p[(axis + 1) % 3] = static_cast<float>(corner & 1);
        p[(axis + 2) % 3] = static_cast<float>(corner >> 1);
        n[axis] = side ? 1.f : -1.f;
        p += at;
        positions.insert(positions.end(), {p.x, p.y, p.z});
        normals.insert(normals.end(), {n.x, n.y, n.z});
      }
      for (const int k : side ? std::vector<int>{0, 1, 3, 0, 3, 2} : std::vector<int>{0, 3, 1, 0, 2, 3})
        indices.push_back(static_cast<uint16_t>(first + k));
    }
  return {{"attributes",
           {{"POSITION", asset.accessor("VEC3", positions)}, {"NORMAL", asset.accessor("VEC3", normals)}}},
          {"indices", asset.accessor("SCALAR", indices)}};
}

/// Checks that face normals and vertex normals agree, and point away from `centre`.
void check_outside(const Scene& scene, const vec3& centre) {
  for (const scene::Instance& instance : std::as_const(scene.instances))
    for (const Primitive& p : scene.meshes[instance.mesh].primitives)
      for (const uvec3& t : p.triangles) {
        const auto at = [&](uint32_t i) { return vec3(instance.to_world * vec4(p.positions[i], 1)); };
        const vec3 face = glm::cross(at(t.y) - at(t.x), at(t.z) - at(t.x)) * (instance.flipped ? -1.f : 1.f);
        CHECK(glm::dot(face, at(t.x) - centre) > 0);
        CHECK(glm::dot(glm::normalize(face), p.normals[t.x]) > 0.999f);
      }
}

const json k_ground{{"name", "ground"}};

}  // namespace

TEST_CASE("scale 0 hides a node and its children; the file loads") {
  Asset asset;
  asset.triangle(k_ground);
  asset.mesh(cube(asset), {{"name", "prop"}});
  const int rig = asset.add("nodes", {{"scale", {0, 0, 0}}, {"children", {1, 3, 4}}});
  asset.doc["scenes"][0]["nodes"] = {0, rig};
  asset.add("nodes", {{"camera", asset.add("cameras", {{"type", "perspective"},
                                                       {"perspective", {{"yfov", 1}, {"znear", 0.1}}}})}});
  asset.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  asset.doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  const Scene scene = asset.load();
  REQUIRE(scene.instances.size() == 1);
  CHECK(scene.instances[0].name == "ground");
  CHECK(scene.meshes.size() == 1);
  CHECK(scene.cameras.empty());
  CHECK(scene.lights.empty());
  CHECK(warnings_with(scene, "1 meshes in nodes or instances of scale 0: left out (nodes[1])") == 1);
  CHECK(warnings_with(scene, "2 cameras or lamps in nodes of scale 0: left out") == 1);
  // A single remaining axis is invisible too.
  asset.doc["nodes"][static_cast<size_t>(rig)]["scale"] = {1, 0, 0};
  CHECK(asset.load().instances.size() == 1);
}

TEST_CASE("a flat node shows its mesh flat") {
  Asset asset;
  asset.mesh(cube(asset), {{"scale", {2, 0, 2}}, {"translation", {0, 5, 0}}});
  Scene scene = asset.load();
  REQUIRE(scene.instances.size() == 1);
  CHECK(scene::count_triangles(scene) == 4);
  check_bounds(scene, {0, 5, 0}, {2, 5, 2});
  CHECK(glm::determinant(mat3(scene.instances[0].to_world)) == 1);
  for (const vec3& n : std::as_const(scene.meshes)[0].primitives[0].normals)
    CHECK(close(glm::abs(n), {0, 1, 0}));
  // Also by a matrix that shears y to x.
  asset.doc["nodes"][0] = {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  scene = asset.load();
  check_bounds(scene, {0, 0, 0}, {3, 0, 1});
}

TEST_CASE("cameras and lights in a flat node keep their orientation") {
  Asset asset;
  asset.triangle();
  const double s = std::sqrt(0.5);
  // A quarter turn about y takes -Z to -X.
  const int rig =
      asset.add("nodes", {{"rotation", {0, s, 0, s}}, {"scale", {1, 1, 0}}, {"children", {2, 3}}});
  asset.doc["scenes"][0]["nodes"] = {0, rig};
  asset.add("nodes", {{"camera", asset.add("cameras", {{"type", "perspective"},
                                                       {"perspective", {{"yfov", 1}, {"znear", 0.1}}}})}});
  asset.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  asset.doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}}};
  const Scene scene = asset.load();
  REQUIRE(scene.cameras.size() == 1);
  CHECK(close(vec3(scene.cameras[0].to_world[2]), {1, 0, 0}));
  CHECK(close(vec3(scene.cameras[0].to_world[1]), {0, 1, 0}));
  REQUIRE(scene.lights.size() == 1);
  CHECK(close(scene.lights[0].direction, {-1, 0, 0}));
}

namespace {

constexpr int k_joint = 1;  // node of the skin's first joint in skinned()

/// A cube of 100 units around the joint, as an exporter in centimetres writes it: bind matrices scale it to 1
/// m.
Asset skinned(const json& node = json::object()) {
  Asset asset;
  json primitive = cube(asset);
  auto positions = std::vector<float>();
  for (int i = 0; i < 24; ++i) positions.push_back(0);
  primitive["attributes"]["JOINTS_0"] = asset.accessor<uint8_t>("VEC4", std::vector<uint8_t>(24 * 4, 0));
  std::vector<uint8_t> weights(24 * 4, 0);
  for (size_t i = 0; i < 24; ++i) weights[4 * i] = 255;
  primitive["attributes"]["WEIGHTS_0"] = asset.accessor("VEC4", weights, true);
  asset.mesh(primitive, node);
  asset.doc["nodes"][0]["skin"] = 0;
  asset.doc["scenes"][0]["nodes"].push_back(asset.add("nodes", {{"name", "joint"}}));
  json accessor{
      {"bufferView", asset.view(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})},
      {"componentType", 5126},
      {"type", "MAT4"},
      {"count", 1}};
  asset.doc["skins"] = {{{"joints", {k_joint}}, {"inverseBindMatrices", asset.add("accessors", accessor)}}};
  return asset;
}

}  // namespace

TEST_CASE("a skinned mesh follows its joints, wherever its node is") {
  check_bounds(skinned().load(), {0, 0, 0}, {1, 1, 1});
  check_bounds(skinned({{"translation", {0, 5, 0}}}).load(), {0, 0, 0}, {1, 1, 1});
  check_bounds(skinned({{"scale", {100, 100, 100}}}).load(), {0, 0, 0}, {1, 1, 1});
  // Scale 0 hides a skinned mesh only if its joints have it.
  check_bounds(skinned({{"scale", {0, 0, 0}}}).load(), {0, 0, 0}, {1, 1, 1});
  Asset asset = skinned();
  asset.doc["nodes"][k_joint]["scale"] = {0, 0, 0};
  CHECK(asset.load().instances.empty());
  asset.doc["nodes"][k_joint] = {{"translation", {7, 0, 0}}, {"scale", {2, 2, 2}}};
  check_bounds(asset.load(), {7, 0, 0}, {9, 2, 2});
  check_outside(asset.load(), {8, 1, 1});
  // Missing bind matrices are the identity; a joint below another has both matrices.
  asset.doc["skins"][0].erase("inverseBindMatrices");
  asset.doc["nodes"][k_joint]["scale"] = {1, 1, 1};
  asset.doc["scenes"][0]["nodes"] = {
      0, asset.add("nodes", {{"translation", {0, 1, 0}}, {"children", {k_joint}}})};
  check_bounds(asset.load(), {7, 1, 0}, {8, 2, 1});
  CHECK(asset.load().warnings.empty());
}

TEST_CASE("joints are weighted, and all sets count") {
  Asset asset = skinned();
  json& attributes = asset.doc["meshes"][0]["primitives"][0]["attributes"];
  asset.doc["scenes"][0]["nodes"].push_back(asset.add("nodes", {{"translation", {0, 4, 0}}}));
  asset.doc["skins"][0] = {{"joints", {k_joint, 2}}};
  // A quarter of the second joint by set 0, and a quarter more by set 1; the weights sum to 1.6.
  std::vector<uint8_t> joints(24 * 4, 0);
  std::vector<float> weights(24 * 4, 0), more(24 * 4, 0);
  for (size_t i = 0; i < 24; ++i)
    joints[4 * i + 1] = 1, weights[4 * i] = 0.8f, weights[4 * i + 1] = 0.4f, more[4 * i + 1] = 0.4f;
  attributes["JOINTS_0"] = attributes["JOINTS_1"] = asset.accessor("VEC4", joints);
  attributes["WEIGHTS_0"] = asset.accessor("VEC4", weights);
  attributes["WEIGHTS_1"] = asset.accessor("VEC4", more);
  check_bounds(asset.load(), {0, 2, 0}, {1, 3, 1});
  // Vertices without weights follow the first joint, with a warning.
  attributes.erase("JOINTS_1");
  attributes["WEIGHTS_0"] = asset.accessor("VEC4", std::vector<float>(24 * 4, 0));
  check_bounds(asset.load(), {0, 0, 0}, {1, 1, 1});
  CHECK(warnings_with(asset.load(), "1 primitives have vertices without joint weights") == 1);
}

TEST_CASE("a mirrored joint keeps the outside outside") {
  Asset asset = skinned();
  asset.doc["nodes"][k_joint] = {{"scale", {-1, 1, 1}}};
  const Scene scene = asset.load();
  check_bounds(scene, {-1, 0, 0}, {0, 1, 1});
  check_outside(scene, {-0.5f, 0.5f, 0.5f});
  check_outside(skinned().load(), vec3(0.5f));
}

TEST_CASE("skins that violate glTF") {
  const auto broken = [](const std::function<void(Asset&)>& change) {
    Asset asset = skinned();
    change(asset);
    return failure(asset);
  };
  CHECK(broken([](Asset&) {}).empty());
  CHECK_THAT(broken([](Asset& a) { a.doc["nodes"][0]["skin"] = 1; }),
             Contains("nodes[0].skin: 1 is not an index"));
  CHECK_THAT(broken([](Asset& a) { a.doc.erase("skins"); }), Contains("nodes[0].skin: 0 is not an index"));
  CHECK_THAT(broken([](Asset& a) { a.doc["skins"][0]["joints"] = {9}; }), Contains("skins[0].joints[0]: 9"));
  CHECK_THAT(broken([](Asset& a) {
               a.doc["skins"][0]["joints"] = {1, 0};
             }),
             Contains("skins[0].inverseBindMatrices: 1 matrices, but the skin has 2 joints"));
  CHECK_THAT(broken([](Asset& a) { a.doc["skins"][0]["inverseBindMatrices"] = 0; }),
             Contains("expected 4 x 4 matrices of floats"));
  CHECK_THAT(broken([](Asset& a) {
               std::vector<uint8_t> joints(24 * 4, 0);
               joints[0] = 3;
               a.doc["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = a.accessor("VEC4", joints);
             }),
             Contains("JOINTS_0 of vertex 0 is 3, but the skin has 1 joints"));
  // Harmless if no node uses it.
  CHECK(broken([](Asset& a) {
          a.doc["nodes"][0].erase("skin");
          a.doc["skins"][0]["joints"] = {9};
        }).empty());
  Asset plain = skinned({{"translation", {0, 5, 0}}});
  plain.doc["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0");
  check_bounds(plain.load(), {0, 5, 0}, {1, 6, 1});
  CHECK(warnings_with(plain.load(), "1 primitives of a skinned mesh have no joints or weights") == 1);
}

TEST_CASE("morph targets by the node's weights, otherwise the mesh's") {
  Asset asset;
  json& primitive = asset.triangle();
  primitive["targets"] = {{{"POSITION", asset.accessor<float>("VEC3", {0, 2, 0, 0, 2, 0, 0, 2, 0})}},
                          {{"POSITION", asset.accessor<float>("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 4})}}};
  check_bounds(asset.load(), {0, 0, 0}, {1, 1, 0});
  asset.doc["meshes"][0]["weights"] = {1, 0};
  check_bounds(asset.load(), {0, 2, 0}, {1, 3, 0});
  asset.doc["nodes"][0]["weights"] = {0, 0.5};
  const Scene scene = asset.load();
  check_bounds(scene, {0, 0, 0}, {1, 1, 2});
  // Flat normals are those of the displayed shape.
  CHECK(close(std::as_const(scene.meshes)[0].primitives[0].normals[0], glm::normalize(vec3(0, -2, 1))));
  CHECK(scene.warnings.empty());
  // Two nodes with different weights are two meshes, two with the same are one.
  asset.doc["scenes"][0]["nodes"] = {0, asset.add("nodes", {{"mesh", 0}}), asset.add("nodes", {{"mesh", 0}})};
  const Scene three = asset.load();
  CHECK(three.instances.size() == 3);
  CHECK(three.meshes.size() == 2);
  primitive["targets"][1]["POSITION"] = asset.accessor<float>("VEC3", {0, 0, 0});
  CHECK_THAT(failure(asset), Contains("targets[1].POSITION: 1 elements, but POSITION has 3"));
}

TEST_CASE("morph targets of normals, tangents, texture coordinates and colours") {
  Asset asset;
  asset.textured_triangle({{"normalTexture", {{"index", 0}}}});
  asset.add("textures", json::object());
  json& primitive = asset.doc["meshes"][0]["primitives"][0];
  json& attributes = primitive["attributes"];
  attributes["NORMAL"] = asset.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  attributes["TANGENT"] = asset.accessor<float>("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
  attributes["COLOR_0"] = asset.accessor<uint8_t>("VEC3", {0, 255, 51, 0, 255, 51, 0, 255, 51}, true);
  const int up = asset.accessor<float>("VEC3", {0, 1, 0, 0, 1, 0, 0, 1, 0});
  primitive["targets"] = {
      {{"NORMAL", up},
       {"TANGENT", up},
       {"TEXCOORD_0", asset.accessor<float>("VEC2", {0, 4, 0, 4, 0, 4})},
       {"COLOR_0", asset.accessor<float>("VEC3", {0.5, 1, 0.2f, 0.5, 1, 0.2f, 0.5, 1, 0.2f})}}};
  asset.doc["meshes"][0]["weights"] = {1};
  const Scene scene = asset.load();
  const Primitive& p = std::as_const(scene.meshes)[0].primitives[0];
  CHECK(close(p.normals[0], glm::normalize(vec3(0, 1, 1))));
  CHECK(close(vec3(p.tangents[0]), glm::normalize(vec3(1, 1, 0))));
  CHECK(p.tangents[0].w == 1);
  CHECK(p.uv0[1] == vec2(1, 4));
  CHECK(close(vec3(p.colors[0]), {0.5f, 1, 0.4f}));  // the sum is clamped, not its terms
}

}  // namespace scene_pose_tests
