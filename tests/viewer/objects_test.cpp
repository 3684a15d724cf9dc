// links: ui film_io
// Objects by hand: arrows, rings and arms dragged with the mouse, numbers and buttons of the panel.
#include "inside.h"

#include <sstream>

namespace viewer_objects_tests {

using namespace lucerna;

namespace {

/// The lines of a saved session of these steps, after those of the view and the selection; with pictures of
/// the window, if LUCERNA_TEST_KEEP names a folder.
std::vector<std::string> session_of(const std::string& steps, const char* picture = nullptr) {
  const test::Folder folder;
  const std::string file = (folder.path / "session.lucerna").string();
  // In front of the objects, the middle of whose box is in the middle of the picture.
  std::string script =
      "wait_scene\nwindow.size 1440 900\nwait 0.5\ncamera.place 0,1.5,9 0,1.5,0 0,1,0\nselect object 4\n"
      "wait 0.5\n" +
      steps + "\nwait 0.3\n";
  const char* keep = std::getenv("LUCERNA_TEST_KEEP");
  if (keep && picture) script += fmt::format("screenshot {}/{}.png\n", keep, picture);
  const auto outcome = test::window(script + "script.save " + file + "\nquit 0\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  REQUIRE(lines.size() >= 6);
  lines.erase(lines.begin(), lines.begin() + 6);
  return lines;
}

constexpr int k_x = 712, k_y = 372;  // the middle of the picture

std::string drag(int x, int y, int dx, int dy, const std::string& between = "") {
  std::string steps = fmt::format("mouse.move {} {}\nmouse.down\n", x, y);
  for (int i = 1; i <= 4; ++i) steps += fmt::format("mouse.move {} {}\n", x + i * dx, y + i * dy) + between;
  return steps + "mouse.up\n";
}

vec3 vector_of(const std::string& line) {
  vec3 v(NAN);
  std::sscanf(line.substr(line.find('=') + 1).c_str(), "%f,%f,%f", &v.x, &v.y, &v.z);
  return v;
}

}  // namespace

TEST_CASE("arrows move the object along their axes, the middle along the picture, one step each") {
  if (test::no_display()) return;
  const auto lines = session_of(drag(k_x + 60, k_y, 20, 0) + "wait 0.4\nkey ctrl+z\nwait 0.4\n" +
                                    drag(k_x, k_y - 60, 5, -20) + "wait 0.4\nkey ctrl+z\nwait 0.4\n" +
                                    drag(k_x, k_y, 10, 10),
                                "move");
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  REQUIRE(lines.size() == 5);
  CHECK_THAT(lines[0], Catch::StartsWith("object.set 4 position="));
  const vec3 along = vector_of(lines[0]);
  CHECK(along.x > 0.4f);
  CHECK(along.y == 1.5f);
  CHECK(along.z == 0);
  CHECK(lines[1] == "undo");
  const vec3 up = vector_of(lines[2]);
  CHECK(up.x == 0);
  CHECK(up.y == Approx(1.5f + along.x).epsilon(0.05));
  const vec3 over = vector_of(lines[4]);
  CHECK(over.x == Approx(along.x / 2).epsilon(0.05));
  CHECK(over.y == Approx(1.5f - over.x).epsilon(0.05));
  CHECK(over.z == Approx(0).margin(1e-4));
}

TEST_CASE("a drag is followed where it rests, and stays one step; with Ctrl it goes in steps") {
  if (test::no_display()) return;
  const auto lines =
      session_of(drag(k_x + 60, k_y, 20, 0, "wait 0.5\n") + "wait 0.3\nkey ctrl+z\nwait 0.3\n" +
                 "key.hold ctrl on\n" + drag(k_x + 60, k_y, 21, 0) + "key.hold ctrl off\n");
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  REQUIRE(lines.size() == 3);
  CHECK(lines[1] == "undo");
  const float way = vector_of(lines[2]).x;
  CHECK(way > 0.4f);
  CHECK(way * 10 == Approx(std::round(way * 10)).margin(1e-3));
}

TEST_CASE("rings turn, arms size; Z shows the next handles") {
  if (test::no_display()) return;
  // The ring about z faces the camera: from its upper right by an eighth to its top.
  const auto turned = session_of("key z\nwait 0.3\n" + drag(k_x + 59, k_y - 59, -15, -6), "turn");
  INFO(fmt::format("{}", fmt::join(turned, "\n")));
  REQUIRE(turned.size() == 2);
  CHECK(turned[0] == "view.gizmo turn");
  CHECK_THAT(turned[1], Catch::StartsWith("object.set 4 rotation=0,0,"));
  CHECK(vector_of(turned[1]).z == Approx(45).margin(2));
  const auto sized = session_of("key z\nkey z\nwait 0.3\n" + drag(k_x, k_y - 90, 0, -12), "size");
  INFO(fmt::format("{}", fmt::join(sized, "\n")));
  REQUIRE(sized.size() == 3);
  CHECK(sized[1] == "view.gizmo size");
  CHECK_THAT(sized[2], Catch::StartsWith("object.set 4 scale=1,"));
  CHECK(vector_of(sized[2]).y == Approx(1 + 48.0f / 90).margin(0.05));
}

TEST_CASE("Escape ends a drag, and the rest of it moves nothing") {
  if (test::no_display()) return;
  const auto lines = session_of(fmt::format(
      "mouse.move {0} {1}\nmouse.down\nmouse.move {2} {1}\nmouse.move {3} {1}\nkey escape\nwait 0.2\n"
      "mouse.move {4} {1}\nmouse.move {5} {1}\nmouse.up\n",
      k_x + 60, k_y, k_x + 70, k_x + 90, k_x + 120, k_x + 160));
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  CHECK(lines.empty());
}

TEST_CASE("Escape after the scene has followed a drag leaves neither a step nor a line") {
  if (test::no_display()) return;
  const auto lines = session_of(
      fmt::format("mouse.move {0} {1}\nmouse.down\nmouse.move {2} {1}\nmouse.move {3} {1}\nwait 0.6\n"
                  "expect history.undo is 2\nkey escape\nwait 0.4\nmouse.move {4} {1}\nmouse.up\n"
                  "expect history.undo is 1\nexpect object 4 position is 0,1.5,0\n",
                  k_x + 60, k_y, k_x + 70, k_x + 90, k_x + 120));
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  CHECK(lines.empty());
}

TEST_CASE("with Ctrl and Shift an object lies on the surface under the pointer") {
  if (test::no_display()) return;
  const auto lines = session_of("key.hold ctrl on\nkey.hold shift on\n" + drag(k_x, k_y, 20, 10) +
                                    "key.hold ctrl off\nkey.hold shift off\nexpect history.undo is 2\n",
                                "surface");
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0], Catch::StartsWith("object.set 4 position="));
  // All objects are the same slanted triangle: the middle of its box is in its plane.
  const vec3 at = vector_of(lines[0]);
  CHECK(at.z < -0.5f);
  CHECK(at.y == Approx(1.5f + 0.375f * at.z).margin(2e-3));
}

TEST_CASE("a click beside the handles selects what is there; hidden objects have no handles") {
  if (test::no_display()) return;
  const auto clicked =
      session_of(fmt::format("mouse.move {0} {1}\nmouse.down\nmouse.up\nwait 0.3\n"
                             "mouse.move 400 150\nmouse.down\nmouse.up\n",
                             k_x + 60, k_y));
  INFO(fmt::format("{}", fmt::join(clicked, "\n")));
  REQUIRE(clicked.size() == 1);  // a click on an arrow is none
  CHECK(clicked[0] == "select.none");
  const auto hidden = session_of("object.hide 4\nwait 0.3\n" + drag(k_x + 60, k_y, 20, 0), "hidden");
  REQUIRE(hidden.size() == 2);
  CHECK_THAT(hidden[1], Catch::StartsWith("camera.place "));
}

}  // namespace viewer_objects_tests
