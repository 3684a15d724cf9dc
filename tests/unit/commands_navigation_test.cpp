// links: commands
// Navigation and selection by command: the camera, bookmarks, walking, exposure, selection, solo of a
// component.
#include "unit/workspace_bench.h"

namespace commands_navigation_tests {

using namespace lucerna;
using namespace lucerna::commands;
using namespace lucerna::test;
using Catch::Contains;

TEST_CASE("solo shows one component, switches to another and is switched off") {
  WorkspaceBench b;
  b.open();
  b.run("view.show caustic off");
  const Document before = b.work.open.document();
  b.run("view.solo secondary");
  CHECK(b.work.open.setting_on("show.secondary"));
  CHECK_FALSE(b.work.open.setting_on("show.primary"));
  b.run("view.solo primary");
  CHECK(b.work.open.setting_on("show.primary"));
  CHECK_FALSE(b.work.open.setting_on("show.secondary"));
  b.run("view.solo none");
  CHECK_FALSE(b.work.open.setting_on("show.caustic"));
  CHECK(b.work.open.setting_on("show.tertiary"));
  b.run("undo"), b.run("undo");
  CHECK(b.work.open.solo() == 1);
  b.run("undo");
  CHECK(b.work.open.document() == before);
}

TEST_CASE("a click selects the object, then its material, then nothing") {
  WorkspaceBench b;
  b.open();
  b.work.camera.aspect = 2;
  b.run("camera.place 3,1.5,20 1,0.5,-1.5 0,1,0");  // the triangle's middle in the centre
  b.run("pick 0.5 0.5");
  CHECK(b.work.camera.selection == Selection{Kind::instance, 0});
  CHECK(b.work.selection_name() == "column 0");
  b.run("pick 0.5 0.5");
  CHECK(b.work.camera.selection == Selection{Kind::material, 0});
  b.run("pick 0.02 0.02");
  CHECK(b.work.camera.selection == Selection{});
  const auto script = b.work.history.script();
  CHECK(script.back() == "select.none");
  CHECK(script[script.size() - 2] == "select material 1");
}

TEST_CASE("camera moves are undone like all other steps, a drag as one step") {
  WorkspaceBench b;
  b.open();
  const Viewpoint start = *b.work.camera.view;
  REQUIRE(b.work.camera.scene_camera == 0);
  for (int i = 0; i < 20; ++i) {
    Viewpoint v = *b.work.camera.view;
    orbit(v, {0.02f, 0.01f});
    b.run(Navigation::place_line(v), 5);
  }
  const Viewpoint dragged = *b.work.camera.view;
  b.run("film.ev 1");
  b.run("camera.select Detail");
  b.run("camera.fov 20");
  b.run("camera.speed 3");  // no move
  b.run("undo"), b.run("undo");
  CHECK(same_view(b.work.camera.view->camera, dragged.camera));
  CHECK(b.work.open.setting_real("film.ev") == 1);
  b.run("undo");
  CHECK(b.work.open.setting_real("film.ev") == 0);
  CHECK(same_view(b.work.camera.view->camera, dragged.camera));
  CHECK_THAT(b.work.history.undo_text(), Catch::StartsWith("camera.place "));
  b.run("undo");
  CHECK(same_view(b.work.camera.view->camera, start.camera));
  CHECK(b.work.camera.scene_camera == 0);
  CHECK_FALSE(b.work.history.can_undo());
  REQUIRE(
      b.until([&] { return b.work.open.snapshot && same_view(b.work.open.snapshot->camera, start.camera); }));
  for (int i = 0; i < 4; ++i) b.run("redo");
  CHECK(b.work.camera.scene_camera == -1);
  CHECK(b.work.camera.view->camera.yfov == Approx(20 * k_pi / 180));
  CHECK(b.work.open.setting_real("film.ev") == 1);
  b.run("undo");
  CHECK(b.work.camera.scene_camera == 2);
  b.run("camera.select Detail");  // no move
  CHECK(b.work.history.can_redo());
}

TEST_CASE("bookmarks are stored by name for their scene") {
  WorkspaceBench b;
  b.open();
  const Viewpoint start = *b.work.camera.view;
  b.run("camera.bookmark");
  b.run("camera.orbit 0.4 0.1");
  b.run("camera.fov 30");
  const Viewpoint other = *b.work.camera.view;
  b.run("camera.bookmark \"From the stage\"");
  b.run("camera.go \"View 1\"");
  CHECK(glm::length(eye_of(b.work.camera.view->camera) - eye_of(start.camera)) < 1e-4f);
  CHECK(b.work.camera.view->camera.yfov == Approx(start.camera.yfov));
  b.run("camera.go \"From the stage\"");
  CHECK(glm::length(forward_of(b.work.camera.view->camera) - forward_of(other.camera)) < 1e-5f);
  CHECK(b.work.camera.view->camera.yfov == Approx(30 * k_pi / 180));
  // A session's script needs no bookmark that it has not created.
  CHECK_THAT(b.work.history.script().back(), Catch::StartsWith("camera.place "));
  CHECK(b.work.camera.bookmarks_of(b.work.open.scene.get()).size() == 2);
  CHECK_THAT(b.failure("camera.go \"From the sage\""), Contains("did you mean 'From the stage'?"));
  CHECK_THAT(b.failure("camera.go nowhere"), Contains("there are From the stage, View 1"));
  CHECK_THAT(b.failure("camera.forget nowhere"), Contains("there is no bookmark 'nowhere'"));
  CHECK_THAT(b.failure("camera.bookmark \" \""), Contains("name: it is empty"));
  CHECK_THAT(b.failure("camera.bookmark " + std::string(65, 'x')),
             Contains("65 bytes are too long; at most 64"));
  b.run("camera.forget \"View 1\"");
  CHECK(b.work.camera.bookmarks_of(b.work.open.scene.get()).size() == 1);
  b.open("other.gltf");
  CHECK_THAT(b.failure("camera.go \"From the stage\""), Contains("this scene has no bookmarks"));
  b.open();
  CHECK(b.work.camera.bookmarks_of(b.work.open.scene.get()).size() == 1);
}

TEST_CASE("walking by command stays on the floor") {
  WorkspaceBench b;
  b.open();
  CHECK_THAT(b.failure("camera.walking on"), Contains("there is no floor below the camera"));
  CHECK_FALSE(b.work.camera.walking);
  // The fake scene's triangle is a ramp: it rises by 3 m over 8 m towards +z.
  b.run("camera.place 2,1,-3 2,1,-2 0,1,0");
  b.run("camera.walking on");
  CHECK(b.work.camera.walking);
  CHECK(eye_of(b.work.camera.view->camera).y == Approx(0.375 + 1.65).margin(1e-3));
  b.run("camera.walk 0 2");
  CHECK(eye_of(b.work.camera.view->camera).z == Approx(-1).margin(1e-3));
  CHECK(eye_of(b.work.camera.view->camera).y == Approx(1.125 + 1.65).margin(1e-3));
  b.run("camera.eye_height 1.2");
  CHECK(eye_of(b.work.camera.view->camera).y == Approx(1.125 + 1.2).margin(1e-3));
  b.run("undo"), b.run("undo"), b.run("undo");
  CHECK(eye_of(b.work.camera.view->camera) == vec3(2, 1, -3));
  CHECK_THAT(b.failure("camera.walk nan 1"), Contains("expected a number"));
}

TEST_CASE("exposure is measured by command, at a point, and on loading if set") {
  WorkspaceBench b;
  b.open();
  CHECK(b.work.open.setting_real("film.ev") == 0);  // no window, and no command
  b.run("exposure.find");
  CHECK(b.work.open.setting_real("film.ev") == 2.5);
  CHECK(b.work.history.script().back() == "set film.ev 2.5");
  b.run("exposure.at 0.5 0.5");
  CHECK(b.work.open.setting_real("film.ev") == 1);
  b.run("undo"), b.run("undo");
  CHECK(b.work.open.setting_real("film.ev") == 0);
  const Line black = b.work.run("exposure.at 0.01 0.5");
  REQUIRE(b.until([&] { return !b.work.exposure.measuring(); }));
  CHECK_THROWS_WITH(black.command->done(black.arguments), Contains("it is black there"));
  CHECK(b.errors == 1);
  CHECK_THAT(b.failure("exposure.at 2 0"), Contains("from 0 to 1"));

  b.run("set film.exposure_at_load always");
  REQUIRE(b.settled());
  b.open("other.gltf");
  REQUIRE(b.until([&] { return b.work.open.setting_real("film.ev") == 2.5; }));
  CHECK(b.work.history.undo_text() == "set film.ev 2.5");
  b.run("scene.open third.gltf");
  b.run("set film.ev -1");  // the user's own value
  b.run("wait_scene");
  CHECK_FALSE(b.until([&] { return b.work.open.setting_real("film.ev") != -1; }, 0.5));
}

TEST_CASE("exposure follows replaced daylight, as part of its step") {
  WorkspaceBench b;
  b.open();
  const auto ev = [&] { return b.work.open.setting_real("film.ev"); };
  b.run("sun.set Sun date=2024-06-21 time=10:00 zone=2 latitude=48.1 longitude=11.6");
  b.run("environment.sky preetham");  // exposure is not automatic in scripts
  CHECK_FALSE(b.until([&] { return ev() != 0; }, 0.3));
  b.run("environment.own");
  b.run("set film.exposure_at_load always");
  const Document before = b.work.open.document();
  b.run("environment.sky preetham", 7);  // a control that is held, such as an entry of a list
  REQUIRE(b.until([&] { return ev() == 2.5; }));
  CHECK(b.work.history.script().back() == "set film.ev 2.5");
  b.run("undo");
  CHECK(b.work.open.document() == before);
  b.run("redo");
  CHECK(ev() == 2.5);
  CHECK(b.work.open.sky());

  b.run("sun.set Sun turbidity=4");  // the exposure is right
  b.run("set film.ev 1");            // and less than 2 EV off
  b.run("environment.sky cie_clear");
  CHECK_FALSE(b.until([&] { return ev() != 1; }, 0.3));
  b.run("set film.ev -1");
  b.run("sun.set Sun time=11");                      // the hour is no reason
  b.run("environment.sky cie_clear ground=0.3", 5);  // while a value is dragged it stays
  CHECK_FALSE(b.until([&] { return ev() != -1; }, 0.3));
  b.work.run("sun.set Sun turbidity=5");
  b.work.run("set film.ev -2");  // the user's own value
  CHECK_FALSE(b.until([&] { return ev() != -2; }, 0.3));
}

}  // namespace commands_navigation_tests
