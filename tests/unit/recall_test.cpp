// links: ui
// State that the window keeps between runs: bookmarks by scene, recent files, panels, and that the
// introduction was shown. Several windows share it.
#include <sys/stat.h>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "base/file.h"
#include "base/log.h"
#include "support/folder.h"
#include "ui/recall.h"

namespace recall_tests {

using namespace lucerna;

namespace {

const std::string k_line = "camera.place 1,2,3 0,0,0 0,1,0 fov=40";

/// The window's stored state, without a window.
struct Window {
  std::vector<std::string> recent;
  std::map<std::string, commands::Navigation::Bookmarks> bookmarks;
  std::map<std::string, std::string> swatches, folders;
  ui::Layout layout;
  std::map<std::string, bool> sections;
  bool welcomed = false;
  ui::Memory memory{{recent, bookmarks, swatches, folders, layout, sections, welcomed}};
};

struct StateFolder : test::Folder {
  StateFolder() { setenv("XDG_STATE_HOME", path.c_str(), 1); }
  std::filesystem::path file() const { return path / "lucerna" / "window.json"; }
};

}  // namespace

TEST_CASE("bookmarks and the state of the first steps survive a restart; a damaged file is ignored") {
  const StateFolder folder;
  {
    Window window;  // no file yet
    CHECK_FALSE(window.welcomed);
    CHECK(window.bookmarks.empty());
    window.welcomed = true;
    window.bookmarks["/a/hall.gltf"]["From the \"stage\""] = k_line;
    window.bookmarks["/a/empty.gltf"];
    window.bookmarks["/a/b\xFChne.gltf"]["\xE9"] = k_line;
    window.swatches["Old brass"] = "metallic=1";
    window.folders[".png"] = "/textures/";
  }
  {
    Window window;
    CHECK(window.welcomed);
    CHECK(window.bookmarks.size() == 2);
    CHECK(window.swatches["Old brass"] == "metallic=1");
    CHECK(window.folders[".png"] == "/textures/");
    CHECK(window.bookmarks["/a/hall.gltf"]["From the \"stage\""] == k_line);
  }
  REQUIRE(std::filesystem::exists(folder.file()));
  for (const char* text :
       {"", "[1]", "{\"bookmarks\": 3}", "{\"bookmarks\": {\"a\": {\"b\": 1}}}", "{\"welcomed\": \"yes\"}",
        "{\"recent\": {\"a\": 1}, \"sections\": [], \"left\": \"x\"}"}) {
    std::ofstream(folder.file()) << text;
    INFO(text);
    CHECK_NOTHROW([] {
      Window damaged;
      damaged.bookmarks["/a/hall.gltf"]["new"] = k_line;
    }());
    Window after;
    CHECK(after.bookmarks["/a/hall.gltf"]["new"] == k_line);
  }
}

TEST_CASE("two windows keep each other's bookmarks, files and panels") {
  const StateFolder folder;
  {
    Window before;
    before.bookmarks["/a"] = {{"old", k_line}, {"gone", k_line}};
    before.recent = {"/1", "/2", "/3"};
  }
  {
    Window first, second;
    first.bookmarks["/a"]["first"] = k_line;
    first.bookmarks["/a"].erase("gone");
    first.recent = {"/4", "/1", "/2", "/3"};
    first.layout.left = 300;
    first.sections["Camera"] = true;
    REQUIRE(first.memory.save());
    second.bookmarks["/a"]["second"] = k_line;
    second.bookmarks["/b"]["other"] = k_line;
    second.recent = {"/3", "/5", "/1", "/2"};
    second.layout.bottom = 200;
    second.sections["Render"] = false;
    REQUIRE(second.memory.save());
    // A window that saves merges the other's views; its own panels stay.
    CHECK(second.bookmarks["/a"].size() == 3);
    CHECK(second.recent == std::vector<std::string>{"/3", "/5", "/4", "/1", "/2"});
    CHECK(second.layout.left == ui::Layout().left);
  }
  Window after;
  using Views = commands::Navigation::Bookmarks;
  CHECK(after.bookmarks["/a"] == Views{{"first", k_line}, {"old", k_line}, {"second", k_line}});
  CHECK(after.bookmarks["/b"] == Views{{"other", k_line}});
  CHECK(after.recent == std::vector<std::string>{"/3", "/5", "/4", "/1", "/2"});
  CHECK(after.layout.left == 300);
  CHECK(after.layout.bottom == 200);
  CHECK(after.sections == std::map<std::string, bool>{{"Camera", true}, {"Render", false}});
}

TEST_CASE("bookmarks are saved immediately, panels once they stop moving, and nothing without a change") {
  const StateFolder folder;
  Window window;
  window.memory.follow(1);
  CHECK_FALSE(std::filesystem::exists(folder.file()));
  window.bookmarks["/a"]["x"] = k_line;
  window.memory.follow(2);
  CHECK_THAT(read_file(folder.file()), Catch::Contains("\"x\""));

  window.layout.left = 400;
  window.memory.follow(3);
  window.layout.left = 401;
  window.memory.follow(3.4);
  window.memory.follow(3.8);
  CHECK_THAT(read_file(folder.file()), !Catch::Contains("401"));
  window.memory.follow(4);
  CHECK_THAT(read_file(folder.file()), Catch::Contains("\"left\": 401"));

  const auto written = [&] {
    struct stat status {};
    REQUIRE(stat(folder.file().c_str(), &status) == 0);
    return status.st_ino;
  };
  const auto before = written();
  window.memory.follow(9);
  CHECK(written() == before);
}

TEST_CASE("a failed save is reported once") {
  const StateFolder folder;
  std::ofstream(folder.path / "lucerna") << "a file where the folder should be";
  int warnings = 0;
  const int token = log::add_listener([&](log::Level, const std::string& line) {
    warnings += line.find("bookmarks and swatches are not kept") != std::string::npos;
  });
  {
    Window window;
    for (const char* name : {"x", "y"}) {
      window.bookmarks["/a"][name] = k_line;
      window.memory.follow(1);
    }
  }
  log::remove_listener(token);
  CHECK(warnings == 1);
}

}  // namespace recall_tests
