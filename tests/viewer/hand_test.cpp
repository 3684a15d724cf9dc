// links: ui film_io
// Interaction by hand: lamps and materials edited in the panel, the camera moved by the mouse, the sky
// rotated, the exposure picked from a grey point, an image dropped. All of them are commands that a saved
// session contains.
#include "inside.h"

#include <sstream>

namespace hand_tests {

using namespace lucerna;

namespace {

/// The lines of a saved session of these steps, after the scene's lines.
std::vector<std::string> session_of(const std::string& steps) {
  const test::Folder folder;
  const std::string file = (folder.path / "session.lucerna").string();
  const auto outcome = test::window("wait_scene\nwindow.size 1440 900\nwait 0.5\n" + steps +
                                    "\nscript.save " + file + "\nquit 0\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  REQUIRE(lines.size() >= 4);
  lines.erase(lines.begin(), lines.begin() + 4);  // a comment, the scene, its wait, the size
  return lines;
}

/// A drag with a button from a point in steps of this size.
std::string drag(int x, int y, int dx, int dy, const char* button = "left") {
  std::string steps = fmt::format("mouse.move {} {}\nmouse.down {}\n", x, y, button);
  for (int i = 1; i <= 4; ++i) steps += fmt::format("mouse.move {} {}\n", x + i * dx, y + i * dy);
  return steps + fmt::format("mouse.up {}\n", button);
}

/// Three numbers of "name x,y,z ...": the n-th word.
vec3 vector_in(const std::string& line, int word) {
  std::istringstream stream(line);
  std::string text;
  for (int i = 0; i <= word; ++i) stream >> text;
  vec3 v(NAN);
  std::sscanf(text.c_str(), "%f,%f,%f", &v.x, &v.y, &v.z);
  return v;
}

constexpr const char* k_start = "camera.place 3,1.5,20 1,0.5,-1.5 0,1,0\n";

}  // namespace

TEST_CASE("the right button looks around, the left one orbits around the point under the pointer") {
  if (test::no_display()) return;
  const auto looked = session_of(k_start + drag(700, 300, 20, 5, "right"));
  REQUIRE(looked.size() == 2);
  CHECK(vector_in(looked[1], 1) == vec3(3, 1.5f, 20));
  CHECK(vector_in(looked[1], 2) != vec3(1, 0.5f, -1.5f));

  // The triangle's middle is in the centre of the picture: its distance does not change.
  const auto turned = session_of(k_start + std::string("wait 0.5\n") + drag(712, 372, 25, 6));
  REQUIRE(turned.size() == 2);
  const vec3 eye = vector_in(turned[1], 1), middle(1, 0.5f, -1.5f);
  CHECK(glm::length(eye - vec3(3, 1.5f, 20)) > 1);
  CHECK(glm::length(eye - middle) == Approx(glm::length(vec3(3, 1.5f, 20) - middle)).epsilon(0.05));
}

TEST_CASE("a drag with Ctrl rotates the sky, one step to undo") {
  if (test::no_display()) return;
  const auto lines = session_of("mouse.move 700 300\nkey.hold ctrl on\n" + drag(700, 300, 25, 0) +
                                "key.hold ctrl off\nkey ctrl+z\n");
  REQUIRE(lines.size() == 2);
  CHECK_THAT(lines[0], Catch::StartsWith("environment.set rotation=-"));
  CHECK(lines[1] == "undo");
}

TEST_CASE("a lamp's mark is dragged parallel to the picture, with Shift vertically, one step each") {
  if (test::no_display()) return;
  // The lamps are at 0,2,0: in the centre of the picture.
  const std::string view = "camera.place 0,2,6 0,2,0 0,1,0\nselect light 2\nwait 0.5\n";
  const auto lines = session_of(view + drag(712, 372, 20, -10) + "key.hold shift on\n" +
                                drag(792, 332, 15, -10) + "key.hold shift off\nkey ctrl+z\n");
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  REQUIRE(lines.size() == 5);
  CHECK_THAT(lines[2], Catch::StartsWith("light.set 2 position="));
  const vec3 along = vector_in(lines[2].substr(lines[2].find('=') + 1), 0),
             up = vector_in(lines[3].substr(lines[3].find('=') + 1), 0);
  CHECK(along.x > 0.2f);
  CHECK(along.y > 2.1f);
  CHECK(along.z == Approx(0).margin(1e-4));
  CHECK(up.x == Approx(along.x).margin(1e-4));
  CHECK(up.y > along.y + 0.1f);
  CHECK(lines[4] == "undo");
}

TEST_CASE("with Ctrl and Shift a lamp is put just before a surface; Escape ends a drag without a step") {
  if (test::no_display()) return;
  const auto lines = session_of(
      "camera.place 0,2,6 0,2,0 0,1,0\nselect light 2\nwait 0.5\nkey.hold ctrl on\n"
      "key.hold shift on\n" +
      drag(712, 372, 20, 10) +
      "key.hold ctrl off\nkey.hold shift off\nkey ctrl+z\nwait 0.3\n"
      "mouse.move 712 372\nmouse.down\nmouse.move 732 372\nmouse.move 752 372\nwait 0.2\n"
      "expect history.undo is 2\nkey escape\nwait 0.2\nmouse.move 792 372\nmouse.up\n"
      "expect history.undo is 1\nexpect light 2 position is 0,2,0\n");
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  REQUIRE(lines.size() == 4);
  CHECK_THAT(lines[2], Catch::StartsWith("light.set 2 position="));
  CHECK(lines[3] == "undo");
  // The plane of the triangle (-3,0,-4) (3,0,-4) (3,3,4), from the eye's side.
  const vec3 at = vector_in(lines[2].substr(lines[2].find('=') + 1), 0);
  const float off = (-48 * at.y + 18 * at.z + 72) / std::hypot(48.0f, 18.0f);
  CHECK(off > 1e-3f);
  CHECK(off < 0.2f);
  CHECK(at.x > 0.3f);
}

TEST_CASE("an emissive surface has a mark that selects its material and moves nothing") {
  if (test::no_display()) return;
  // The mark is in the centre of the picture.
  const std::string view =
      "camera.place 3,1.5,20 1,1,-1.333333 0,1,0\nmaterial.set 1 strength=2\nview.lamps true\nwait 0.5\n"
      "mouse.move 712 372\n";
  const auto clicked = session_of(view + "mouse.down\nmouse.up\n");
  INFO(fmt::format("{}", fmt::join(clicked, "\n")));
  REQUIRE(!clicked.empty());
  CHECK(clicked.back() == "select material 1");
  // A drag from there moves the camera, as everywhere.
  const auto dragged = session_of(view + drag(712, 372, 25, 6));
  REQUIRE(!dragged.empty());
  CHECK_THAT(dragged.back(), Catch::StartsWith("camera.place "));
}

TEST_CASE("a click on a grey point sets the exposure, and wheel turns are one step") {
  if (test::no_display()) return;
  const auto lines = session_of(
      "key b\nmouse.move 700 300\nmouse.down\nmouse.up\nwait 0.5\n"
      "mouse.wheel 1\nmouse.wheel 1\nmouse.wheel 1\nwait 1.2\nmouse.wheel -1\n");
  REQUIRE(lines.size() == 3);
  CHECK(lines[0] == "set film.ev 1");
  CHECK_THAT(lines[1], Catch::StartsWith("camera.place "));
  CHECK_THAT(lines[2], Catch::StartsWith("camera.place "));
}

TEST_CASE("H walks, W moves along the floor, Ctrl+B saves the view") {
  if (test::no_display()) return;
  // The fake scene's triangle is a ramp that rises towards +z; at (2, -3) its height is 0.375.
  const auto lines = session_of(
      "camera.place 2,1,-3 2,1,-2 0,1,0\nwait 0.5\nmouse.move 700 300\nkey h\n"
      "key.hold w on\nwait 0.4\nkey.hold w off\nwait 3\nkey ctrl+b\n");
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  // Walking ends some frames after the key is released, which take long on a busy machine.
  REQUIRE(lines.size() >= 4);
  CHECK(lines[1] == "camera.walking true");
  for (size_t i = 2; i + 1 < lines.size(); ++i) CHECK_THAT(lines[i], Catch::StartsWith("camera.place "));
  const vec3 eye = vector_in(lines[lines.size() - 2], 1);
  CHECK(eye.z > -2.95f);
  CHECK(eye.y == Approx(3 * (eye.z + 4) / 8 + 1.65f).margin(0.01));
  CHECK(eye.x == Approx(2).margin(1e-3));
  CHECK(lines.back() == "camera.bookmark");
}

TEST_CASE("a dropped image lights the scene; the first steps are shown on request") {
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  std::ofstream(file("sky.hdr")) << "x";
  const auto lines = session_of("drop " + file("sky.hdr") + "\nwait 0.3\nscreenshot " + file("before.png") +
                                "\nwindow.welcome\nwait 0.3\nscreenshot " + file("welcome.png") +
                                "\nkey escape\nwait 0.3\nscreenshot " + file("after.png"));
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == "environment.load " + file("sky.hdr"));
  const auto greys = [&](const char* name) {  // of the card
    return test::near_colour(test::Picture(file(name)), 480, 300, 940, 460, {38, 38, 38}, 0.02f);
  };
  CHECK(greys("welcome.png") > 40000);
  CHECK(greys("before.png") < 20000);
  CHECK(greys("after.png") < 20000);
}

TEST_CASE("a lamp's strength, temperature and position are dragged in the panel, each drag one step") {
  if (test::no_display()) return;
  const auto lines = session_of("window.section Camera false\nselect light 3\nwait 0.3\n" +
                                drag(1200, 366, 10, 0) + drag(1200, 444, 10, 0) + drag(1250, 470, 10, 0) +
                                drag(1240, 496, 10, 0) + "key ctrl+z\nkey ctrl+z\nkey ctrl+z\n");
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  REQUIRE(lines.size() == 9);
  CHECK_THAT(lines[2], Catch::StartsWith("light.set 3 cd="));
  CHECK_THAT(lines[3], Catch::StartsWith("light.set 3 kelvin="));
  CHECK_THAT(lines[4], Catch::StartsWith("light.set 3 position=") && Catch::EndsWith(",2,0"));
  CHECK_THAT(lines[5], Catch::StartsWith("light.set 3 azimuth="));
  for (size_t i = 6; i < 9; ++i) CHECK(lines[i] == "undo");
}

TEST_CASE("a colour is picked; emissive surfaces are listed among the lights") {
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto lines = session_of(
      "window.section Camera false\nselect light 3\nwait 0.3\nmouse.move 1200 418\nmouse.down\n"
      "mouse.up\nwait 0.4\n" +
      ("screenshot " + file("picker.png") + "\n") + drag(1230, 498, 8, 8) +
      "key escape\nwait 0.3\nmaterial.set 1 strength=2\nselect material 1\nwait 0.4\n"
      "screenshot " +
      file("surface.png"));
  if (const char* keep = std::getenv("LUCERNA_TEST_KEEP"))
    for (const char* name : {"picker.png", "surface.png"})
      std::filesystem::copy_file(file(name), std::string(keep) + "/" + name,
                                 std::filesystem::copy_options::overwrite_existing);
  INFO(fmt::format("{}", fmt::join(lines, "\n")));
  REQUIRE(lines.size() == 5);
  CHECK_THAT(lines[2], Catch::StartsWith("light.set 3 color="));
  CHECK(lines[4] == "select material 1");
}

TEST_CASE("Ctrl+R and a drag choose the region that gets all samples; the mark at its corner ends it") {
  if (test::no_display()) return;
  const std::vector<std::string> lines =
      session_of("key ctrl+r\nwait 0.2\n" + drag(500, 400, 40, 20) +
                 "wait 0.3\nmouse.move 650 390\nwait 0.2\nmouse.down left\n"
                 "mouse.up left\nwait 0.3\n" +
                 "key ctrl+r\nkey escape\n" + drag(500, 400, 4, 2));
  REQUIRE(lines.size() >= 2);
  REQUIRE(lines[0].starts_with("set sampling.region "));
  double left = 0, top = 0, width = 0, height = 0;
  REQUIRE(std::sscanf(lines[0].c_str(), "set sampling.region %lf,%lf,%lf,%lf", &left, &top, &width,
                      &height) == 4);
  CHECK(left > 0);
  CHECK(top > 0);
  CHECK(left + width < 1);
  // 160 by 80 pixels of a picture that is less than twice as wide as high.
  CHECK(width / height > 1.0);
  CHECK(width / height < 2.0);
  CHECK(lines[1] == "reset sampling.region");
  // After Esc, a drag moves the camera.
  CHECK(std::none_of(lines.begin() + 2, lines.end(),
                     [](const std::string& line) { return line.find("region") != std::string::npos; }));
}

}  // namespace hand_tests
