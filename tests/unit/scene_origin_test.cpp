// links: scene_io
// Scenes far from the origin of their file are moved near it; others stay.
#include <cmath>

#include "scene/hash.h"
#include "scene/recentre.h"
#include "unit/scene_support.h"

namespace scene_origin_tests {

using namespace lucerna;
using namespace lucerna::test;
using glm::dvec3;
using scene::Extent;
using scene::Scene;

namespace {

dvec3 chosen(const std::vector<Extent>& extents, const std::vector<dvec3>& cameras = {}) {
  return scene::choose_origin(extents, cameras);
}

/// The extent of a mesh with a few triangles.
Extent at(const dvec3& centre, double radius, double triangles = 100) {
  return {centre, radius, radius * triangles};
}

const dvec3 k_utm(448123.4, 0, 5411932.1);

/// A room of one triangle near (x, 0, z), with lamp and camera, below a parent that is moved.
Asset moved(const dvec3& by) {
  Asset asset;
  asset.triangle({{"translation", {-0.25, -0.25, 0.125}}});
  asset.doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  asset.add("nodes", {{"translation", {0, 2, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  asset.add("nodes", {{"translation", {0, 1, 6}},
                      {"camera", asset.add("cameras", {{"type", "perspective"},
                                                       {"perspective", {{"yfov", 1}, {"znear", 0.1}}}})}});
  asset.doc["scenes"][0]["nodes"] = {
      asset.add("nodes", {{"translation", {by.x, by.y, by.z}}, {"children", {0, 1, 2}}})};
  return asset;
}

}  // namespace

TEST_CASE("round origins") {
  CHECK(scene::round_origin({1e5, 1.5, -1e5}, 3) == dvec3(1e5, 0, -1e5));
  CHECK(scene::round_origin(k_utm, 30) == dvec3(448120, 0, 5411930));
  CHECK(scene::round_origin({299, 0, 0}, 3) == dvec3(0));
  CHECK(scene::round_origin({301, 0, 0}, 3) == dvec3(301, 0, 0));
  CHECK(scene::round_origin({301, 0, 0}, 0) == dvec3(0));
}

TEST_CASE("a scene is moved only if it is far relative to its extent") {
  CHECK(chosen({}) == dvec3(0));
  CHECK(chosen({at({0, 1, 0}, 3)}) == dvec3(0));
  CHECK(chosen({at({200, 0, 0}, 3)}) == dvec3(0));
  CHECK(chosen({at({1e5, 1, 0}, 3)}) == dvec3(1e5, 0, 0));
  CHECK(chosen({at(k_utm, 3), at(k_utm + dvec3(2, 1, 0), 0.1)}) == dvec3(448123, 0, 5411932));
  // A town: far relative to its houses, near relative to itself.
  std::vector<Extent> town;
  for (int x = 0; x < 20; ++x)
    for (int z = 0; z < 20; ++z) town.push_back(at({2000 + 50 * x, 0, 2000 + 50 * z}, 5));
  CHECK(chosen(town) == dvec3(0));
  for (Extent& house : town) house.centre += dvec3(448000, 0, 5411000);
  const dvec3 origin = chosen(town);
  CHECK(std::abs(origin.x - 450500) <= 1000);
  CHECK(std::abs(origin.z - 5413500) <= 1000);
  // A small object with any number of triangles, in a room, beside it or in front of a backdrop.
  CHECK(chosen({at({0, 0, 0}, 10), at({10, 0, 0}, 0.05, 1e6)}, {{10, 0, 0.2}}) == dvec3(0));
  CHECK(chosen({at({30, 0, 0}, 10), at({30, 0, 0}, 0.05, 1e6)}) == dvec3(0));
  CHECK(chosen({at({0, 0, 0}, 3), at({5e4, 0, 0}, 1e4, 1e6)}) == dvec3(0));
}

TEST_CASE("stray objects do not decide") {
  const Extent room = at(k_utm, 3), stray = at({0, 0, 0}, 0.1, 12);
  CHECK(chosen({room, stray}) == dvec3(448123, 0, 5411932));
  CHECK(chosen({stray, stray, room}) == dvec3(448123, 0, 5411932));
  CHECK(chosen({at({0, 0, 0}, 3), at({1e6, 0, 0}, 0.1, 12)}) == dvec3(0));
  // Of two similar objects the one near the camera decides.
  CHECK(chosen({at({0, 0, 0}, 3), at({1e6, 0, 0}, 4)}, {{0, 1, 5}}) == dvec3(0));
  CHECK(chosen({at({0, 0, 0}, 4), at({1e6, 0, 0}, 3)}, {{1e6, 1, 5}}) == dvec3(1e6, 0, 0));
}

TEST_CASE("domes and terrains follow the rest") {
  const Extent room = at({0, 1, 0}, 3), far_room = at(k_utm, 3);
  const dvec3 camera = k_utm + dvec3(0, 1, 5);
  CHECK(chosen({room, at({0, 0, 0}, 1e6, 1e4)}) == dvec3(0));
  CHECK(chosen({room, at({2e5, 0, 0}, 1e6, 1e4)}) == dvec3(0));
  CHECK(chosen({room, at({4e5, 0, 0}, 1000, 1e6)}, {{0, 1, 5}}) == dvec3(0));
  CHECK(chosen({far_room, at(k_utm, 1000, 1e4)}, {camera}) != dvec3(0));
  // Even one that is large enough to reach the old origin.
  CHECK(chosen({far_room, at(k_utm, 1e6, 1e4)}, {camera}) == dvec3(448123, 0, 5411932));
  CHECK(chosen({far_room, at(k_utm, 1e6, 1e4)}) == dvec3(448123, 0, 5411932));
}

TEST_CASE("a scene far away is the same scene except for its origin") {
  const Scene here = moved(dvec3(0)).load();
  CHECK(here.origin == dvec3(0));
  CHECK(here.warnings.empty());
  for (const dvec3& by : {dvec3(1e5, 0, -1e5), dvec3(448000, 0, 5411000), dvec3(1e8, 1e8, 0)}) {
    const Scene there = moved(by).load();
    CHECK(there.origin == by);
    CHECK(warnings_with(there, "the geometry is far from the origin") == 1);
    CHECK(there.instances[0].to_world == here.instances[0].to_world);
    CHECK(there.lights[0].position == here.lights[0].position);
    CHECK(there.cameras[0].to_world == here.cameras[0].to_world);
    // Cached light of one does not fit the other.
    CHECK(scene::light_hash(there).geometry != scene::light_hash(here).geometry);
    const auto d = scene::describe(there);
    CHECK(d["origin"] == json{by.x, by.y, by.z});
    CHECK(d["bounds"] == scene::describe(here)["bounds"]);
    CHECK(scene::describe_text(there).find("origin ") != std::string::npos);
  }
  CHECK(scene::describe_text(here).find("origin ") == std::string::npos);
}

TEST_CASE("matrices are multiplied in double precision before the origin is subtracted") {
  // Two halves of the translation, neither of which fits single precision.
  Asset asset = moved({224061.725, 0, 2705966.025});
  asset.doc["scenes"][0]["nodes"] = {
      asset.add("nodes", {{"translation", {224061.675, 0, 2705966.075}}, {"children", {3}}})};
  const Scene scene = asset.load();
  CHECK(scene.origin == dvec3(448124, 0, 5411932));
  CHECK(scene.instances[0].to_world[3].x == Approx(-0.85).margin(1e-6));
  CHECK(scene.instances[0].to_world[3].z == Approx(0.225).margin(1e-6));
  CHECK(scene.cameras[0].to_world[3].x == Approx(-0.6).margin(1e-6));
}

TEST_CASE("large coordinates inside a mesh") {
  Asset asset;
  const std::vector<float> far{447999.75f, 0, 5411000, 448000.75f, 0, 5411000, 447999.75f, 1, 5411000};
  asset.mesh({{"attributes", {{"POSITION", asset.accessor("VEC3", far)}}}});
  Scene scene = asset.load();
  CHECK(scene.origin == dvec3(448000, 0, 5411000));
  CHECK(std::as_const(scene.meshes)[0].primitives[0].positions[1] == vec3(0.75f, 0, 0));
  CHECK(scene::bounds(scene).lo == vec3(-0.25f, 0, 0));
  // A node that moves them back, to a position that single precision cannot subtract.
  asset.doc["nodes"][0]["translation"] = {-447999.65, 0, -5410999.9};
  scene = asset.load();
  CHECK(scene.origin == dvec3(0));
  CHECK(scene::bounds(scene).lo.x == Approx(0.1).epsilon(1e-5));
  CHECK(scene::bounds(scene).hi.x == Approx(1.1).epsilon(1e-5));
}

}  // namespace scene_origin_tests
