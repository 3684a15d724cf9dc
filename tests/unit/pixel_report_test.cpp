// links: commands
// The report of a pixel: values and noise of its layers, and its surface.
#include "commands/pixel_report.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "session/pick.h"
#include "workspace_bench.h"

namespace pixel_report_tests {

using namespace lucerna;
using namespace lucerna::commands;
using Catch::Contains;

namespace {

/// 32x32 pixels; the halves of the sum differ by 0.2 at the pixel (5, 3) and by 0.02 elsewhere.
film::FilmImage picture() {
  film::FilmImage image{.width = 32, .height = 32};
  const size_t n = size_t{32} * 32, at = size_t{3} * 32 + 5;
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float> all(n, 1), odd(n, 1.01f);
    all[at] = 2, odd[at] = 2.1f;
    image.channels.emplace_back(name, all);
    image.channels.emplace_back(std::string("odd.") + name, odd);
  }
  image.channels.emplace_back("Z", std::vector<float>(n, 4));
  image.channels.emplace_back("samples", std::vector<float>(n, 8));
  image.channels.emplace_back("lookup.bias", std::vector<float>(n, 0.03f));
  return image;
}

}  // namespace

TEST_CASE("values and noise of a pixel's layers") {
  const PixelReport report = report_pixel(picture(), {5.5f / 32, 3.5f / 32});
  CHECK((report.x == 5 && report.y == 3 && report.samples == 8));
  REQUIRE(report.layers.size() == 2);
  CHECK(report.layers[0].name == "rgb");
  CHECK(report.layers[0].value == std::vector<float>{2, 2, 2});
  // Half of the halves' difference; the tile has 255 pixels of 0.01 besides.
  CHECK(*report.layers[0].noise == Approx(0.1).epsilon(1e-4));
  CHECK(*report.layers[0].tile_noise == Approx(std::sqrt(0.01 + 255 * 1e-4) / 256).epsilon(1e-3));
  CHECK(report.layers[1].value == std::vector<float>{4});
  CHECK_FALSE(report.layers[1].noise);
  CHECK(*report.lookup_bias == Approx(0.03));
  CHECK_FALSE(report.lookup_noise);
  const std::vector<std::string> lines = to_lines(report);
  CHECK(lines[0] == "pixel 5 3: 8 samples");
  CHECK_THAT(lines[1], Catch::StartsWith("sum: 2 2 2 +- 0.1 (mean of its tile +- "));
  // The last pixel belongs to the right and lower edge.
  const PixelReport corner = report_pixel(picture(), {1, 1});
  CHECK((corner.x == 31 && corner.y == 31));
}

TEST_CASE("the surface of a pixel has its object, material, triangle and coordinates") {
  scene::Scene s;
  scene::Mesh mesh;
  mesh.name = "floor";
  scene::Primitive p;
  p.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  p.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  p.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.primitives.push_back(p);
  s.meshes.push_back(mesh);
  s.materials.emplace_back();
  s.materials[0].name = "oak";
  s.instances.push_back({.name = "", .mesh = 0});
  scene::Camera camera;
  camera.to_world = mat4(1);
  camera.to_world[3] = vec4(0, 0, 2, 1);
  camera.yfov = 2 * std::atan(0.5f);
  // 0.25 of the height above the middle, and left of it: the second triangle.
  const auto lines = surface_lines(s, camera, {0.25f, 0.25f}, 1);
  CHECK(lines == std::vector<std::string>{
                     "object: object 1", "material: oak", "triangle: 1 of part 0 of the mesh 'floor'",
                     "texture coordinates: 0.2500 0.7500", "place: -0.5000 0.5000 0.0000 m, 2.1213 m away",
                     "normal: 0.000 0.000 1.000"});
  // A tracer finds the same.
  const auto shared = std::make_shared<scene::Scene>(s);
  const session::PickRay ray = session::pick_ray(camera, 0.25f, 0.25f, 1);
  const auto hit = session::Probe(shared).nearest(ray.origin, ray.direction);
  REQUIRE(hit);
  CHECK((hit->triangle == 1 && hit->primitive == 0));
  CHECK(session::picked_uv(s, *hit)->x == Approx(0.25f));
  camera.to_world[3] = vec4(9, 0, 2, 1);
  CHECK(surface_lines(s, camera, {0.5f, 0.5f}, 1) ==
        std::vector<std::string>{"surface: nothing but the environment"});
}

TEST_CASE("inspect.pixel reports in the log, until inspect.none") {
  test::WorkspaceBench b;
  CHECK_THAT(b.failure("inspect.pixel 0.5 0.5"), Contains("no scene is open"));
  b.open();
  b.run("wait_samples 4");
  b.run("inspect.pixel 0.5 0.5");
  REQUIRE(b.work.pixel);
  CHECK_THAT(b.work.pixel->lines[0], Catch::StartsWith("pixel 32 18: "));
  CHECK_THAT(b.work.pixel->lines[1], Catch::StartsWith("sum: "));
  b.run("inspect.none");
  CHECK_FALSE(b.work.pixel);
  CHECK_THAT(b.failure("inspect.pixel 2 0.5"), Contains("expected a number from 0 to 1 picture widths"));
}

}  // namespace pixel_report_tests
