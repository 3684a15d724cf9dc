// links: commands
// Commands that show the picture, or a file, in another viewer; and the display that they choose.
#include "support/folder.h"
#include "support/ocio.h"
#include "support/tev_receiver.h"
#include "workspace_bench.h"

namespace viewer_commands_tests {

using namespace lucerna;
using Catch::Contains;

TEST_CASE("tev.send needs a scene and a good address; tev.stop ends it") {
  test::WorkspaceBench b;
  CHECK_THAT(b.failure("tev.send"), Contains("no scene is open"));
  b.open();
  CHECK_THAT(b.failure("tev.send nowhere"), Contains("'nowhere': expected HOST:PORT"));
  b.run("tev.send :5");
  CHECK(b.until([&] { return b.work.open.snapshot->tev == "127.0.0.1::5"; }));
  b.run("tev.stop");
  CHECK(b.until([&] { return b.work.open.snapshot->tev.empty(); }));
  CHECK_FALSE(b.work.history.can_undo());
}

TEST_CASE("tev.open opens a file; a missing file or viewer is an error") {
  const test::Folder folder;
  test::WorkspaceBench b;
  const std::string file = (folder / "a.exr").string();
  CHECK_THAT(b.failure("tev.open " + file), Contains(file + ": there is no such file"));
  std::ofstream(file) << "x";
  CHECK_THAT(b.failure("tev.open " + file + " nowhere"), Contains("expected HOST:PORT"));
  test::TevReceiver viewer;
  b.run("tev.open " + file + " " + viewer.address());
  b.run("tev.open " + file + " " + viewer.address());
  CHECK(b.until([&] { return viewer.images()["reload " + file].updates == 1; }));
  CHECK(viewer.images()["open " + file].updates == 1);
  CHECK(b.errors == 0);
  b.run("tev.open " + file + " 127.0.0.1:1");
  CHECK(b.until([&] { return b.errors == 1; }));
}

TEST_CASE("view.ocio chooses a display and view of the configuration; a tone curve ends it in one step") {
  const test::Folder folder;
  const test::OcioVariable none("");
  test::WorkspaceBench b;
  CHECK_THAT(b.failure("view.ocio Other"), Contains("no scene is open"));
  b.open();
  CHECK_THAT(b.failure("view.ocio Other"), Contains("the environment variable OCIO names no configuration"));
  const test::OcioVariable variable(test::write_ocio(folder.path).string());
  CHECK_THAT(b.failure("view.ocio None"), Contains("there is no display 'None'"));
  CHECK_THAT(b.failure("view.ocio Other Film"), Contains("the display 'Other' has no view 'Film'"));
  b.run("view.ocio \"Screen: sRGB\" Film");
  const auto ocio = [&] { return b.work.open.setting("film.ocio"); };
  CHECK(ocio() == "Screen: sRGB: Film");
  b.run("view.ocio Other");
  CHECK(ocio() == "Other");
  b.run("undo");
  CHECK(ocio() == "Screen: sRGB: Film");
  b.run("set film.tone_curve agx");
  CHECK(ocio().empty());
  b.run("undo");
  CHECK(ocio() == "Screen: sRGB: Film");
  CHECK(b.work.open.setting("film.tone_curve") == "neutral");
  b.run("view.ocio off");
  CHECK(ocio().empty());
  CHECK(b.settled());
  using List = std::vector<std::string>;
  CHECK(b.work.registry.complete("view.ocio S") == List{"\"Screen: sRGB\""});
  CHECK(b.work.registry.complete("view.ocio Other P") == List{"Plain"});
}

}  // namespace viewer_commands_tests
