// links: session
// View of the depth of field: what is sharp is tinted up to its limits, with a line in the plane of focus; a
// pinhole leaves the picture as it is.
#include "support/render.h"
#include "support/rooms.h"

namespace focus_view_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_side = 64;

const solvers::Report* of_focus(const std::vector<std::shared_ptr<const solvers::Report>>& reports) {
  for (const auto& report : reports)
    if (report->solver == "focus") return report.get();
  return nullptr;
}

}  // namespace

TEST_CASE("the view of the depth of field tints what is sharp") {
  // A grey floor that runs away from the camera, unlit, at heights of the picture that give its depth.
  scene::Scene s;
  s.name = "floor";
  s.materials = {test::diffuse(vec3(0.5f))};
  s.materials[0].unlit = true;
  test::add_quad(s, {-50, -1, 0}, {100, 0, 0}, {0, 0, -100}, 0);
  scene::Camera camera;
  camera.yfov = 1, camera.lens = {.f_number = 1, .focus_distance = 3};
  s.cameras = {camera};
  s.environment.given = true;
  session::Renderer r(test::renderer_options());
  r.settings().set("path.batch", test::k_batch);
  r.set_size(k_side, k_side);
  r.set_scene(std::make_shared<scene::Scene>(s));
  test::set(r, {{"samples", "2"}});
  test::finish(r);
  const std::vector<uint8_t> plain = r.output().picture(false);
  test::set(r, {{"overlay.focus", "true"}});
  const std::vector<uint8_t> shown = r.output().picture(false);
  {
    const auto reports = r.solvers().reports();
    const solvers::Report* report = of_focus(reports);
    REQUIRE(report);
    REQUIRE(report->legends.size() == 1);
    CHECK(report->legends[0].marks.at(0).text == "Focus, 3 m");
  }
  // Blur 2 r |1/z - 1/3| at most 0.03 mm over the focal length.
  const double half = std::tan(0.5), focal = 0.018 / half, allowed = 3e-5 / (focal * focal);
  const double nearest = 1 / (1 / 3.0 + allowed), farthest = 1 / (1 / 3.0 - allowed);
  CHECK(farthest - nearest > 0.4);
  uint32_t line = 0;
  for (uint32_t y = k_side / 2 + 2; y < k_side; ++y) {
    const double depth = 1 / (half * ((y + 0.5) / (k_side / 2) - 1));
    const double next = 1 / (half * ((y + 1.5) / (k_side / 2) - 1));
    const size_t at = 4 * (size_t{y} * k_side + 10);
    const int red = shown[at], green = shown[at + 1], was = plain[at];
    INFO("row " << y << ", depth " << depth << ": " << red << " " << green << ", plain " << was);
    if (std::abs(depth - 3) < 0.4 * (depth - next)) {
      CHECK(red > was);
      ++line;
    } else if (std::abs(depth - 3) > 1.5 * (depth - next)) {
      const bool is_sharp = depth > nearest && depth < farthest;
      CHECK((green > red + 10) == is_sharp);
      if (!is_sharp) CHECK(green < was);
    }
  }
  CHECK(line == 1);
  camera.lens.f_number = 0;
  r.set_camera(camera);
  test::finish(r);
  test::set(r, {{"overlay.focus", "false"}});
  const std::vector<uint8_t> pinhole = r.output().picture(false);
  test::set(r, {{"overlay.focus", "true"}});
  CHECK(r.output().picture(false) == pinhole);
  const auto reports = r.solvers().reports();
  REQUIRE(of_focus(reports));
  CHECK_THAT(of_focus(reports)->legends.at(0).note, Catch::Contains("pinhole"));
}

}  // namespace focus_view_tests
