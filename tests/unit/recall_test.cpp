// links: ui
// What the window keeps between runs comes back: bookmarks by scene, and that the first steps were shown.
#include "viewer/fake_session.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "support/folder.h"
#include "ui/recall.h"

using namespace lucerna;

TEST_CASE("bookmarks and the first steps outlive the window; a damaged file is passed over") {
  const test::Folder folder;
  setenv("XDG_STATE_HOME", folder.path.c_str(), 1);
  const std::string line = "camera.place 1,2,3 0,0,0 0,1,0 fov=40";
  {
    session::Session session({});
    ui::Ui window(session);
    ui::recall(window);  // nothing there yet
    CHECK_FALSE(window.welcomed);
    CHECK(window.bookmarks.empty());
    window.welcomed = true;
    window.bookmarks["/a/hall.gltf"]["From the \"stage\""] = line;
    window.bookmarks["/a/empty.gltf"];
    ui::remember(window);
  }
  session::Session session({});
  ui::Ui window(session);
  ui::recall(window);
  CHECK(window.welcomed);
  CHECK(window.bookmarks.size() == 1);
  CHECK(window.bookmarks["/a/hall.gltf"]["From the \"stage\""] == line);
  const auto file = folder.path / "lucerna" / "window.json";
  REQUIRE(std::filesystem::exists(file));
  for (const char* text :
       {"", "[1]", "{\"bookmarks\": 3}", "{\"bookmarks\": {\"a\": {\"b\": 1}}}", "{\"welcomed\": \"yes\"}"}) {
    std::ofstream(file) << text;
    ui::Ui damaged(session);
    CHECK_NOTHROW(ui::recall(damaged));
  }
}
