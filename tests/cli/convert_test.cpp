// links: base
// The verb convert: files that it writes and refuses, and their pictures.
#include <catch2/catch.hpp>
#include <filesystem>

#include "base/file.h"
#include "support/folder.h"
#include "support/run.h"

namespace convert_tests {

namespace fs = std::filesystem;
using namespace lucerna::test;
using Catch::Contains;

namespace {

const std::string k_scene = std::string(LUCERNA_SOURCE_DIR) + "/scenes/glass/glass.gltf";

std::string picture(const fs::path& scene, const fs::path& file) {
  const Run r = run("render " + scene.string() + " -o " + file.string() +
                    " --size 16x16 --samples 1 --quiet --allow-outside --set path.batch=4096");
  INFO(r.out);
  REQUIRE(r.status == 0);
  return lucerna::read_file(file);
}

}  // namespace

TEST_CASE("a converted scene renders bit-identically") {
  const Folder folder;
  const std::string expected = picture(k_scene, folder / "a.exr");
  for (const char* name : {"b.glb", "b.gltf"}) {
    const Run r = run("convert " + k_scene + " " + (folder / name).string());
    INFO(r.out);
    REQUIRE(r.status == 0);
    // The metadata of the file name the scene only.
    CHECK(picture(folder / name, folder / "b.exr").size() >= expected.size() / 2);
    const Run same =
        run("compare " + (folder / "a.exr").string() + " " + (folder / "b.exr").string() + " --max-relmse 0");
    INFO(same.out);
    CHECK(same.status == 0);
  }
}

TEST_CASE("convert refuses what it cannot write, with one line") {
  const Folder folder;
  const auto refused = [](const std::string& arguments, const std::string& why) {
    const Run r = run("convert " + arguments);
    CHECK(r.status == 1);
    CHECK_THAT(r.out, Contains(why));
  };
  const std::string copy = (folder / "a.glb").string();
  REQUIRE(run("convert " + k_scene + " " + copy).status == 0);
  refused(copy + " " + copy, "--replace writes over it");
  CHECK(run("convert " + copy + " " + copy + " --replace").status == 0);
  refused(copy + " " + (folder / "a.obj").string(), "a scene is saved as .gltf or .glb");
  refused(copy + " " + (folder / "gone/a.glb").string(), "gone");
  refused((folder / "missing.gltf").string() + " " + copy, "no such file");
  refused(copy + " \"\"", "expected a file name");
  refused(copy, "OUTPUT");
}

}  // namespace convert_tests
