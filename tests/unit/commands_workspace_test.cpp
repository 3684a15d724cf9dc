// links: commands
// The workspace over a session without a renderer: edits, undo, failures, and a session script that repeats
// everything.
#include "unit/workspace_bench.h"

namespace commands_workspace_tests {

using namespace lucerna;
using namespace lucerna::commands;
using namespace lucerna::test;
using Catch::Contains;

TEST_CASE("edits are visible immediately, reach the session, and can be undone and redone") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  REQUIRE(before.lights.size() == 3);
  b.run("film.ev 1.5");
  CHECK(b.work.open.setting_real("film.ev") == 1.5);
  b.run("light.set \"Brass lamp\" intensity=24 on=false");
  CHECK(b.work.open.light(1).intensity.x == Approx(24));
  CHECK(b.work.open.light(1).intensity.y == Approx(18));  // the colour stays
  CHECK_FALSE(b.work.open.light(1).enabled);
  b.run("light.set 1 color=0,0,2");
  CHECK(b.work.open.light(0).intensity == vec3(0, 0, 3.1f));
  b.run("environment.set rotation=90");
  b.run("view.show tertiary off");
  const Document after = b.work.open.document();
  REQUIRE(b.settled());
  CHECK(b.session.scene()->lights[0].intensity == vec3(0, 0, 3.1f));
  CHECK(b.session.settings().text("show.tertiary") == "false");

  CHECK(b.work.history.undo_text() == "view.show tertiary false");
  for (int i = 0; i < 5; ++i) b.run("undo");
  CHECK(b.work.open.document() == before);
  REQUIRE(b.settled());
  CHECK(b.session.settings().real("film.ev") == 0);
  CHECK(b.session.scene()->lights[1].enabled);
  CHECK_FALSE(b.work.history.can_undo());
  CHECK(b.failure("undo") == "undo: there is nothing to undo");
  for (int i = 0; i < 5; ++i) b.run("redo");
  CHECK(b.work.open.document() == after);
  REQUIRE(b.settled());
  CHECK_FALSE(b.work.history.can_redo());

  b.run("undo");
  b.run("film.ev -1");  // a new step ends the redo list
  CHECK_FALSE(b.work.history.can_redo());
}

TEST_CASE("an edit is shown until the session has executed it, however busy the session is") {
  WorkspaceBench b;
  b.open();
  b.fake.busy_ms = 100;
  b.run("film.ev 1.5");
  b.run("light.set 1 on=false");
  b.work.refresh(b.timer.seconds() + 1000);
  CHECK(b.session.settings().real("film.ev") == 0);  // it is queued
  CHECK(b.work.open.setting_real("film.ev") == 1.5);
  CHECK_FALSE(b.work.open.light(0).enabled);
  b.fake.busy_ms = 0;
  REQUIRE(b.settled());
  CHECK(b.work.open.setting_real("film.ev") == 1.5);
  // Then the session's value is shown, whatever has set it.
  b.session.set("film.ev", "0.25");
  REQUIRE(b.until([&] { return b.work.open.setting_real("film.ev") == 0.25; }));
}

TEST_CASE("a drag is one step; another drag, another control or no drag is another") {
  WorkspaceBench b;
  b.open();
  for (int i = 1; i <= 20; ++i) b.run(line("film.ev", 0.1f * static_cast<float>(i)), 7);
  b.run("film.ev 3", 8);
  b.run("environment.set scale=2", 8);
  b.run("environment.set rotation=10", 8);
  b.run("film.ev 3");  // no change: no step
  int steps = 0;
  for (; b.work.history.can_undo(); ++steps) b.run("undo");
  CHECK(steps == 4);
  const std::vector<std::string> script = b.work.history.script();
  CHECK(script[2] == "set film.ev 2");
  CHECK(script[3] == "set film.ev 3");
  CHECK(script.size() == 6 + 4);
}

TEST_CASE("the steps of a drag give the result of its last step alone") {
  WorkspaceBench dragged, at_once;
  dragged.open(), at_once.open();
  for (int i = 0; i < 200; ++i)
    dragged.run(line("light.set", 1, named("intensity", 0.137f * static_cast<float>(i + 1))), 3);
  at_once.run(dragged.work.history.script().back());
  CHECK(dragged.work.open.light(0).intensity == at_once.work.open.light(0).intensity);
  dragged.run("undo");
  CHECK(dragged.work.open.light(0).intensity == vec3(3.1f, 2.9f, 2.6f));
}

TEST_CASE("a failed command reports the reason and changes nothing") {
  WorkspaceBench b;
  b.refresh();
  CHECK_THAT(b.failure("camera.orbit 1 0"), Contains("camera.orbit: there is no picture yet"));
  CHECK_THAT(b.failure("light.set 1 on=off"), Contains("no scene is open"));
  CHECK_THAT(b.failure("select light 1"), Contains("no scene is open"));
  b.open();
  const Document before = b.work.open.document();
  CHECK(b.failure("light.set \"Bras lamp\" on=off") ==
        "light.set: the scene has no light 'Bras lamp'; did you mean 'Brass lamp'?");
  CHECK_THAT(b.failure("light.set 4 on=off"), Contains("there is no light 4; the scene has 3"));
  CHECK_THAT(b.failure("light.set 1.5 on=off"), Contains("there is no light 1.5"));
  CHECK_THAT(b.failure("light.set 1 color=0,0,0"), Contains("at least one channel"));
  CHECK_THAT(b.failure("camera.select Entrence"), Contains("did you mean 'Entrance'?"));
  CHECK_THAT(b.failure("camera.place 0,0,0 0,0,0 0,1,0"), Contains("eye and target must differ"));
  CHECK_THAT(b.failure("camera.place 0,0,0 0,1,0 0,1,0"), Contains("up must not point"));
  CHECK_THAT(b.failure("camera.height 2"), Contains("the camera is not orthographic"));
  CHECK_THAT(b.failure("select material 99"), Contains("there is no material 99"));
  CHECK_THAT(b.failure("script.save /no/such/folder/x.lucerna"), Contains("cannot be written: No such file"));
  CHECK(b.work.open.document() == before);
  CHECK_FALSE(b.work.history.can_undo());
  CHECK(b.work.history.script().size() == 2);  // the scene only
}

TEST_CASE("a failed load is reported, and the previous scene stays") {
  WorkspaceBench b;
  b.open();
  b.run("select light 2");
  b.run("scene.open missing.gltf");
  CHECK(b.work.open.loading());
  CHECK_THAT(b.failure("light.set 1 on=off"), Contains("a scene is being loaded"));
  const Command* wait = b.work.registry.find("wait_scene");
  REQUIRE(b.until([&] { return !b.work.open.loading(); }));
  CHECK_THROWS_WITH(wait->done({}), "no scene was loaded");
  CHECK(b.work.open.scene->name == "hall");
  CHECK(b.work.camera.selection == Selection{Kind::light, 1});
  CHECK(b.work.history.script().back() == "select light 2");  // a failed load is not repeated
  // Nor are pictures and records that could not be read.
  b.run("reference.load missing.exr"), b.run("cache.load missing.cache");
  CHECK(b.until([&] { return b.work.history.script().back() == "select light 2"; }));
  CHECK(b.errors == 3);
  b.run("reference.load truth.exr");
  REQUIRE(b.settled());
  CHECK_THAT(b.work.history.script().back(), Contains("reference.load") && Contains("truth.exr"));
  b.open("other.gltf");
  CHECK(b.work.open.scene->name == "other");
  CHECK(b.work.camera.selection == Selection{});
  CHECK_FALSE(b.work.history.can_undo());  // steps of the previous scene do not apply here
}

TEST_CASE("a session's script waits for the saved picture, and omits failed commands") {
  WorkspaceBench b;
  b.open();
  b.run("set samples 12");
  b.run("wait_samples 12");
  b.run("image.save /tmp/never.exr");  // the fake session writes no file
  const auto finished = b.work.history.script();
  CHECK(finished[finished.size() - 2] == "wait_samples 12 limit=86400");
  CHECK(finished.back() == "image.save /tmp/never.exr");
  CHECK(std::count_if(finished.begin(), finished.end(),
                      [](const std::string& line) { return line.starts_with("wait_samples"); }) == 1);
  // The script of a user session: without a wait, and rendering was paused.
  WorkspaceBench p;
  p.open();
  REQUIRE(p.until([&] { return p.work.open.up_to_date() && p.work.open.snapshot->samples >= 5; }));
  p.run("render.pause");
  REQUIRE(p.until([&] { return p.work.open.up_to_date() && p.work.open.snapshot->paused; }));
  p.run("image.save /tmp/never.png");
  const auto lines = p.work.history.script();
  REQUIRE(lines.size() == 6);
  CHECK_THAT(lines[2], Catch::StartsWith("wait_samples "));
  CHECK(lines[3] == "render.pause");
  CHECK_THAT(lines[4], Catch::StartsWith("wait_samples "));
}

TEST_CASE("a setting made while a scene is loading is kept") {
  WorkspaceBench b;
  b.run("scene.open slow.gltf");
  b.run("samples 64");
  b.run("samples 256");  // the default, but the scene may set another
  b.run("wait_scene");
  REQUIRE(b.settled());
  CHECK(b.until([&] { return b.session.settings().integer("samples") == 256; }));
  CHECK(b.work.history.script().size() == 4);
}

TEST_CASE("a repeated session script gives the same state") {
  const auto file =
      std::filesystem::temp_directory_path() / ("lucerna-session-" + std::to_string(getpid()) + ".lucerna");
  WorkspaceBench a;
  a.open();
  a.run("film.tone_curve agx");
  a.run("camera.select Detail");
  for (int i = 0; i < 30; ++i) {  // a drag of the mouse, as the window sends it
    Viewpoint v = *a.work.camera.view;
    orbit(v, {0.01f, 0.003f});
    a.run(Navigation::place_line(v), 11);
  }
  a.run("camera.dolly 1.5");
  a.run("camera.fov 33.3");
  for (int i = 0; i < 10; ++i)
    a.run(line("light.set", 2, named("intensity", 3.7f * static_cast<float>(i))), 12);
  a.run("view.solo tertiary");
  a.run("environment.set scale=0.25 rotation=-30");
  a.run("film.ev 2");
  a.run("undo"), a.run("undo"), a.run("redo");
  a.run("components.caustic off");
  a.run("select light \"Reading lamp on the north wall, second from the left\"");
  a.run("camera.speed 2.5");
  a.run("script.save " + quote(file.string()));

  WorkspaceBench b;
  std::ifstream in(file);
  int lines = 0;
  for (std::string line; std::getline(in, line); ++lines) b.run(line);
  CHECK(lines == 18);  // a comment, and the drags as one line each
  CHECK(b.work.open.document() == a.work.open.document());
  CHECK(b.work.open.solo() == 2);
  CHECK(b.work.camera.selection == a.work.camera.selection);
  CHECK(b.work.camera.speed == a.work.camera.speed);
  REQUIRE((a.work.camera.view && b.work.camera.view));
  CHECK(same_view(a.work.camera.view->camera, b.work.camera.view->camera));
  CHECK(a.work.camera.view->distance == b.work.camera.view->distance);
  CHECK(b.work.history.script() == a.work.history.script());
  CHECK(a.work.history.undo_text() == b.work.history.undo_text());
  REQUIRE(b.settled());
  CHECK(b.session.settings().all() == a.work.open.document().settings);
  std::filesystem::remove(file);
}

}  // namespace commands_workspace_tests
