// links: commands
// What a person works on, over a session without a renderer: edits, undo, navigation, selection, and the
// script of a session that does it all again.
#include "viewer/fake_session.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "base/blackbody.h"
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
        if (!(Document::of(scene->lights[i]) == d.lights[i])) return false;
      for (size_t i = 0; i < scene->materials.size(); ++i) {
        Document::Material m = d.materials[i];
        if (!std::exchange(m.emits, true)) m.emission = vec3(0);
        if (!(Document::of(scene->materials[i]) == m)) return false;
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

TEST_CASE("an edit is shown until the session has carried it out, however busy that is") {
  Bench b;
  b.open();
  session::fake::busy_ms = 100;
  b.run("film.ev 1.5");
  b.run("light.set 1 on=false");
  b.work.refresh(b.timer.seconds() + 1000);
  CHECK(b.session.settings().real("film.ev") == 0);  // it is on its way
  CHECK(b.work.setting_real("film.ev") == 1.5);
  CHECK_FALSE(b.work.light(0).enabled);
  session::fake::busy_ms = 0;
  REQUIRE(b.settled());
  CHECK(b.work.setting_real("film.ev") == 1.5);
  // Then what the session holds is shown, whoever has set it.
  b.session.set("film.ev", "0.25");
  REQUIRE(b.until([&] { return b.work.setting_real("film.ev") == 0.25; }));
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

TEST_CASE("a lamp's colour, power, cone, place and direction are edited") {
  Bench b;
  b.open();
  const Document before = b.work.document();
  // A sun: by its place in the sky, from the east and 30 degrees up.
  b.run("light.set Sun azimuth=90 elevation=30 kelvin=5000");
  const scene::Light sun = b.work.light(0);
  CHECK(glm::length(sun.direction - vec3(-std::cos(k_pi / 6), -0.5f, 0)) < 1e-6f);
  CHECK(glm::length(sun.intensity - 3.1f * blackbody_color(5000)) < 1e-5f);
  b.run("light.set Sun azimuth=180");  // from the south; its height stays
  CHECK(glm::length(b.work.light(0).direction - vec3(0, -0.5f, -std::cos(k_pi / 6))) < 1e-6f);
  // A point lamp: 100 W in all directions.
  b.run("light.set 2 power=100 position=1,2,3");
  CHECK(b.work.light(1).intensity.x == Approx(100 / (4 * k_pi)));
  CHECK(b.work.light(1).intensity.y / b.work.light(1).intensity.x == Approx(9.0 / 12));  // the colour stays
  CHECK(b.work.light(1).position == vec3(1, 2, 3));
  // A spot: the sum over its cone, by quadrature of what the shader does.
  b.run("light.set 3 cone=40 inner_cone=20 power=10 direction=0,-2,0");
  const scene::Light spot = b.work.light(2);
  double sr = 0;
  const double inner = std::cos(20 * k_pi / 180), outer = std::cos(40 * k_pi / 180);
  for (int i = 0; i < 20000; ++i) {
    const double fade = std::clamp(((i + 0.5) / 20000 - outer) / (inner - outer), 0.0, 1.0);
    sr += 2 * double{k_pi} * fade * fade / 20000;
  }
  CHECK(spot.intensity.x * sr == Approx(10).epsilon(1e-4));
  CHECK(spot.direction == vec3(0, -1, 0));
  b.run("light.set 3 cone=10");  // takes the inner one with it
  CHECK(b.work.light(2).inner_cone == b.work.light(2).outer_cone);
  b.run("light.set 3 inner_cone=15");
  CHECK(b.work.light(2).outer_cone * 180 / k_pi == Approx(15));
  REQUIRE(b.settled());
  CHECK(b.session.scene()->lights[1].position == vec3(1, 2, 3));
  for (int i = 0; i < 6; ++i) b.run("undo");
  CHECK(b.work.document() == before);
  REQUIRE(b.settled());

  for (const char* kelvin : {"0", "999", "-5", "nan", "inf", "1e9", "warm"})
    CHECK_THAT(b.failure(std::string("light.set 1 kelvin=") + kelvin),
               Contains(std::string("light.set: kelvin = '") + kelvin +
                        "': expected a number from 1000 to 40000 K"));
  CHECK_THAT(b.failure("light.set 1 elevation=91"), Contains("from -90 to 90 degrees"));
  CHECK_THAT(b.failure("light.set 1 power=3"), Contains("power: a sun shines from infinitely far"));
  CHECK_THAT(b.failure("light.set 1 position=0,0,0"), Contains("position: a sun is infinitely far"));
  CHECK_THAT(b.failure("light.set 2 azimuth=3"), Contains("azimuth: a point lamp shines in all directions"));
  CHECK_THAT(b.failure("light.set 2 cone=30"), Contains("cone: a point lamp has no cone"));
  CHECK_THAT(b.failure("light.set 3 cone=0"), Contains("from 0.01 to 90 degrees"));
  CHECK_THAT(b.failure("light.set 3 cone=10 inner_cone=20"), Contains("inner_cone: 20 degrees is more than"));
  CHECK_THAT(b.failure("light.set 3 direction=0,0,0"), Contains("direction: its length is 0"));
  CHECK_THAT(b.failure("light.set 3 direction=0,1,0 azimuth=3"),
             Contains("direction and azimuth exclude each other"));
  CHECK_THAT(b.failure("light.set 2 color=1,1,1 kelvin=3000"),
             Contains("color and kelvin exclude each other"));
  CHECK_THAT(b.failure("light.set 2 intensity=1 power=3"),
             Contains("intensity and power exclude each other"));
  CHECK_THAT(b.failure("light.set 2 position=0,nan,0"), Contains("position"));
  CHECK(b.work.document() == before);
}

TEST_CASE("what a surface emits is edited as a lamp is, and switched off without being forgotten") {
  Bench b;
  b.open();
  const Document before = b.work.document();
  b.run("material.set Filament strength=80");
  CHECK(b.work.material(4).emission == vec3(80, 56, 24));
  b.run("material.set Filament kelvin=2700");
  CHECK(glm::length(b.work.material(4).emission - 80.0f * blackbody_color(2700)) < 1e-4f);
  b.run("material.set Filament emission_color=0,0.5,0.25");
  CHECK(b.work.material(4).emission == vec3(0, 80, 40));
  b.run("material.set Filament on=off");
  CHECK_FALSE(b.work.emits(4));
  CHECK(b.work.material(4).emission == vec3(0));
  CHECK(b.work.emission(4) == vec3(0, 80, 40));
  REQUIRE(b.settled());
  CHECK(b.session.scene()->materials[4].emission == vec3(0));
  b.run("material.set Filament strength=8");  // while it is off
  CHECK(b.work.material(4).emission == vec3(0));
  b.run("material.set Filament on=on");
  CHECK(b.work.material(4).emission == vec3(0, 8, 4));
  REQUIRE(b.settled());
  CHECK(b.session.scene()->materials[4].emission == vec3(0, 8, 4));
  for (int i = 0; i < 3; ++i) b.run("undo");
  CHECK(b.work.emission(4) == vec3(0, 80, 40));
  CHECK(b.work.emits(4));
  for (int i = 0; i < 3; ++i) b.run("undo");
  CHECK(b.work.document() == before);
  b.run("material.set 1 strength=2");  // it was dark: white
  CHECK(b.work.material(0).emission == vec3(2));
  CHECK_THAT(b.failure("material.set Filament kelvin=0"), Contains("expected a number from 1000 to 40000 K"));
  CHECK_THAT(b.failure("material.set Filament strength=-1"), Contains("strength"));
  CHECK_THAT(b.failure("material.set Filament emission=1,1,1 strength=2"),
             Contains("emission and strength exclude each other"));
  CHECK_THAT(b.failure("material.set Filament emission_color=0,0,0"), Contains("at least one channel"));
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
  CHECK(b.until([&] { return b.session.settings().integer("samples") == 256; }));
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

TEST_CASE("moves of the camera are undone, a drag as one step, among all other steps") {
  Bench b;
  b.open();
  const Viewpoint start = *b.work.view;
  REQUIRE(b.work.scene_camera == 0);
  for (int i = 0; i < 20; ++i) {
    Viewpoint v = *b.work.view;
    orbit(v, {0.02f, 0.01f});
    b.run(Workspace::place_line(v), 5);
  }
  const Viewpoint dragged = *b.work.view;
  b.run("film.ev 1");
  b.run("camera.select Detail");
  b.run("camera.fov 20");
  b.run("camera.speed 3");  // no move
  b.run("undo"), b.run("undo");
  CHECK(same_view(b.work.view->camera, dragged.camera));
  CHECK(b.work.setting_real("film.ev") == 1);
  b.run("undo");
  CHECK(b.work.setting_real("film.ev") == 0);
  CHECK(same_view(b.work.view->camera, dragged.camera));
  CHECK_THAT(b.work.undo_text(), Catch::StartsWith("camera.place "));
  b.run("undo");
  CHECK(same_view(b.work.view->camera, start.camera));
  CHECK(b.work.scene_camera == 0);
  CHECK_FALSE(b.work.can_undo());
  b.work.send_camera();
  REQUIRE(b.until([&] { return b.work.snapshot && same_view(b.work.snapshot->camera, start.camera); }));
  for (int i = 0; i < 4; ++i) b.run("redo");
  CHECK(b.work.scene_camera == -1);
  CHECK(b.work.view->camera.yfov == Approx(20 * k_pi / 180));
  CHECK(b.work.setting_real("film.ev") == 1);
  b.run("undo");
  CHECK(b.work.scene_camera == 2);
  b.run("camera.select Detail");  // moves nothing
  CHECK(b.work.can_redo());
}

TEST_CASE("views are kept by name, for their scene") {
  Bench b;
  b.open();
  const Viewpoint start = *b.work.view;
  b.run("camera.bookmark");
  b.run("camera.orbit 0.4 0.1");
  b.run("camera.fov 30");
  const Viewpoint other = *b.work.view;
  b.run("camera.bookmark \"From the stage\"");
  b.run("camera.go \"View 1\"");
  CHECK(glm::length(eye_of(b.work.view->camera) - eye_of(start.camera)) < 1e-4f);
  CHECK(b.work.view->camera.yfov == Approx(start.camera.yfov));
  b.run("camera.go \"From the stage\"");
  CHECK(glm::length(forward_of(b.work.view->camera) - forward_of(other.camera)) < 1e-5f);
  CHECK(b.work.view->camera.yfov == Approx(30 * k_pi / 180));
  // A script of the session needs no bookmark that it has not made.
  CHECK_THAT(b.work.script().back(), Catch::StartsWith("camera.place "));
  CHECK(b.work.bookmarks_here().size() == 2);
  CHECK_THAT(b.failure("camera.go \"From the sage\""), Contains("did you mean 'From the stage'?"));
  CHECK_THAT(b.failure("camera.go nowhere"), Contains("there are From the stage, View 1"));
  CHECK_THAT(b.failure("camera.forget nowhere"), Contains("there is no bookmark 'nowhere'"));
  CHECK_THAT(b.failure("camera.bookmark \" \""), Contains("name: it is empty"));
  CHECK_THAT(b.failure("camera.bookmark " + std::string(65, 'x')),
             Contains("65 bytes are too long; at most 64"));
  b.run("camera.forget \"View 1\"");
  CHECK(b.work.bookmarks_here().size() == 1);
  b.open("other.gltf");
  CHECK_THAT(b.failure("camera.go \"From the stage\""), Contains("this scene has no bookmarks"));
  b.open();
  CHECK(b.work.bookmarks_here().size() == 1);
}

TEST_CASE("walking by commands keeps to the floor") {
  Bench b;
  b.open();
  CHECK_THAT(b.failure("camera.walking on"), Contains("there is no floor below the camera"));
  CHECK_FALSE(b.work.walking);
  // The fake's one triangle is a ramp: it rises by 3 m on 8 m towards +z.
  b.run("camera.place 2,1,-3 2,1,-2 0,1,0");
  b.run("camera.walking on");
  CHECK(b.work.walking);
  CHECK(eye_of(b.work.view->camera).y == Approx(0.375 + 1.65).margin(1e-3));
  b.run("camera.walk 0 2");
  CHECK(eye_of(b.work.view->camera).z == Approx(-1).margin(1e-3));
  CHECK(eye_of(b.work.view->camera).y == Approx(1.125 + 1.65).margin(1e-3));
  b.run("camera.eye_height 1.2");
  CHECK(eye_of(b.work.view->camera).y == Approx(1.125 + 1.2).margin(1e-3));
  b.run("undo"), b.run("undo"), b.run("undo");
  CHECK(eye_of(b.work.view->camera) == vec3(2, 1, -3));
  CHECK_THAT(b.failure("camera.walk nan 1"), Contains("expected a number"));
}

TEST_CASE("the exposure is found by command, at a point, and at load where that is wanted") {
  Bench b;
  b.open();
  CHECK(b.work.setting_real("film.ev") == 0);  // nobody at a window, nobody has asked
  b.run("exposure.find");
  CHECK(b.work.setting_real("film.ev") == 2.5);
  CHECK(b.work.script().back() == "set film.ev 2.5");
  b.run("exposure.at 0.5 0.5");
  CHECK(b.work.setting_real("film.ev") == 1);
  b.run("undo"), b.run("undo");
  CHECK(b.work.setting_real("film.ev") == 0);
  const Line black = b.work.run("exposure.at 0.01 0.5");
  REQUIRE(b.until([&] { return !b.work.measuring(); }));
  CHECK_THROWS_WITH(black.command->done(black.arguments), Contains("it is black there"));
  CHECK(b.errors == 1);
  CHECK_THAT(b.failure("exposure.at 2 0"), Contains("from 0 to 1"));

  b.run("set film.exposure_at_load always");
  REQUIRE(b.settled());
  b.open("other.gltf");
  REQUIRE(b.until([&] { return b.work.setting_real("film.ev") == 2.5; }));
  CHECK(b.work.undo_text() == "set film.ev 2.5");
  b.run("scene.open third.gltf");
  b.run("set film.ev -1");  // somebody's own
  b.run("wait_scene");
  CHECK_FALSE(b.until([&] { return b.work.setting_real("film.ev") != -1; }, 0.5));
}

TEST_CASE("a dropped image lights the scene until it is undone, unless it cannot be read") {
  Bench b;
  b.open();
  const auto folder = std::filesystem::temp_directory_path();
  const auto file = folder / ("lucerna-sky-" + std::to_string(getpid()) + ".exr");
  const auto broken = folder / ("lucerna-broken-" + std::to_string(getpid()) + ".hdr");
  std::ofstream(file) << "x";
  std::ofstream(broken) << "x";
  b.run("environment.set scale=3 rotation=45");
  b.run("environment.load " + quote(file.string()));
  CHECK(b.work.environment_file() == file.string());
  CHECK(b.work.environment_scale() == 1);
  CHECK(b.work.environment_rotation() == 0);
  REQUIRE(b.settled());
  REQUIRE(b.until([&] { return b.work.scene->environment.file == file.string(); }));
  b.run("undo");
  CHECK(b.work.environment_scale() == 3);
  CHECK(b.work.environment_file().empty());
  REQUIRE(b.until([&] { return b.work.scene->environment.file == "sky/late_morning_2k.exr"; }));
  b.run("redo");
  REQUIRE(b.until([&] { return b.work.scene->environment.file == file.string(); }));
  b.run("environment.own");
  REQUIRE(b.until([&] { return b.work.scene->environment.file != file.string(); }));
  CHECK(b.errors == 0);
  b.run("environment.load " + quote(broken.string()));
  REQUIRE(b.until([&] { return b.work.environment_file().empty(); }));
  CHECK(b.errors == 1);
  CHECK_THAT(b.failure("environment.load /no/such/sky.hdr"), Contains("/no/such/sky.hdr: no such file"));
  std::filesystem::remove(file), std::filesystem::remove(broken);
}

TEST_CASE("a light mix is set, kept, blended, undone and written into the lights") {
  Bench b;
  b.open();
  REQUIRE(b.work.light_groups().groups.size() == 4);
  const std::string reading = b.work.scene->lights[2].name;
  CHECK(b.work.light_groups().groups[3].name == reading);
  b.run("mix.set \"Brass lamp\" ev=1.5 kelvin=2700");
  CHECK(b.work.light_mix().at("Brass lamp").ev == 1.5f);
  CHECK(b.work.light_mix().at("Brass lamp").color == blackbody_color(2700));
  b.run("mix.set sky mute=true");
  b.run("mix.set \"Brass lamp\" color=1,0.5,0");
  CHECK(b.work.setting("relight.mix") == "Brass lamp: ev=1.5 color=1,0.5,0; sky: mute");
  b.run("mix.preset.save evening");
  b.run("mix.reset");
  CHECK(b.work.setting("relight.mix").empty());
  b.run("mix.set Sun factor=0");
  CHECK(b.work.light_mix().at("Sun").mute);
  b.run("mix.set Sun factor=4");
  CHECK(b.work.light_mix().at("Sun") == scene::GroupMix{.ev = 2});
  b.run("mix.preset.save morning");
  b.run("mix.preset.blend evening morning 0");
  CHECK(b.work.setting("relight.mix") == "Brass lamp: ev=1.5 color=1,0.5,0; sky: mute");
  b.run("mix.preset.blend evening morning 0.5");
  const std::vector<vec3> half = scene::mix_weights(b.work.light_mix(), b.work.light_groups());
  CHECK(half[0].x == Approx(0.5));  // the sky
  CHECK(half[1].x == Approx(2.5));
  REQUIRE(b.settled());
  CHECK(b.session.settings().text("relight.mix") == b.work.setting("relight.mix"));

  // Steps of a drag are one.
  const std::string before = b.work.setting("relight.mix");
  for (const char* ev : {"1", "2", "3"}) b.run(std::string("mix.set Sun ev=") + ev, 7);
  CHECK(b.work.light_mix().at("Sun").ev == 3);
  b.run("undo");
  CHECK(b.work.setting("relight.mix") == before);

  // What cannot be done is said, and changes nothing.
  CHECK_THAT(b.failure("mix.set Moon ev=1"), Contains("'Moon'") && Contains("sky, Sun, Brass lamp"));
  CHECK_THAT(b.failure("mix.set sky kelvin=0"), Contains("kelvin"));
  CHECK_THAT(b.failure("mix.set sky ev=1 factor=2"), Contains("exclude"));
  CHECK_THAT(b.failure("mix.preset.load noon"), Contains("'noon'") && Contains("evening, morning"));
  CHECK(b.work.setting("relight.mix") == before);
  // Rules of groups part at = and ;, and any character stands for these in a name.
  b.run("mix.group \"a=b; c\" d");
  CHECK_THAT(b.work.setting("relight.groups"), Contains("a?b? c=d"));
  b.run("undo");
  b.run("mix.preset.delete morning");
  CHECK(b.work.mix_presets().size() == 1);
  // A preset of another scene: what is here of it is taken up.
  b.run("set relight.presets \"other = Chandelier: mute; Sun: ev=-1\"");
  b.run("mix.preset.load other");
  CHECK(scene::mix_weights(b.work.light_mix(), b.work.light_groups())[1] == vec3(0.5f));

  // Into the lights: a lamp that is mute is off, an environment takes no colour.
  b.run("set relight.mix \"Sun: ev=1 color=1,0.5,1; Brass lamp: mute; sky: color=1,0.5,0.5\"");
  const Document unmixed = b.work.document();
  b.run("mix.apply");
  CHECK(b.work.light(0).intensity == unmixed.lights[0].intensity * vec3(2, 1, 2));
  CHECK_FALSE(b.work.light(1).enabled);
  CHECK(b.work.light(1).intensity == unmixed.lights[1].intensity);
  CHECK(b.work.light(2).intensity == unmixed.lights[2].intensity);
  CHECK(b.work.environment_scale() == unmixed.environment_scale);
  CHECK(b.work.setting("relight.mix") == "sky: color=1,0.5,0.5");
  REQUIRE(b.settled());
  b.run("undo");
  CHECK(b.work.document() == unmixed);
  b.run("set relight.mix \"sky: ev=-2\"");
  b.run("mix.apply");
  CHECK(b.work.environment_scale() == 0.25f * unmixed.environment_scale);
  CHECK(b.work.setting("relight.mix").empty());

  b.run("mix.group *lamp* lamps");
  CHECK(b.work.light_groups().groups.size() == 3);
  CHECK(b.work.light_groups().groups[2].name == "lamps");
  CHECK(b.work.light_groups().groups[2].lamps == 2);
}
