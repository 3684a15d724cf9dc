// links: commands
// Adding, copying, deleting, naming and aiming lights by command; the sun by date; skies.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scene/lamp.h"
#include "scene/solar.h"
#include "unit/workspace_bench.h"

namespace commands_light_list_tests {

using namespace lucerna;
using namespace lucerna::commands;
using namespace lucerna::test;
using Catch::Contains;

namespace {

std::vector<std::string> names(const WorkspaceBench& b) { return names_of(b.work.open.lights()); }

}  // namespace

TEST_CASE("lights are added, copied and deleted, each in one undo step") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  b.run("light.add spot name=Desk position=1,2,3 direction=0,-1,0 power=20 cone=30");
  REQUIRE(b.work.open.lights().size() == 4);
  const scene::Light desk = b.work.open.light(3);
  CHECK(desk.kind == scene::LightKind::spot);
  CHECK(desk.position == vec3(1, 2, 3));
  CHECK(desk.direction == vec3(0, -1, 0));
  CHECK(desk.outer_cone * 180 / k_pi == Approx(30));
  CHECK(b.work.camera.selection == Selection{Kind::light, 3});
  CHECK(b.work.selection_name() == "Desk");
  b.run("light.duplicate Desk by=1,0,0");
  CHECK(names(b).back() == "Desk 2");
  CHECK(b.work.open.light(4).position == vec3(2, 2, 3));
  CHECK(b.work.open.light(4).id != desk.id);
  b.run("light.set \"Desk 2\" intensity=5");
  b.run("light.delete Desk");
  CHECK(names(b) == std::vector<std::string>{"Sun", "Brass lamp", names(b)[2], "Desk 2"});
  REQUIRE(b.settled());
  CHECK(b.session.scene()->lights.size() == 4);
  b.run("undo");
  CHECK(b.work.open.light(3) == desk);
  b.run("undo"), b.run("undo"), b.run("undo");
  CHECK(b.work.open.document() == before);
  REQUIRE(b.settled());
  CHECK(b.session.scene()->lights.size() == 3);
  for (int i = 0; i < 4; ++i) b.run("redo");
  CHECK(names(b).back() == "Desk 2");
  CHECK(b.work.open.light(3).intensity.x == 5);
  REQUIRE(b.settled());
}

TEST_CASE("a selected light stays selected when others come and go") {
  WorkspaceBench b;
  b.open();
  b.run("select light \"Brass lamp\"");
  b.run("light.delete Sun");
  CHECK(b.work.camera.selection == Selection{Kind::light, 0});
  CHECK(b.work.selection_name() == "Brass lamp");
  b.run("undo");
  CHECK(b.work.selection_name() == "Brass lamp");
  CHECK(b.work.camera.selection.index == 1);
  b.run("light.delete \"Brass lamp\"");
  CHECK(b.work.camera.selection.kind == Kind::none);
}

TEST_CASE("an edit of a light that is still on its way is kept") {
  WorkspaceBench b;
  b.open();
  b.fake.busy_ms = 50;
  b.run("light.add point name=A position=0,1,0 intensity=1");
  b.run("light.set A intensity=2");
  b.run("light.add point name=B position=0,1,1 intensity=3");
  b.run("light.rename A C");
  CHECK(names(b) == std::vector<std::string>{"Sun", "Brass lamp", names(b)[2], "C", "B"});
  b.fake.busy_ms = 0;
  REQUIRE(b.settled());
  CHECK(b.session.scene()->lights[3].intensity.x == 2);
  CHECK(b.session.scene()->lights[3].name == "C");
}

TEST_CASE("a new lamp stands before the surface that is looked at, strong enough for the exposure") {
  WorkspaceBench b;
  b.open();
  b.run("film.ev 2");
  b.run("light.add point");
  const scene::Light lamp = b.work.open.lights().back();
  CHECK(lamp.name == "Lamp");
  const Viewpoint& view = *b.work.camera.view;
  // In front of the eye, on the axis or off it by the surface's normal.
  CHECK(glm::dot(lamp.position - eye_of(view.camera), forward_of(view.camera)) > 0);
  const float quarter = 0.25f * b.work.camera.core.radius();
  CHECK(lamp.intensity.x == Approx(k_pi / 4 * quarter * quarter));
  b.run("light.add point");
  CHECK(b.work.open.lights().back().name == "Lamp 2");
  // Not into the first one, but beside it.
  const float way = glm::distance(b.work.open.lights().back().position, lamp.position);
  CHECK(way == Approx(0.1f * b.work.camera.core.radius()));
  b.run("light.add spot");
  const scene::Light spot = b.work.open.lights().back();
  CHECK(glm::length(spot.direction) == Approx(1));
  b.run("light.add sun");
  CHECK(b.work.open.lights().back().intensity.x == Approx(k_pi / 4));
  CHECK(b.work.open.lights().back().name == "Sun 2");
}

TEST_CASE("lamps with a shape are added, sized, turned and hidden, and keep their power") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  b.run("light.add rectangle name=Panel power=40 width=1 height=0.5 direction=0,-1,0 right=0,0,1");
  scene::Light l = b.work.open.lights().back();
  CHECK(l.kind == scene::LightKind::rectangle);
  CHECK(l.right == vec3(0, 0, 1));
  CHECK(l.intensity.x * k_pi == Approx(40));
  b.run("light.set Panel width=2");
  b.run("light.set Panel two_sided=true visible=false roll=90");
  l = b.work.open.lights().back();
  CHECK(l.width == 2);
  CHECK(l.intensity.x * k_pi == Approx(40));
  CHECK(l.two_sided);
  CHECK_FALSE(l.visible);
  CHECK(std::abs(glm::dot(l.right, l.direction)) < 1e-6f);
  b.run("light.aim_at Panel at=0,0,0");
  l = b.work.open.lights().back();
  CHECK(std::abs(glm::dot(l.right, l.direction)) < 1e-6f);
  b.run("light.add tube radius=0.02 length=1.5 right=0,1,0");
  l = b.work.open.lights().back();
  CHECK(l.right == vec3(0, 1, 0));
  CHECK(std::abs(l.direction.y) < 1e-6f);
  b.run("light.add sphere radius=0.2"), b.run("light.add disk radius=0.1");
  REQUIRE(b.settled());
  for (int i = 0; i < 7; ++i) b.run("undo");
  CHECK(b.work.open.document() == before);
}

TEST_CASE("lights are named, grouped, aimed and moved") {
  WorkspaceBench b;
  b.open();
  b.run("light.rename 2 Kitchen");
  CHECK(b.work.open.light(1).name == "Kitchen");
  b.run("light.group Kitchen warm");
  CHECK(b.work.open.light(1).group == "warm");
  b.run("light.group Kitchen");
  CHECK(b.work.open.light(1).group.empty());
  b.run("light.move Kitchen to=1,1,1");
  b.run("light.move Kitchen by=0,0.5,0");
  CHECK(b.work.open.light(1).position == vec3(1, 1.5f, 1));
  b.run("light.move 3 to=0,3,0");
  b.run("light.aim_at 3 at=0,0,0");
  CHECK(b.work.open.light(2).direction == vec3(0, -1, 0));
}

TEST_CASE("the sun follows date and place, and a sky follows the sun") {
  WorkspaceBench b;
  b.open();
  b.run("sun.set Sun date=2024-06-21 time=10:00 zone=2 latitude=48.1 longitude=11.6 turbidity=3");
  const scene::Light sun = b.work.open.light(0);
  REQUIRE(sun.sun);
  CHECK(sun.direction == scene::sun_direction(*sun.sun));
  CHECK(luminance(sun.intensity) > 50e3);
  b.run("environment.sky preetham turbidity=4");
  REQUIRE(b.work.open.sky());
  CHECK(b.work.open.sky()->to_sun == -sun.direction);
  CHECK(b.work.open.sky()->turbidity == 4);
  b.run("sun.set Sun time=17:30");  // the rest stays
  CHECK(b.work.open.light(0).sun->hours == 17.5);
  CHECK(b.work.open.light(0).intensity == sun.intensity);
  CHECK(b.work.open.sky()->to_sun == -b.work.open.light(0).direction);
  REQUIRE(b.settled());
  CHECK(b.session.scene()->environment.sky == b.work.open.sky());
  b.run("undo");
  CHECK(b.work.open.sky()->to_sun == -sun.direction);
  b.run("light.set Sun azimuth=10");  // turned by hand: no date any more, and the sky follows
  CHECK_FALSE(b.work.open.light(0).sun);
  CHECK(b.work.open.sky()->to_sun == -b.work.open.light(0).direction);
  b.run("environment.own");
  CHECK_FALSE(b.work.open.sky());
  REQUIRE(b.settled());
  // Two steps of a drag are one, and the sky follows both.
  b.run("sun.set Sun date=2024-06-21 time=10 latitude=48 longitude=11");
  b.run("environment.sky cie_clear");
  b.run("sun.set Sun time=11", 5);
  b.run("sun.set Sun time=12", 5);
  CHECK(b.work.open.sky()->to_sun == -b.work.open.light(0).direction);
  b.run("undo");
  CHECK(b.work.open.light(0).sun->hours == 10);
}

TEST_CASE("a spot projects a picture by command; its cone then has a limit") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  const auto file =
      std::filesystem::temp_directory_path() / ("lucerna-slide-" + std::to_string(getpid()) + ".hdr");
  std::ofstream(file, std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
                                        << std::string("\x80\x40\x20\x81\x20\x40\x80\x81", 8);
  b.run("light.set 3 cone=30 direction=0,-1,0 picture=" + quote(file.string()));
  const scene::Light light = b.work.open.light(2);
  REQUIRE(light.picture);
  CHECK(light.picture->width == 2);
  CHECK(light.intensity == before.lights[2].intensity);
  b.run("light.set 3 roll=90");
  CHECK(std::abs(glm::dot(b.work.open.light(2).right, light.right)) < 1e-5f);
  b.run("light.set 3 lm=500");
  CHECK(scene::solid_angle(b.work.open.light(2)) * double(luminance(b.work.open.light(2).intensity)) ==
        Approx(500));
  CHECK_THAT(b.failure("light.set 3 cone=85"), Contains("cone: with a picture it has at most 80 degrees"));
  b.run("light.set 3 picture=none");
  CHECK_FALSE(b.work.open.light(2).picture);
  CHECK(b.work.history.script().back() == "light.set 3 picture=none");
  REQUIRE(b.settled());
  for (int i = 0; i < 4; ++i) b.run("undo");
  CHECK(b.work.open.document() == before);
  std::filesystem::remove(file);
}

TEST_CASE("invalid edits of lights are refused and change nothing") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  const auto refused = [&](const std::string& line, const std::string& why) {
    INFO(line);
    CHECK_THAT(b.failure(line), Contains(why));
  };
  refused("light.add lantern", "expected one of point, spot, sun, sphere");
  refused("light.add point name=Sun", "there is a light 'Sun' already");
  refused("light.add point name=\" \"", "name: it is empty");
  refused("light.add point name=" + std::string(65, 'x'), "65 bytes are too long; at most 64");
  refused("light.add point cone=20", "cone: a point lamp has no cone");
  refused("light.add sun position=0,0,0", "is infinitely far");
  refused("light.add sphere radius=0", "radius");
  refused("light.add point radius=1", "a point lamp has no radius");
  refused("light.add sphere two_sided=true", "a sphere lamp has no second side");
  refused("light.add rectangle direction=0,0,1 right=0,0,2", "right: it is 0 or along the light's direction");
  refused("light.add profile", "profile: its file is missing");
  refused("light.add profile profile=/nowhere.ies", "/nowhere.ies: cannot be read");
  refused("light.add point picture=/nowhere.png", "picture: a point lamp takes no picture: a spot does");
  refused("light.add spot picture=/nowhere.png", "/nowhere.png: cannot be read");
  refused("light.set 3 roll=20", "roll: a spot lamp looks the same when it is rolled");
  refused("light.add spot direction=0,0,0", "its length is 0");
  refused("light.add point intensity=-1", "intensity");
  refused("light.duplicate Sun by=1,0,0", "a sun is infinitely far");
  refused("light.duplicate nothing", "the scene has no light 'nothing'");
  refused("light.delete 9", "there is no light 9; the scene has 3");
  refused("light.rename 1 \"Brass lamp\"", "there is a light 'Brass lamp' already");
  refused("light.rename 1 \"\"", "name: it is empty");
  refused("light.aim_at 2", "a point lamp cannot be aimed at a point");
  refused("light.aim_at 3 at=0,2,0", "the light is there itself");
  refused("light.move 1 to=0,0,0", "a sun is infinitely far");
  refused("light.move 2 by=1,0,0 to=0,0,0", "exclude each other");
  refused("sun.set 2 date=2024-06-21", "is no sun");
  refused("sun.set Sun time=12", "give date, time, latitude and longitude");
  refused("sun.set Sun date=2024-06-31 time=12 latitude=1 longitude=1", "there is no date 2024-06-31");
  refused("sun.set Sun date=yesterday time=12 latitude=1 longitude=1", "'yesterday' is no date");
  refused("sun.set Sun date=2024-06-21 time=26 latitude=1 longitude=1", "'26' is no time");
  refused("sun.set Sun date=2024-06-21 time=12 latitude=91 longitude=1",
          "latitude = '91': expected a number from -90 to 90");
  refused("environment.sky preetham turbidity=1", "turbidity = '1': expected a number from 2 to 10");
  CHECK(b.work.open.document() == before);
  b.run("light.set Sun elevation=-20");
  refused("environment.sky preetham", "the sun is below the horizon");
}

}  // namespace commands_light_list_tests
