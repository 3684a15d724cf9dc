// links: commands
// The camera's lens by commands: undone, kept in bookmarks, focused by a place in the picture, refused where
// it makes no sense.
#include "session/pick.h"
#include "unit/workspace_bench.h"

namespace commands_lens_tests {

using namespace lucerna;
using namespace lucerna::commands;
using Catch::Contains, test::WorkspaceBench;

namespace {

const scene::Lens& lens_of(const WorkspaceBench& b) { return b.work.camera.view->camera.lens; }

}  // namespace

TEST_CASE("a lens is set by commands, which can be undone") {
  WorkspaceBench b;
  b.open();
  CHECK(lens_of(b) == scene::Lens{});
  b.run("camera.focus_distance 3");
  b.run("camera.f_number 2.8");
  b.run("camera.blades 6 rotation=15");
  CHECK(lens_of(b).f_number == 2.8f);
  CHECK(lens_of(b).focus_distance == 3);
  CHECK(lens_of(b).blades == 6);
  CHECK(lens_of(b).rotation == Approx(15 * k_pi / 180));
  REQUIRE(b.until([&] { return b.work.open.snapshot && b.work.open.snapshot->camera.lens == lens_of(b); }));
  b.run("camera.orbit 0.2 0");  // moves keep it
  CHECK(lens_of(b).blades == 6);
  b.run("undo"), b.run("undo");
  CHECK(lens_of(b).blades == 0);
  CHECK(lens_of(b).f_number == 2.8f);
  b.run("redo");
  CHECK(lens_of(b).blades == 6);
  b.run("camera.pinhole");
  CHECK(lens_of(b).f_number == 0);
  b.run("undo");
  CHECK(lens_of(b).f_number == 2.8f);
}

TEST_CASE("the lens focuses on the surface at a place, measured along the view axis") {
  WorkspaceBench b;
  b.open();
  // The fake scene's triangle is a ramp: it rises by 3 m over 8 m towards +z.
  b.run("camera.place 2,2.5,-3 2,0.375,-3 0,0,1 fov=40");
  b.run("camera.focus 0.5 0.5");
  CHECK(lens_of(b).focus_distance == Approx(2.125f).margin(1e-3));
  CHECK(lens_of(b).f_number == 0);
  // Above the middle the ramp is nearer: at depth d and height d tan(10 degrees) in the view, on its plane.
  b.run("camera.focus 0.5 0.25");
  const float up = 0.5f * std::tan(20 * k_pi / 180);
  CHECK(lens_of(b).focus_distance == Approx(2.125f / (1 + 0.375f * up)).margin(2e-3));
  b.run("camera.place 2,2.5,-3 2,3.5,-3 0,0,1");
  CHECK_THAT(b.failure("camera.focus 0.5 0.5"), Contains("there is no surface at that point to focus on"));
}

TEST_CASE(
    "a lens without a focus focuses on the middle of the picture, or else on what the camera orbits about") {
  WorkspaceBench b;
  b.open();
  b.run("camera.place 2,2.5,-3 2,1.5,-3 0,0,1 fov=40");
  b.run("camera.f_number 4");
  CHECK(lens_of(b).focus_distance == Approx(2.125f).margin(1e-3));
  b.run("camera.f_number 8");  // stays
  CHECK(lens_of(b).focus_distance == Approx(2.125f).margin(1e-3));
  WorkspaceBench sky;
  sky.open();
  sky.run("camera.place 2,2.5,-3 2,4,-3 0,0,1");
  sky.run("camera.f_number 4");
  CHECK(lens_of(sky).focus_distance == Approx(1.5f));
}

TEST_CASE("an upright camera is level, with the middle of the picture where it was") {
  WorkspaceBench b;
  b.open();
  b.run("camera.place 1,1.7,6 1.5,4,2 0.2,1,0 fov=50");
  b.run("camera.f_number 2"), b.run("camera.focus_distance 3");
  const scene::Camera before = b.work.camera.view->camera;
  const float aspect = b.work.camera.aspect;
  const auto ray = [&](const scene::Camera& c, float x, float y) {
    return session::pick_ray(c, x, y, aspect).direction;
  };
  const auto column = [&](const scene::Camera& c, float x) {  // heading of rays of one column: least and most
    float lo = 10, hi = -10;
    for (const float y : {0.05f, 0.5f, 0.95f}) {
      const vec3 d = ray(c, x, y);
      lo = std::min(lo, std::atan2(d.x, -d.z)), hi = std::max(hi, std::atan2(d.x, -d.z));
    }
    return hi - lo;
  };
  CHECK(column(before, 0.1f) > 0.05f);
  b.run("camera.upright");
  const scene::Camera after = b.work.camera.view->camera;
  for (const float x : {0.1f, 0.5f, 0.8f}) CHECK(column(after, x) < 1e-5f);
  CHECK(glm::distance(ray(before, 0.5f, 0.5f), ray(after, 0.5f, 0.5f)) < 1e-5f);
  // At the same scale around the middle.
  CHECK(glm::distance(ray(after, 0.51f, 0.5f), ray(after, 0.49f, 0.5f)) ==
        Approx(glm::distance(ray(before, 0.51f, 0.5f), ray(before, 0.49f, 0.5f))).epsilon(0.01));
  // Focused on the same point of the middle's ray.
  CHECK(after.lens.focus_distance / glm::dot(ray(after, 0.5f, 0.5f), forward_of(after)) ==
        Approx(3).epsilon(1e-4));
  b.run("camera.bookmark upright");
  b.run("camera.shift 0 0");
  CHECK(b.work.camera.view->camera.shift == vec2(0));
  b.run("undo");
  CHECK(b.work.camera.view->camera.shift == after.shift);
  b.run("camera.shift -0.25 0.5");
  CHECK(b.work.camera.view->camera.shift == vec2(-0.25f, 0.5f));
  b.run("camera.go upright");
  CHECK(b.work.camera.view->camera.shift == after.shift);
  CHECK_FALSE(b.work.camera.view->camera.section.cuts());
  b.run("camera.section 0,0,2 0,0,-4");
  const scene::Section cut = b.work.camera.view->camera.section;
  CHECK(cut == scene::Section{.normal = {0, 0, -1}, .offset = -2});
  b.run("camera.bookmark cut");
  b.run("camera.go upright");
  CHECK_FALSE(b.work.camera.view->camera.section.cuts());
  b.run("camera.go cut");
  CHECK(b.work.camera.view->camera.section == cut);
  b.run("camera.no_section");
  CHECK_FALSE(b.work.camera.view->camera.section.cuts());
  b.run("undo");
  CHECK(b.work.camera.view->camera.section == cut);
  CHECK_THAT(b.failure("camera.section 0,0,2 0,0,0"), Contains("normal: its length is 0"));
  b.run("camera.place 1,1.7,6 1,9,5.5 0,1,0 shift_right=0 shift_up=0");
  CHECK_THAT(b.failure("camera.upright"), Contains("too steeply"));
  b.run("camera.projection panorama");
  CHECK(b.work.camera.view->camera.wide == scene::Wide::panorama);
  CHECK_THAT(b.failure("camera.f_number 2"), Contains("the camera is a panorama, without depth of field"));
  b.run("camera.bookmark around");
  b.run("undo");
  CHECK(b.work.camera.view->camera.perspective());
  b.run("camera.go around");
  CHECK(b.work.camera.view->camera.wide == scene::Wide::panorama);
  b.run("camera.fov 50");
  CHECK(b.work.camera.view->camera.perspective());
  CHECK_THAT(b.failure("camera.projection cube"), Contains("expected one of perspective, panorama"));
  for (const char* line : {"camera.shift nan 0", "camera.shift 0 21", "camera.shift 0"}) {
    INFO(line);
    CHECK_FALSE(b.failure(line).empty());
  }
}

TEST_CASE("bookmarks keep the lens") {
  WorkspaceBench b;
  b.open();
  b.run("camera.bookmark sharp");
  b.run("camera.f_number 2"), b.run("camera.focus_distance 1.25"), b.run("camera.blades 5 rotation=-30");
  const scene::Lens lens = lens_of(b);
  b.run("camera.bookmark soft");
  b.run("camera.go sharp");
  CHECK(lens_of(b).f_number == 0);
  b.run("camera.go soft");
  CHECK(lens_of(b).f_number == lens.f_number);
  CHECK(lens_of(b).focus_distance == lens.focus_distance);
  CHECK(lens_of(b).blades == lens.blades);
  CHECK(lens_of(b).rotation == Approx(lens.rotation));
}

TEST_CASE("lenses that make no sense are refused with what is expected, and nothing changes") {
  WorkspaceBench b;
  b.open();
  b.run("camera.f_number 2");
  const scene::Lens before = lens_of(b);
  for (const char* line : {"camera.f_number 0", "camera.f_number -1", "camera.f_number nan",
                           "camera.f_number 1e9", "camera.focus_distance 0", "camera.focus_distance -2",
                           "camera.focus_distance nan", "camera.focus_distance inf", "camera.blades 2",
                           "camera.blades 33", "camera.place 0,1,5 0,0,0 0,1,0 f_number=2 pinhole=true"}) {
    INFO(line);
    const std::string why = b.failure(line);
    CHECK_FALSE(why.empty());
    CHECK(why.find('\n') == std::string::npos);
    CHECK(lens_of(b) == before);
  }
  b.run("camera.place 0,1,5 0,0,0 0,1,0 height=4");
  CHECK_THAT(b.failure("camera.f_number 2"), Contains("the camera is orthographic, without depth of field"));
}

}  // namespace commands_lens_tests
