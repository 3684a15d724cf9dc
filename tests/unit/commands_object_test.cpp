// links: commands
// Objects by command: moved, turned, sized, dropped, hidden; undo, refusals, values, saved scripts.
#include <glm/gtc/matrix_transform.hpp>

#include "commands/object_drop.h"
#include "commands/refusal.h"
#include "unit/workspace_bench.h"

namespace commands_object_tests {

using namespace lucerna;
using namespace lucerna::commands;
using namespace lucerna::test;
using Catch::Contains;

namespace {

mat4 in_session(const WorkspaceBench& b, uint32_t object) {
  return b.session.scene()->instances[object].to_world;
}
std::string value(WorkspaceBench& b, const std::string& text) {
  std::vector<std::string> words{"object", "column 3", text};
  return b.work.values.read(b.work, b.work.values.take(words));
}

}  // namespace

TEST_CASE("objects are moved, turned and sized, each in one undo step") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  const mat4 loaded = in_session(b, 3);
  b.run("object.move \"column 3\" by=1,2,3");
  CHECK(b.work.open.object(3).moved == vec3(1, 2, 3));
  b.run("object.turn \"column 3\" by=0,90,0");
  b.run("object.turn \"column 3\" by=0,15,0");
  CHECK(b.work.open.object(3).turned == vec3(0, 105, 0));
  b.run("object.scale \"column 3\" factor=2");
  b.run("object.scale \"column 3\" by=1,-1,3");
  CHECK(b.work.open.object(3).scaled == vec3(2, -2, 6));
  REQUIRE(b.settled());
  CHECK(in_session(b, 3) == b.work.open.object_matrix(3));
  CHECK(in_session(b, 2) == loaded);
  CHECK(b.work.scene_file.unsaved());
  CHECK(b.work.history.undo_steps() == 5);
  for (int i = 0; i < 5; ++i) b.run("undo");
  CHECK(b.work.open.document() == before);
  REQUIRE(b.settled());
  CHECK(in_session(b, 3) == loaded);
  CHECK_FALSE(b.work.scene_file.unsaved());
  for (int i = 0; i < 5; ++i) b.run("redo");
  CHECK(b.work.open.object(3).scaled == vec3(2, -2, 6));
  b.run("object.reset 4");
  CHECK(b.work.open.document() == before);
  REQUIRE(b.settled());
}

TEST_CASE("steps of one drag are one step to undo and one line of the script") {
  WorkspaceBench b;
  b.open();
  for (const char* to : {"1,0,0", "2,0,0", "3,1,0"}) b.run(std::string("object.set 4 position=") + to, 7);
  CHECK(b.work.history.undo_steps() == 1);
  CHECK(b.work.history.script().back() == "object.set 4 position=3,1,0");
  // Ways of a drag count from where it began.
  b.run("object.move 4 by=1,0,0", 8), b.run("object.move 4 by=2,0,0", 8);
  CHECK(b.work.history.undo_steps() == 2);
  CHECK(value(b, "position") == "5,1,0");
  // Another object, or another property, is another step.
  b.run("object.set 5 position=0,0,0", 9), b.run("object.set 4 position=0,0,0", 9);
  b.run("object.set 4 scale=2,2,2", 9);
  CHECK(b.work.history.undo_steps() == 5);
}

TEST_CASE("objects are hidden and shown, one or all") {
  WorkspaceBench b;
  b.open();
  b.run("object.hide \"column 3\""), b.run("object.set 6 visible=false");
  REQUIRE(b.settled());
  CHECK(b.session.scene()->instances[3].hidden);
  CHECK(b.session.scene()->instances[5].hidden);
  CHECK(value(b, "visible") == "false");
  b.run("object.show 4");
  CHECK(value(b, "visible") == "true");
  CHECK(b.work.open.object(5).hidden);
  b.run("object.hide 4"), b.run("object.show");
  CHECK(b.work.open.document().objects.empty());
  b.run("undo");
  CHECK(b.work.open.object(3).hidden);
  CHECK(b.work.open.object(5).hidden);
  REQUIRE(b.settled());
}

TEST_CASE("what cannot be is refused and changes nothing") {
  WorkspaceBench b;
  CHECK_THAT(b.failure("object.move 1 by=1,0,0"), Contains("no scene is open"));
  b.open();
  const Document before = b.work.open.document();
  const auto refused = [&](const std::string& line, const std::string& why) {
    INFO(line);
    CHECK_THAT(b.failure(line), Contains(why));
  };
  refused("object.move colum by=1,0,0", "the scene has no object 'colum'");
  refused("object.move 99 by=1,0,0", "there is no object");
  refused("object.move 4", "expected by or to");
  refused("object.move 4 by=1,0,0 to=1,0,0", "not several");
  refused("object.scale 4 by=1,0,1", "object 'column 3': its scale");
  refused("object.scale 4 factor=0", "object 'column 3': its scale");
  refused("object.set 4 scale=1e30,1,1", "scale");
  refused("object.move 4 by=nan,0,0", "by");
  refused("object.move 4 by=1e12,0,0", "by");
  refused("object.move 4 to=1,inf,0", "to");
  for (int i = 0; i < 2; ++i) b.run("object.scale 4 factor=100");
  refused("object.scale 4 factor=100", "object 'column 3': its scale");
  b.run("undo"), b.run("undo");
  CHECK(b.work.open.document() == before);
  CHECK(b.work.history.undo_steps() == 0);
}

TEST_CASE("edits that the session refuses are taken back, later ones stay") {
  Objects list{{1, {.moved = {1, 0, 0}}}, {2, {.hidden = true}}, {3, {.scaled = vec3(2)}}};
  void (*revert)(Objects&, const Objects&, const Objects&) = [](Objects& d, const Objects& x,
                                                                const Objects& y) {
    Document document, from, to;
    document.objects = d, from.objects = x, to.objects = y;
    take_back(document, from, to);
    d = document.objects;
  };
  revert(list, {}, {{1, {.moved = {1, 0, 0}}}});
  CHECK(list == Objects{{2, {.hidden = true}}, {3, {.scaled = vec3(2)}}});
  revert(list, {{2, {.moved = {5, 0, 0}}}}, {{2, {.hidden = true}}});
  CHECK(list.at(2) == scene::ObjectPlace{.moved = {5, 0, 0}});
  revert(list, {}, {{3, {.scaled = vec3(3)}}});  // changed since
  CHECK(list.at(3).scaled == vec3(2));
  revert(list, {{4, {.hidden = true}}}, {});  // it was shown
  CHECK(list.at(4).hidden);
}

TEST_CASE("an object falls onto the surface below it, by its own lowest points") {
  auto scene = std::make_shared<scene::Scene>();
  scene->materials.emplace_back();
  const auto quad = [&](vec3 a, vec3 u, vec3 v) {
    scene::Primitive p;
    p.positions = {a, a + u, a + u + v, a + v};
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    return p;
  };
  scene->meshes.push_back({.name = "floor", .primitives = {quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0})}});
  scene->meshes.push_back({.name = "plate", .primitives = {quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})}});
  scene->meshes.push_back({.name = "peg", .primitives = {quad({-.2f, 1, -.2f}, {0, 0, .4f}, {.4f, 0, 0})}});
  scene->instances.push_back({.name = "floor", .mesh = 0});
  scene->instances.push_back(
      {.name = "plate", .mesh = 1, .to_world = glm::translate(mat4(1), vec3(0, 3, 0))});
  scene->instances.push_back(
      {.name = "peg", .mesh = 2, .to_world = glm::translate(mat4(1), vec3(0.5f, 0, 0.5f))});
  const session::Probe probe(scene);
  const auto way = [&](uint32_t object, const mat4& m) { return way_down(probe, object, m); };
  // On the peg, which is under none of its corners, by rays from the plate's middle.
  const auto down = way(1, scene->instances[1].to_world);
  REQUIRE(down);
  CHECK(*down == Approx(2).margin(1e-3));
  // Away from the peg, on the floor; where it is now, not where the probe's scene has it.
  CHECK(*way(1, glm::translate(mat4(1), vec3(3, 4, -3))) == Approx(4).margin(1e-3));
  CHECK(*way(1, glm::translate(mat4(1), vec3(3, 0, -3))) == Approx(0).margin(1e-3));
  CHECK_FALSE(way(1, glm::translate(mat4(1), vec3(3, -1, -3))));
  CHECK_FALSE(way(0, mat4(1)));
  CHECK_FALSE(way(9, mat4(1)));
}

}  // namespace commands_object_tests
