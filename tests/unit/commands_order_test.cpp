// links: commands
// The order in which commands act, and on which scene: each on the state left by the previous ones, and on
// the scene that it was given for. Over a session without a renderer.
#include "support/folder.h"
#include "unit/workspace_bench.h"

namespace commands_order_tests {

using namespace lucerna;
using namespace lucerna::commands;
using namespace lucerna::test;
using Catch::Contains;

namespace {

/// Waits until the session has executed every command.
bool quiet(WorkspaceBench& b) {
  return b.until([&] { return b.work.open.up_to_date() && !b.work.open.loading(); });
}

}  // namespace

TEST_CASE("a camera and a size reach the session before the next command") {
  WorkspaceBench b;
  b.open();
  REQUIRE(quiet(b));
  const uint64_t before = b.session.commands();
  b.fake.busy_ms = 50;
  b.work.run("camera.select Detail");
  CHECK(b.session.commands() == before + 1);
  b.work.run("film.ev 1");
  b.work.camera.set_size(80, 50);
  CHECK(b.work.camera.aspect == Approx(1.6));
  CHECK(b.session.commands() == before + 3);
  CHECK_FALSE(b.work.open.up_to_date());
  b.fake.busy_ms = 0;
  REQUIRE(quiet(b));
  CHECK(same_view(b.work.open.snapshot->camera, b.work.open.scene->cameras[2]));
  CHECK(b.work.open.snapshot->width == 80);
  // A command that changes nothing does not restart the picture.
  const uint64_t given = b.session.commands();
  b.work.run("camera.select Detail");
  b.work.camera.set_size(80, 50);
  CHECK(b.session.commands() == given);
}

TEST_CASE("of several queued cameras only the last is rendered") {
  WorkspaceBench b;
  b.open();
  REQUIRE(quiet(b));
  const uint64_t before = b.session.commands();
  b.fake.busy_ms = 200;
  b.work.run("film.ev 1");  // keeps the session busy
  for (int i = 0; i < 20; ++i) b.work.run("camera.orbit 0.01 0");
  CHECK(b.session.commands() <= before + 3);
  b.fake.busy_ms = 0;
  REQUIRE(quiet(b));
  CHECK(same_view(b.work.open.snapshot->camera, b.work.camera.view->camera));
}

TEST_CASE("no command places the camera where nothing can be rendered") {
  WorkspaceBench b;
  b.open();
  const Viewpoint start = *b.work.camera.view;
  for (const char* line : {"camera.dolly -400", "camera.dolly -1000", "camera.fly 0 0 -1e9",
                           "camera.place 1e9,1e9,1e9 0,0,0 0,1,0", "camera.walk 1e4 1e4 through=on"}) {
    INFO(line);
    std::string failure;
    for (int i = 0; i < 3 && failure.empty(); ++i) failure = b.failure(line);
    if (std::string(line).starts_with("camera.walk") || std::string(line).starts_with("camera.place"))
      CHECK(failure.empty());  // just inside
    else
      CHECK_THAT(failure, Contains("1e+09 m from the origin"));
    const vec3 eye = eye_of(b.work.camera.view->camera);
    CHECK((std::isfinite(eye.x + eye.y + eye.z) && glm::length(eye) < 2e9f));
    b.run(Navigation::place_line(start));
  }
  CHECK_FALSE(b.failure("light.set 2 position=1e10,0,0").empty());
}

TEST_CASE("edits during loading do not reach the new scene") {
  WorkspaceBench b;
  b.open();
  b.run("light.set 2 intensity=1");
  b.run("mix.set \"Brass lamp\" ev=1");
  b.run("relight.presets \"mine = sky: ev=1\"");
  REQUIRE(b.settled());
  REQUIRE(quiet(b));
  for (const std::string line :
       {"undo", "camera.orbit 0.3 0", "camera.dolly -3", "view.solo tertiary", "mix.reset",
        "mix.preset.save more", "mix.preset.delete mine", "mix.group Sun=a b"}) {
    INFO(line);
    b.run("scene.open other.gltf");
    REQUIRE(b.work.open.loading());
    try {
      b.work.run(line);
    } catch (const Error&) {
      // Refused, which is valid too.
    }
    b.run("wait_scene");
    REQUIRE(quiet(b));
    CHECK(same_view(b.work.camera.view->camera, b.work.open.scene->cameras[0]));
    CHECK(same_view(b.work.open.snapshot->camera, b.work.camera.view->camera));
    CHECK(b.session.scene()->lights[1].intensity.x == 12);
    CHECK(b.work.open.solo() == -1);
    CHECK(b.work.open.setting("show.primary") == "true");
    CHECK(b.work.history.script().back() == "wait_scene");
    b.run("light.set 2 intensity=1");
    b.run("mix.set \"Brass lamp\" ev=1");
    REQUIRE(quiet(b));
  }
}

TEST_CASE("edits during a load that fails are kept") {
  WorkspaceBench b;
  b.open();
  REQUIRE(quiet(b));
  b.run("scene.open missing.gltf");
  b.work.run("camera.orbit 0.3 0");
  const Viewpoint moved = *b.work.camera.view;
  b.work.run("film.ev 1");
  REQUIRE(quiet(b));
  CHECK(same_view(b.work.camera.view->camera, moved.camera));
  CHECK(same_view(b.work.open.snapshot->camera, moved.camera));
  CHECK(b.work.open.setting_real("film.ev") == 1);
  CHECK_THAT(b.work.history.script().back(), Catch::StartsWith("set film.ev"));
  CHECK(b.work.history.script().size() == 4);
}

TEST_CASE("two loads in a row: the first is shown when the second fails") {
  WorkspaceBench b;
  b.open();
  b.run("camera.orbit 0.3 0");
  REQUIRE(quiet(b));
  b.run("scene.open other.gltf");
  b.run("scene.open missing.gltf");
  b.run("wait_load");
  REQUIRE(quiet(b));
  CHECK(b.work.open.scene->name == "other");
  CHECK(b.work.camera.view_scene == b.work.open.snapshot->scene_id);
  CHECK(same_view(b.work.camera.view->camera, b.work.open.scene->cameras[0]));
  CHECK(same_view(b.work.open.snapshot->camera, b.work.camera.view->camera));
  b.run("wait_samples 1");
  CHECK(b.failure("wait_scene").empty());
  CHECK_THROWS_WITH(b.work.registry.find("wait_scene")->done({}), "no scene was loaded");
}

TEST_CASE("a cancelled load leaves no trace") {
  WorkspaceBench b;
  b.open();
  b.run("scene.open slow.gltf");
  b.run("scene.cancel");
  CHECK_FALSE(b.work.open.loading());
  CHECK(b.work.history.script().size() == 2);
  CHECK(b.work.open.scene->name == "hall");
}

TEST_CASE("the start camera is not a way to move the camera") {
  WorkspaceBench b;
  b.run("scene.open hall.gltf");
  b.run("camera Detail");
  b.run("wait_scene");
  REQUIRE(quiet(b));
  CHECK_THAT(b.failure("reset camera"), Contains("camera.select takes another one now"));
  CHECK_THAT(b.failure("set camera Entrance"), Contains("camera.select takes another one now"));
  CHECK(b.work.open.setting("camera") == "Detail");
  // Any move updates the view to the picture's camera.
  b.session.set_camera(b.work.open.scene->cameras[1]);
  REQUIRE(quiet(b));
  CHECK(same_view(b.work.camera.view->camera, b.work.open.scene->cameras[1]));
}

TEST_CASE("a refused edit is neither undoable nor saved") {
  WorkspaceBench b;
  b.open();
  b.run("light.set 2 intensity=5");
  REQUIRE(quiet(b));
  const std::vector<std::string> before = b.work.history.script();
  const Document document = b.work.open.document();
  b.run("set relight.mix nonsense");
  CHECK(b.work.history.can_undo());
  REQUIRE(quiet(b));
  CHECK(b.work.history.script() == before);
  CHECK(b.work.open.document() == document);
  CHECK_THAT(b.work.history.undo_text(), Catch::StartsWith("light.set"));
  // A step made before the refusal was known does not restore it.
  b.run("set relight.mix nonsense"), b.run("light.set 1 intensity=7");
  REQUIRE(quiet(b));
  const uint64_t errors = b.errors;
  b.run("undo"), b.run("redo"), b.run("undo");
  REQUIRE(quiet(b));
  CHECK(b.errors == errors);
  CHECK(b.work.open.document() == document);
  // A drag of which only the last step is refused can be undone.
  b.run("set relight.mix \"sky: ev=1\"", 3), b.run("set relight.mix nonsense", 3);
  REQUIRE(quiet(b));
  CHECK_THAT(b.work.history.undo_text(), Contains("relight.mix"));
  CHECK(b.work.open.setting("relight.mix") == "sky: ev=1");
  b.run("undo"), b.run("undo");
  REQUIRE(quiet(b));
  CHECK(b.work.open.setting("relight.mix").empty());
  CHECK(b.work.open.light(1).intensity.x == Approx(12));
  // A file that cannot be read keeps the previous one with its scale and rotation.
  const Folder folder;
  for (const char* name : {"red.exr", "broken.exr"}) std::ofstream(folder.path / name) << "x";
  b.run("environment.load " + quote((folder.path / "red.exr").string()));
  b.run("environment.set scale=3");
  b.run("environment.load " + quote((folder.path / "broken.exr").string()));
  REQUIRE(quiet(b));
  CHECK_THAT(b.work.open.environment_file(), Catch::EndsWith("red.exr"));
  CHECK(b.work.open.environment_scale() == 3);
  CHECK(b.session.scene()->environment.scale == 3);
  CHECK_THAT(b.work.history.undo_text(), Catch::StartsWith("environment.set"));
}

TEST_CASE("a refused size is dropped") {
  WorkspaceBench b;
  b.open();
  b.work.camera.set_size(64, 64);
  REQUIRE(quiet(b));
  b.work.camera.set_size(16384, 16384);
  b.run("wait_samples 1");
  CHECK(b.work.open.snapshot->width == 64);
  CHECK(b.work.camera.aspect == 1);
  b.work.camera.set_size(32, 64);
  REQUIRE(quiet(b));
  CHECK(b.work.open.snapshot->width == 32);
}

TEST_CASE("a wait for samples that will never come is reported") {
  WorkspaceBench b;
  b.open();
  REQUIRE(b.until([&] { return b.work.open.up_to_date() && b.work.open.snapshot->samples >= 3; }));
  b.run("render.pause");
  const Line few = b.work.registry.parse("wait_samples 2"), many = b.work.registry.parse("wait_samples 200");
  REQUIRE(quiet(b));
  CHECK(few.command->done(few.arguments));
  CHECK_THROWS_WITH(many.command->done(many.arguments), Contains("rendering is paused; render.resume"));
  // Its script waits for the number of samples at which the picture was stopped.
  b.run("image.save /tmp/never.exr");
  const std::vector<std::string> lines = b.work.history.script();
  REQUIRE(lines.size() == 6);
  CHECK(lines[2] == line("wait_samples", b.work.open.snapshot->samples, named("limit", 86400)));
  CHECK(lines[3] == "render.pause");
  CHECK(lines[4] == lines[2]);
}

TEST_CASE("a view of either projection is applied to a camera of either projection") {
  WorkspaceBench b;
  b.open();
  b.work.camera.set_size(96, 64);
  const Viewpoint start = *b.work.camera.view;
  b.run("camera.bookmark wide");
  b.run("camera.place 0,1,3 0,1,0 0,1,0 height=2");
  const scene::Camera flat = b.work.camera.view->camera;
  CHECK(flat.orthographic);
  CHECK(flat.ymag == 1);
  CHECK(flat.xmag == 1.5f);
  b.run("camera.bookmark flat");
  b.run("camera.go wide");
  CHECK_FALSE(b.work.camera.view->camera.orthographic);
  CHECK(b.work.camera.view->camera.yfov == Approx(start.camera.yfov));
  CHECK(glm::length(eye_of(b.work.camera.view->camera) - eye_of(start.camera)) < 1e-4f);
  b.run("camera.go flat");
  CHECK(b.work.camera.view->camera.orthographic);
  CHECK(b.work.camera.view->camera.ymag == Approx(1));
  CHECK_THAT(b.failure("camera.place 0,1,3 0,1,0 0,1,0 height=2 fov=40"), Contains("exclude each other"));
}

TEST_CASE("the aspect ratio is that of the picture") {
  WorkspaceBench b;
  b.open();
  REQUIRE(quiet(b));
  CHECK(b.work.camera.aspect == Approx(64.0 / 36));
  b.session.set_size(30, 60);
  REQUIRE(quiet(b));
  CHECK(b.work.camera.aspect == 0.5f);
}

TEST_CASE("a mix written into the lights is one edit for the session, and so is its undo") {
  WorkspaceBench b;
  b.open();
  b.run("mix.set \"Brass lamp\" ev=1");
  b.run("mix.set Sun mute=on");
  REQUIRE(quiet(b));
  const uint64_t before = b.session.commands();
  b.run("mix.apply");
  CHECK(b.session.commands() == before + 1);
  CHECK(b.work.open.light(1).intensity.x == Approx(24));
  CHECK_FALSE(b.work.open.light(0).enabled);
  REQUIRE(b.settled());
  CHECK(b.session.scene()->lights[1].intensity.x == Approx(24));
  CHECK(b.session.settings().text("relight.mix").empty());
  b.run("undo");
  CHECK(b.session.commands() == before + 2);
  REQUIRE(b.settled());
  CHECK(b.session.scene()->lights[1].intensity.x == 12);
  CHECK(b.session.scene()->lights[0].enabled);
  CHECK_THAT(b.session.settings().text("relight.mix"), Contains("Brass lamp"));
}

}  // namespace commands_order_tests
