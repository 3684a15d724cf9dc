// links: commands
// What there is to save, and when: scene.save through the workspace.
#include <catch2/catch.hpp>

#include "base/file.h"
#include "unit/scene_support.h"
#include "unit/workspace_bench.h"

namespace commands_save_tests {

using namespace lucerna;
using namespace lucerna::commands;
using namespace lucerna::test;
using Catch::Contains;

TEST_CASE("there is something to save after edits, and not after undo") {
  WorkspaceBench b;
  b.open();
  const auto& file = b.work.scene_file;
  CHECK_FALSE(file.unsaved());
  b.run("camera.fov 40");
  b.run("set samples 7");
  b.run("select light 1");
  CHECK_FALSE(file.unsaved());
  b.run("light.set 1 intensity=4");
  CHECK(file.unsaved());
  b.run("undo");
  CHECK_FALSE(file.unsaved());
  b.run("redo");
  CHECK(file.unsaved());
  b.run("undo");
  for (const char* line : {"material.set 1 roughness=0.1", "film.ev 3", "environment.set scale=2",
                           "light.delete 2", "relight.mix \"x: mute\"", "environment.sky cie_overcast"}) {
    INFO(line);
    b.run(line);
    CHECK(file.unsaved());
    b.run("undo");
    CHECK_FALSE(file.unsaved());
  }
  b.run("light.add point");
  b.run("scene.open hall.gltf"), b.run("wait_scene");
  CHECK_FALSE(file.unsaved());
}

TEST_CASE("a failed save is reported, and leaves something to save") {
  WorkspaceBench b;
  b.open();
  TempFolder folder;
  CHECK_THAT(b.failure("scene.save " + (folder / "a.png").string()),
             Contains("expected a file name that ends in .gltf or .glb"));
  b.run("light.set 1 intensity=4");
  // The fake scene was not read from a file.
  const commands::Line line = b.work.run("scene.save " + quote((folder / "a.gltf").string()));
  std::string why;
  REQUIRE(b.until([&] {
    try {
      return line.command->done(line.arguments);
    } catch (const Error& error) {
      why = error.what();
      return true;
    }
  }));
  CHECK_THAT(why, Contains("nothing was written"));
  CHECK(b.errors == 1);
  CHECK(b.work.scene_file.unsaved());
}

}  // namespace commands_save_tests
