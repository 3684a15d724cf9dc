// links: scene scene_io
// The supported range of cameras, lamps, materials and environments; refusals name the object.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "scene/io/load.h"
#include "scene/range.h"
#include "support/folder.h"

namespace scene_range_tests {

using namespace lucerna;
using Catch::Contains;

namespace {

const float k_inf = std::numeric_limits<float>::infinity(), k_nan = std::numeric_limits<float>::quiet_NaN();

scene::Camera camera_at(const vec3& eye) {
  scene::Camera camera;
  camera.to_world[3] = vec4(eye, 1);
  return camera;
}

std::string refusal(const auto& thing) {
  try {
    scene::check_range(thing);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("cameras far away, or without a frame or a lens, are refused") {
  CHECK(refusal(camera_at({1e9f, -1e9f, 0})).empty());
  for (const vec3 eye : {vec3(2e9f, 0, 0), vec3(0, -k_inf, 0), vec3(0, 0, k_nan)})
    CHECK_THAT(refusal(camera_at(eye)), Contains("camera: its place") && Contains("1e+09 m"));
  scene::Camera flat;
  flat.name = "flat", flat.to_world[1] = flat.to_world[0];
  CHECK_THAT(refusal(flat), Contains("camera 'flat': its axes"));
  scene::Camera wide;
  wide.yfov = 3.15f;
  CHECK_THAT(refusal(wide), Contains("field of view"));
  wide.orthographic = true;
  CHECK(refusal(wide).empty());
  for (const float size : {0.f, -1.f, 2e9f, k_inf, k_nan}) {
    wide.xmag = size;
    CHECK_THAT(refusal(wide), Contains("expected above 0"));
  }
}

TEST_CASE("lenses without a sensible f-number, focus or aperture are refused, and pinholes need none") {
  scene::Camera camera;
  camera.lens = {.f_number = 0, .focus_distance = -1};
  CHECK(refusal(camera).empty());
  for (const float f : {-1.f, 0.01f, 2000.f, k_inf, k_nan}) {
    camera.lens = {.f_number = f, .focus_distance = 1};
    CHECK_THAT(refusal(camera), Contains("camera: its f-number is") && Contains("0 for a pinhole"));
  }
  for (const float focus : {0.f, -2.f, 2e9f, k_inf, k_nan}) {
    camera.lens = {.f_number = 2, .focus_distance = focus};
    CHECK_THAT(refusal(camera), Contains("camera: its plane of focus is"));
  }
  for (const uint32_t blades : {1u, 2u, 33u}) {
    camera.lens = {.f_number = 2, .focus_distance = 1, .blades = blades};
    CHECK_THAT(refusal(camera), Contains("blades, expected 3 to 32"));
  }
  camera.lens = {.f_number = 2, .focus_distance = 1, .blades = 6, .rotation = k_nan};
  CHECK_THAT(refusal(camera), Contains("rotation"));
  camera.lens.rotation = 7;
  CHECK(refusal(camera).empty());
}

TEST_CASE("lamps, materials and environments beyond the range of sums of paths are refused") {
  scene::Light lamp;
  lamp.name = "Lamp";
  CHECK(refusal(lamp).empty());
  lamp.position = {0, 1e10f, 0};
  CHECK_THAT(refusal(lamp), Contains("light 'Lamp': its place"));
  lamp = {}, lamp.direction = vec3(0);
  CHECK_THAT(refusal(lamp), Contains("direction"));
  lamp = {}, lamp.intensity.y = k_inf;
  CHECK_THAT(refusal(lamp), Contains("intensity"));
  scene::Material material;
  CHECK(refusal(material).empty());
  material.emission = {0, 0, 1e31f};
  CHECK_THAT(refusal(material), Contains("it emits"));
  scene::Environment sky;
  CHECK(refusal(sky).empty());
  sky.rotation = k_nan;
  CHECK_THAT(refusal(sky), Contains("rotation"));
  sky = {}, sky.scale = -1;
  CHECK_THAT(refusal(sky), Contains("factor"));
}

TEST_CASE("a file whose lamp is too far away is refused; an unused camera does not matter") {
  const test::Folder folder;
  const auto load = [&](const std::string& nodes) {
    const auto file = folder.path / "far.gltf";
    std::ofstream(file) << R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [)" << nodes
                        << R"(], "extensionsUsed": ["KHR_lights_punctual"],
      "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "Lamp"}]}}})";
    return scene::load(file, {});
  };
  CHECK_THROWS_WITH(
      load(R"({"translation": [0, 0, 3e9], "extensions": {"KHR_lights_punctual": {"light": 0}}})"),
      Contains("far.gltf: light 'Lamp': its place"));
  CHECK(load(R"({"translation": [0, 0, 3e9], "camera": 0})").cameras.size() == 1);
}

}  // namespace scene_range_tests
