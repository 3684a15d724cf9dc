// links: commands
// The camera's lens by commands: undone, kept in bookmarks, focused by a place in the picture, refused where
// it makes no sense.
#include "unit/workspace_bench.h"

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
