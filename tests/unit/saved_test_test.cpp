// links: commands
// Sessions saved as tests: what the script contains, and which files it never replaces.
#include <catch2/catch.hpp>
#include <fstream>

#include "base/file.h"
#include "commands/saved_test.h"
#include "commands/script.h"
#include "support/folder.h"
#include "workspace_bench.h"

namespace saved_test_tests {

using namespace lucerna;
using namespace lucerna::commands;
using Catch::Contains;

TEST_CASE("a saved test repeats the edits, without files that it would write, and expects the picture") {
  test::WorkspaceBench b;
  const test::Folder folder;
  const std::string file = (folder.path / "lamp.lucerna").string();
  CHECK_THAT(b.failure("script.save_test " + file), Contains("no scene is open"));
  b.run(line("scene.open", (folder.path / "a b/hall.gltf").string()));
  b.run("wait_scene");
  b.run("light.set 2 intensity=3");
  b.run("film.ev 1");
  b.run("undo");
  b.run("wait_samples 4");
  b.run("image.save /tmp/never.exr");
  b.run("render.pause");
  REQUIRE(b.until([&] { return b.work.open.up_to_date(); }));
  b.run("script.save_test " + file);
  const std::vector<std::string> lines = read_script(file);
  REQUIRE(lines.size() == 9);
  CHECK(lines[0].starts_with("# A session of Lucerna as a test"));
  CHECK(lines[1] == "view.size 64 36");
  CHECK(lines[2] == "scene.open \"${here}/a b/hall.gltf\"");
  CHECK(lines[3] == "wait_scene");
  CHECK(lines[4] == "light.set 2 intensity=3");
  CHECK(lines[5] == "set film.ev 1");
  CHECK(lines[6] == "undo");
  CHECK_THAT(lines[7], Catch::StartsWith("wait samples ") && Catch::EndsWith(" within 3600"));
  CHECK(lines[8] == "expect image lamp.exr");
}

TEST_CASE("a saved test replaces no file of another kind") {
  test::WorkspaceBench b;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  b.open();
  CHECK_THAT(b.failure("script.save_test " + file("early.lucerna")), Contains("fewer than two samples"));
  b.run("wait_samples 4");
  std::ofstream(file("letter.lucerna")) << "dear";
  std::ofstream(file("photo.exr")) << "photo";
  CHECK_THAT(b.failure("script.save_test " + file("letter.lucerna")),
             Contains("exists and is no saved test"));
  CHECK_THAT(b.failure("script.save_test " + file("photo.lucerna")), Contains("photo.exr: exists"));
  CHECK_THAT(b.failure("script.save_test " + file("no/such/a.lucerna")), Contains("No such file"));
  CHECK(read_file(file("letter.lucerna")) == "dear");
  CHECK(read_file(file("photo.exr")) == "photo");
  CHECK_FALSE(file_exists(file("photo.lucerna")));
  b.run("script.save_test " + file("a.lucerna"));
  b.run("script.save_test " + file("a.lucerna"));  // its own kind
}

}  // namespace saved_test_tests
