// links: commands
// What a person works on, over a session without a renderer: edits, undo, navigation, selection, and the
// script of a session that does it all again.
#include "viewer/fake_session.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "commands/workspace.h"

using namespace lucerna;
using namespace lucerna::commands;
using Catch::Contains;

namespace {

/// A workspace whose session is given time until a condition holds.
struct Bench {
  session::Session session{session::Options{}};
  Workspace work{session};
  Timer timer;
  int token;

  Bench() {
    log::set_console_level(log::Level::error);
    token = log::add_listener([this](log::Level level, const std::string&) {
      if (level == log::Level::error) ++errors;
    });
    session.set_size(64, 36);
  }
  ~Bench() { log::remove_listener(token); }

  void refresh() {
    work.error_count = errors;
    work.refresh(timer.seconds());
  }
  bool until(const std::function<bool()>& holds, double seconds = 10) {
    const Timer waited;
    for (refresh(); !holds(); refresh()) {
      if (waited.seconds() > seconds) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  /// Runs a line as a script does: to its end.
  void run(const std::string& line, uint64_t gesture = 0) {
    refresh();
    const Line done = work.run(line, gesture);
    if (done.command && done.command->done)
      REQUIRE(until([&] { return done.command->done(done.arguments); }));
  }
  void open(const std::string& file = "hall.gltf") { run("scene.open " + file), run("wait_scene"); }
  /// Everything that the session has been told has arrived.
  bool settled() {
    return until([&] {
      const Document d = work.document();
      if (work.loading() || session.settings().all() != d.settings) return false;
      const auto scene = session.scene();
      if (!scene) return true;
      for (size_t i = 0; i < scene->lights.size(); ++i)
        if (!(Document::Light{scene->lights[i].intensity, scene->lights[i].enabled} == d.lights[i]))
          return false;
      for (size_t i = 0; i < scene->materials.size(); ++i) {
        const scene::Material& m = scene->materials[i];
        if (!(Document::Material{vec3(m.base_color), m.roughness, m.metallic, m.emission} == d.materials[i]))
          return false;
      }
      return scene->environment.scale == d.environment_scale &&
             scene->environment.rotation == d.environment_rotation;
    });
  }
  std::string failure(const std::string& line) {
    refresh();
    try {
      work.run(line);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  std::atomic<uint64_t> errors{0};
};

}  // namespace

TEST_CASE("edits are seen at once, reach the session, and are undone and done again") {
  Bench b;
  b.open();
  const Document before = b.work.document();
  REQUIRE(before.lights.size() == 3);
  b.run("film.ev 1.5");
  CHECK(b.work.setting_real("film.ev") == 1.5);
  b.run("light.set \"Brass lamp\" intensity=24 on=false");
  CHECK(b.work.light(1).intensity.x == Approx(24));
  CHECK(b.work.light(1).intensity.y == Approx(18));  // the colour stays
  CHECK_FALSE(b.work.light(1).enabled);
  b.run("light.set 1 color=0,0,2");
  CHECK(b.work.light(0).intensity == vec3(0, 0, 3.1f));
  b.run("environment.set rotation=90");
  b.run("view.show tertiary off");
  const Document after = b.work.document();
  REQUIRE(b.settled());
  CHECK(b.session.scene()->lights[0].intensity == vec3(0, 0, 3.1f));
  CHECK(b.session.settings().text("show.tertiary") == "false");

  CHECK(b.work.undo_text() == "view.show tertiary false");
  for (int i = 0; i < 5; ++i) b.run("undo");
  CHECK(b.work.document() == before);
  REQUIRE(b.settled());
  CHECK(b.session.settings().real("film.ev") == 0);
  CHECK(b.session.scene()->lights[1].enabled);
  CHECK_FALSE(b.work.can_undo());
  CHECK(b.failure("undo") == "undo: there is nothing to undo");
  for (int i = 0; i < 5; ++i) b.run("redo");
  CHECK(b.work.document() == after);
  REQUIRE(b.settled());
  CHECK_FALSE(b.work.can_redo());

  b.run("undo");
  b.run("film.ev -1");  // a new step ends what could be done again
  CHECK_FALSE(b.work.can_redo());
}

TEST_CASE("materials are edited like lights, and keep what is not given") {
  Bench b;
  b.open();
  const Document before = b.work.document();
  REQUIRE(before.materials.size() == b.work.scene->materials.size());
  b.run("material.set 1 color=0.1,0.2,0.3 roughness=0.25");
  b.run("material.set 1 metallic=1 emission=0,2,0");
  const scene::Material m = b.work.material(0);
  CHECK(vec3(m.base_color) == vec3(0.1f, 0.2f, 0.3f));
  CHECK(m.base_color.w == b.work.scene->materials[0].base_color.w);
  CHECK(m.roughness == 0.25f);
  CHECK(m.metallic == 1);
  CHECK(m.emission == vec3(0, 2, 0));
  REQUIRE(b.settled());
  CHECK(b.session.scene()->materials[0].roughness == 0.25f);
  b.run("undo"), b.run("undo");
  CHECK(b.work.document() == before);
  REQUIRE(b.settled());
  const std::string count = std::to_string(before.materials.size());
  CHECK_THAT(b.failure("material.set 99 metallic=1"),
             Contains("there is no material 99; the scene has " + count));
  CHECK_THAT(b.failure("material.set marmalade metallic=1"),
             Contains("the scene has no material 'marmalade'"));
  CHECK_THAT(b.failure("material.set 1 color=1,2,0"), Contains("color"));
}

TEST_CASE("a drag is one step; another drag, another control or no drag is another") {
  Bench b;
  b.open();
  for (int i = 1; i <= 20; ++i) b.run(line("film.ev", 0.1f * static_cast<float>(i)), 7);
  b.run("film.ev 3", 8);
  b.run("environment.set scale=2", 8);
  b.run("environment.set rotation=10", 8);
  b.run("film.ev 3");  // nothing changes: no step
  int steps = 0;
  for (; b.work.can_undo(); ++steps) b.run("undo");
  CHECK(steps == 4);
  const std::vector<std::string> script = b.work.script();
  CHECK(script[2] == "set film.ev 2");
  CHECK(script[3] == "set film.ev 3");
  CHECK(script.size() == 6 + 4);
}

TEST_CASE("the steps of a drag give what its last step alone gives") {
  Bench dragged, at_once;
  dragged.open(), at_once.open();
  for (int i = 0; i < 200; ++i)
    dragged.run(line("light.set", 1, named("intensity", 0.137f * static_cast<float>(i + 1))), 3);
  at_once.run(dragged.work.script().back());
  CHECK(dragged.work.light(0).intensity == at_once.work.light(0).intensity);
  dragged.run("undo");
  CHECK(dragged.work.light(0).intensity == vec3(3.1f, 2.9f, 2.6f));
}

TEST_CASE("solo shows one component, moves to another and comes back") {
  Bench b;
  b.open();
  b.run("view.show caustic off");
  const Document before = b.work.document();
  b.run("view.solo secondary");
  CHECK(b.work.setting_on("show.secondary"));
  CHECK_FALSE(b.work.setting_on("show.primary"));
  b.run("view.solo primary");
  CHECK(b.work.setting_on("show.primary"));
  CHECK_FALSE(b.work.setting_on("show.secondary"));
  b.run("view.solo none");
  CHECK_FALSE(b.work.setting_on("show.caustic"));
  CHECK(b.work.setting_on("show.tertiary"));
  b.run("undo"), b.run("undo");
  CHECK(b.work.solo() == 1);
  b.run("undo");
  CHECK(b.work.document() == before);
}

TEST_CASE("what cannot be done says why and changes nothing") {
  Bench b;
  b.refresh();
  CHECK_THAT(b.failure("camera.orbit 1 0"), Contains("camera.orbit: there is no picture yet"));
  CHECK_THAT(b.failure("light.set 1 on=off"), Contains("no scene is open"));
  CHECK_THAT(b.failure("select light 1"), Contains("no scene is open"));
  b.open();
  const Document before = b.work.document();
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
  CHECK(b.work.document() == before);
  CHECK_FALSE(b.work.can_undo());
  CHECK(b.work.script().size() == 2);  // the scene alone
}

TEST_CASE("a failed load is noticed, and the scene before stays") {
  Bench b;
  b.open();
  b.run("select light 2");
  b.run("scene.open missing.gltf");
  CHECK(b.work.loading());
  CHECK_THAT(b.failure("light.set 1 on=off"), Contains("a scene is being loaded"));
  const Command* wait = b.work.registry.find("wait_scene");
  REQUIRE(b.until([&] { return !b.work.loading(); }));
  CHECK_THROWS_WITH(wait->done({}), "no scene was loaded");
  CHECK(b.work.scene->name == "hall");
  CHECK(b.work.selection == Selection{Kind::light, 1});
  CHECK(b.work.script().back() == "select light 2");  // a load that failed is not done again
  b.open("other.gltf");
  CHECK(b.work.scene->name == "other");
  CHECK(b.work.selection == Selection{});
  CHECK_FALSE(b.work.can_undo());  // steps of the scene before mean nothing here
}

TEST_CASE("a session's script waits for the picture that was saved, and leaves out what failed") {
  Bench b;
  b.open();
  b.run("set samples 12");
  b.run("wait_samples 12");
  b.run("image.save /tmp/never.exr");  // written by nobody here
  const auto finished = b.work.script();
  CHECK(finished[finished.size() - 2] == "wait_samples 12 limit=86400");
  CHECK(finished.back() == "image.save /tmp/never.exr");
  CHECK(std::count_if(finished.begin(), finished.end(),
                      [](const std::string& line) { return line.starts_with("wait_samples"); }) == 1);
  // A person's: no wait was said, and rendering was paused.
  Bench p;
  p.open();
  REQUIRE(p.until([&] { return p.work.up_to_date() && p.work.snapshot->samples >= 5; }));
  p.run("render.pause");
  REQUIRE(p.until([&] { return p.work.up_to_date() && p.work.snapshot->paused; }));
  p.run("image.save /tmp/never.png");
  const auto lines = p.work.script();
  REQUIRE(lines.size() == 6);
  CHECK_THAT(lines[2], Catch::StartsWith("wait_samples "));
  CHECK(lines[3] == "render.pause");
  CHECK_THAT(lines[4], Catch::StartsWith("wait_samples "));
}

TEST_CASE("a setting made while a scene is being loaded is not lost") {
  Bench b;
  b.run("scene.open slow.gltf");
  b.run("samples 64");
  b.run("samples 256");  // the default, but who knows what the scene brings
  b.run("wait_scene");
  REQUIRE(b.settled());
  CHECK(b.session.settings().integer("samples") == 256);
  CHECK(b.work.script().size() == 4);
}

TEST_CASE("a click selects the object, then its material, then nothing") {
  Bench b;
  b.open();
  b.work.aspect = 2;
  b.run("camera.place 3,1.5,20 1,0.5,-1.5 0,1,0");  // the triangle's middle in the middle
  b.run("pick 0.5 0.5");
  CHECK(b.work.selection == Selection{Kind::instance, 0});
  CHECK(b.work.selection_name() == "column 0");
  b.run("pick 0.5 0.5");
  CHECK(b.work.selection == Selection{Kind::material, 0});
  b.run("pick 0.02 0.02");
  CHECK(b.work.selection == Selection{});
  const auto script = b.work.script();
  CHECK(script.back() == "select.none");
  CHECK(script[script.size() - 2] == "select material 1");
}

TEST_CASE("a saved session, done again, gives the same") {
  const auto file =
      std::filesystem::temp_directory_path() / ("lucerna-session-" + std::to_string(getpid()) + ".lucerna");
  Bench a;
  a.open();
  a.run("film.tone_curve agx");
  a.run("camera.select Detail");
  for (int i = 0; i < 30; ++i) {  // a drag of the mouse, as the window makes it
    Viewpoint v = *a.work.view;
    orbit(v, {0.01f, 0.003f});
    a.run(Workspace::place_line(v), 11);
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

  Bench b;
  std::ifstream in(file);
  int lines = 0;
  for (std::string line; std::getline(in, line); ++lines) b.run(line);
  CHECK(lines == 18);  // a remark, and the drags as one line each
  CHECK(b.work.document() == a.work.document());
  CHECK(b.work.solo() == 2);
  CHECK(b.work.selection == a.work.selection);
  CHECK(b.work.speed == a.work.speed);
  REQUIRE((a.work.view && b.work.view));
  CHECK(same_view(a.work.view->camera, b.work.view->camera));
  CHECK(a.work.view->distance == b.work.view->distance);
  CHECK(b.work.script() == a.work.script());
  CHECK(a.work.undo_text() == b.work.undo_text());
  REQUIRE(b.settled());
  CHECK(b.session.settings().all() == a.work.document().settings);
  std::filesystem::remove(file);
}
