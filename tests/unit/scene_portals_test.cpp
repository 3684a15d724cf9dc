// links: scene_io
// Meshes marked by extras.portal: rectangles of the scene instead of surfaces, and the outcome of bad ones.
#include <catch2/catch.hpp>

#include "unit/scene_support.h"

namespace scene_portals_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Contains;

namespace {

/// A scene with a floor of 10 m by 10 m at height 0 and meshes of given corners.
struct Rooms : Asset {
  Rooms() { shape({-5, 0, -5, -5, 0, 5, 5, 0, 5, 5, 0, -5}, {0, 1, 2, 0, 2, 3}); }
  json& shape(const std::vector<float>& corners, const std::vector<uint16_t>& indices,
              const json& node = json::object()) {
    return mesh({{"attributes", {{"POSITION", accessor<float>("VEC3", corners)}}},
                 {"indices", accessor<uint16_t>("SCALAR", indices)}},
                node);
  }
  /// An upright rectangle that lights towards +z, marked in its node.
  void portal(float x, float width, float height, json node = json::object()) {
    node["extras"]["portal"] = true;
    if (!node.contains("name")) node["name"] = "opening";
    shape({x, 1, 0, x + width, 1, 0, x + width, 1 + height, 0, x, 1 + height, 0}, {0, 1, 2, 0, 2, 3}, node);
  }
};

bool warned(const scene::Scene& scene, const std::string& text) {
  return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                     [&](const std::string& w) { return w.find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("a marked rectangle is a portal and no surface") {
  Rooms a;
  a.portal(1, 2, 1.5f, {{"name", "window"}, {"translation", {0, 0, 3}}});
  const scene::Scene scene = a.load();
  CHECK(scene.warnings.empty());
  REQUIRE(scene.portals.size() == 1);
  const scene::Portal& portal = scene.portals[0];
  CHECK(portal.name == "window");
  CHECK(glm::length(portal.centre - vec3(2, 1.75f, 3)) < 1e-5f);
  CHECK(area_of(portal) == Approx(3));
  CHECK(std::abs(glm::dot(portal.half_width, portal.half_height)) < 1e-6f);
  CHECK(glm::length(normal_of(portal) - vec3(0, 0, 1)) < 1e-5f);
  CHECK(scene.instances.size() == 1);
  CHECK(scene.meshes.size() == 1);
  CHECK(scene::count_triangles(scene) == 2);
  const auto described = scene::describe(scene);
  REQUIRE(described["portals"].size() == 1);
  CHECK(described["portals"][0]["name"] == "window");
  CHECK_THAT(scene::describe_text(scene), Contains("portals      1") && Contains("window: "));
}

TEST_CASE("the mark of a mesh serves all its nodes, except those that say otherwise") {
  Rooms a;
  a.portal(1, 1, 1);
  a.doc["nodes"][1].erase("extras");
  a.doc["meshes"][1]["extras"]["portal"] = true;
  for (const json& extras : {json{{"portal", false}}, json{{"other", 1}}}) {
    a.doc["scenes"][0]["nodes"].push_back(
        a.add("nodes", {{"mesh", 1}, {"extras", extras}, {"translation", {3, 0, 0}}}));
  }
  const scene::Scene scene = a.load();
  CHECK(scene.warnings.empty());
  CHECK(scene.portals.size() == 2);
  CHECK(scene.instances.size() == 2);
  CHECK(scene.meshes.size() == 2);
  // Numbers 0 and 1, as of Blender's custom properties.
  a.doc["meshes"][1]["extras"]["portal"] = 1;
  CHECK(a.load().portals.size() == 2);
  a.doc["meshes"][1]["extras"]["portal"] = 0;
  CHECK(a.load().portals.empty());
  a.doc["nodes"][1]["extras"]["portal"] = "yes";
  CHECK_THROWS_WITH(a.load(), Contains("nodes[1].extras.portal"));
}

TEST_CASE("however it is cut, turned, scaled and mirrored, a rectangle is a rectangle") {
  Rooms a;
  const json node = {{"extras", {{"portal", true}}}, {"rotation", {0.1826, 0.3651, 0.5477, 0.7303}}};
  // A grid of 3 x 2 with rows of uneven height.
  std::vector<float> corners;
  for (const float y : {0.f, 0.3f, 2.f})
    for (const float x : {0.f, 0.5f, 0.7f, 3.f}) corners.insert(corners.end(), {x, y + 4, 0});
  std::vector<uint16_t> indices;
  for (uint16_t y = 0; y < 2; ++y)
    for (uint16_t x = 0; x < 3; ++x) {
      const uint16_t i = uint16_t(4 * y + x);
      for (const uint16_t k : {i, uint16_t(i + 1), uint16_t(i + 5), i, uint16_t(i + 5), uint16_t(i + 4)})
        indices.push_back(k);
    }
  a.shape(corners, indices, node);
  json scaled = node;
  scaled["scale"] = {2, 1, 5};
  scaled["translation"] = {0.5, 0.5, 0.5};
  a.shape(corners, indices, scaled);
  json mirrored = node;
  mirrored["scale"] = {-1, 1, 1};
  mirrored["translation"] = {-0.5, -0.5, -0.5};
  a.shape(corners, indices, mirrored);
  const scene::Scene scene = a.load();
  CHECK(scene.warnings.empty());
  REQUIRE(scene.portals.size() == 3);
  CHECK(area_of(scene.portals[0]) == Approx(6));
  CHECK(area_of(scene.portals[1]) == Approx(12));
  CHECK(area_of(scene.portals[2]) == Approx(6));
  CHECK(glm::dot(normal_of(scene.portals[0]), normal_of(scene.portals[2])) == Approx(1));
}

TEST_CASE("bad portals are left out with a located warning") {
  Rooms a;
  const auto only = [&](const std::vector<float>& corners, const std::vector<uint16_t>& indices) {
    Rooms b;
    b.shape(corners, indices, {{"extras", {{"portal", true}}}});
    return b.load();
  };
  // No area; a box's two sides; two sheets back to back.
  const scene::Scene line = only({0, 1, 0, 1, 1, 0, 2, 1, 0}, {0, 1, 2});
  CHECK(line.portals.empty());
  CHECK(warned(line, "portals without area: left out"));
  CHECK(warned(line, "nodes[1]"));
  const scene::Scene folded = only({0, 1, 0, 1, 1, 0, 1, 2, 0, 0, 1, 1}, {0, 1, 2, 0, 1, 3});
  CHECK(folded.portals.empty());
  CHECK(warned(folded, "portals that are not flat: left out"));
  const scene::Scene sheets =
      only({0, 1, 0, 1, 1, 0, 1, 2, 0, 0, 2, 0}, {0, 1, 2, 0, 2, 3, 2, 1, 0, 3, 2, 0});
  CHECK(sheets.portals.empty());
  CHECK(warned(sheets, "not flat"));
  // An octagon counts as its rectangle.
  std::vector<float> octagon;
  for (int k = 0; k < 8; ++k) {
    const float angle = (float(k) + 0.5f) * k_pi / 4;
    octagon.insert(octagon.end(), {std::cos(angle), 2 + std::sin(angle), 0});
  }
  const scene::Scene round = only(octagon, {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6, 0, 6, 7});
  REQUIRE(round.portals.size() == 1);
  CHECK(area_of(round.portals[0]) == Approx(4 * std::cos(k_pi / 8) * std::cos(k_pi / 8)).epsilon(1e-3));
  CHECK(warned(round, "portals that are not rectangles"));
  // Faces away from the floor, which is all there is.
  const scene::Scene away = only({0, 2, 0, 1, 2, 0, 1, 2, -1, 0, 2, -1}, {0, 1, 2, 0, 2, 3});
  CHECK(away.portals.empty());
  CHECK(warned(away, "portals that face away from all surfaces: left out"));
  // Without a mesh.
  a.doc["scenes"][0]["nodes"].push_back(a.add("nodes", {{"extras", {{"portal", true}}}}));
  CHECK(warned(a.load(), "without a mesh"));
}

TEST_CASE("of many portals the largest are used, and overlapping ones are reported") {
  Rooms a;
  for (int i = 0; i < 20; ++i) a.portal(float(i) - 10, 0.5f, 1 + 0.01f * float(i * 7 % 20));
  const scene::Scene many = a.load();
  REQUIRE(many.portals.size() == scene::k_max_portals);
  CHECK(warned(many, "4 portals more than 16"));
  for (const scene::Portal& portal : many.portals) CHECK(area_of(portal) > 0.5f * 1.035f);
  Rooms b;
  b.portal(0, 2, 1);
  b.portal(1, 2, 1);
  b.portal(3.5f, 1, 1);
  const scene::Scene over = b.load();
  CHECK(over.portals.size() == 3);
  CHECK(warned(over, "1 portals that overlap others"));
  CHECK(warned(over, "nodes[2]"));
}

}  // namespace scene_portals_tests
