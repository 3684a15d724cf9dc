// links: film_io
// The program in normal use: a window, a scene, a few samples, a screenshot, the end.
#include "support.h"

namespace viewer_tests {

using namespace lucerna;

TEST_CASE("the viewer starts, renders cornell, saves a screenshot and quits") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto png = folder.path / "window.png";
  const auto outcome = test::program(
      "scenes/cornell/cornell.gltf",
      "window.size 1100 700\nwait_scene\nwait_samples 1\ncamera.orbit 0.05 0\nwait_samples 1\nscreenshot " +
          png.string() + "\nquit 0\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const test::Picture window(png);
  CHECK(window.image.width == 1100);
  CHECK(window.image.height == 700);
  CHECK(window.contrast(300, 80, 780, 480) > 0.05);  // the lit box
  CHECK(window.contrast(10, 40, 270, 400) > 0.02);   // the panel
  // Cornell's left wall is red and its right wall green: the picture is not mirrored.
  double red = 0, green = 0;
  for (uint32_t y = 260; y < 480; ++y)
    for (uint32_t x = 0; x < 796; ++x) {
      const vec3 c = window.at(280 + x, y);
      if (c.x > 2 * c.y && c.x > 0.05f) red += x < 398 ? 1 : -1;
      if (c.y > 1.3f * c.x && c.y > 0.05f) green += x >= 398 ? 1 : -1;
    }
  CHECK(red > 500);
  CHECK(green > 500);
}

TEST_CASE("SIGTERM closes the window like its close button, and the window's state is saved") {
  if (test::no_program()) return;
  const test::Folder folder;
  const std::string kept = (folder.path / "lucerna/window.json").string();
  // The state of the first steps is saved as soon as they are shown: then the window is open.
  std::ofstream(folder.path / "steps.sh")
      << "XDG_STATE_HOME=" << folder.path.string() << ' ' << LUCERNA_BINARY << " &\n"
      << "until test -s " << kept << "; do sleep 0.1; done\nkill -TERM $!\nwait $!\n";
  const test::Outcome ended = test::run(test::with_display("sh " + (folder.path / "steps.sh").string()));
  INFO(ended.output);
  CHECK(ended.status == 143);
  CHECK_THAT(read_file(kept), Catch::Contains("\"welcomed\": true"));
}

TEST_CASE("a missing scene is an error in the window, and the script fails with its exit status") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto png = folder.path / "window.png";
  const auto shown =
      test::program("no/such/scene.gltf", "wait_load\nscreenshot " + png.string() + "\nquit 0\n");
  INFO(shown.output);
  REQUIRE(shown.status == 0);
  CHECK_THAT(shown.output, Catch::Contains("no/such/scene.gltf"));
  const test::Picture window(png);
  const vec3 strip = window.at(1084, 72);
  CHECK(strip.x > 1.5f * strip.y);

  const auto failed = test::program("no/such/scene.gltf", "wait_scene\nquit\n");
  INFO(failed.output);
  CHECK(failed.status == 1);
  const auto mistyped = test::program("scenes/cornell/cornell.gltf --set film.evv=2", "quit\n");
  CHECK(mistyped.status == 1);
  CHECK_THAT(mistyped.output,
             Catch::Contains("--set: set: there is no setting 'film.evv'; did you mean 'film.ev'?"));
}

TEST_CASE("a damaged file that is dropped keeps the scene, and a click selects the object under it") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto broken = folder.path / "broken.glb", png = folder.path / "window.png";
  const auto session = folder.path / "session.lucerna";
  std::ofstream(broken, std::ios::binary) << "glTF\2 and then nothing that it says";
  const auto outcome =
      test::program("scenes/cornell/cornell.gltf",
                    "window.size 1100 700\nwait_scene\nwait_samples 1\ndrop " + broken.string() +
                        "\nwait_load\nwait_samples 1\npick 0.5 0.145\nscreenshot " + png.string() +
                        "\nscript.save " + session.string() + "\nquit 0\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.output, Catch::Contains("broken.glb"));
  const test::Picture window(png);
  const vec3 strip = window.at(790, 72);
  CHECK(strip.x > 1.5f * strip.y);
  CHECK(window.contrast(300, 120, 780, 480) > 0.05);                     // the box is still there
  CHECK_THAT(read_file(session), Catch::EndsWith("select object 4\n"));  // the lamp
}

TEST_CASE("a reference is loaded for a picture of its size, and refused with both sizes for another") {
  if (test::no_program()) return;
  const test::Folder folder;
  const std::string exr = (folder.path / "ref.exr").string(), png = (folder.path / "window.png").string();
  const auto outcome = test::program(
      "scenes/cornell/cornell.gltf",
      "window.size 1100 700\nwait_scene\nreference.load " + exr +
          "\nwait 0.5\nview.size 96 64\nwait 0.5\nsamples 8\nwait_samples 8\nimage.save " + exr +
          "\nsamples 64\nreference.load " + exr + "\nwait_samples 64\nwait 0.7\nscreenshot " + png +
          "\nview.size 80 64\nwait 0.5\nwait_samples 2\nreference.load " + exr +
          "\nwait 0.5\nreference.clear\nwait 0.2\nquit 0\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.output, Catch::Contains("rendered with seed 0 like this picture"));
  CHECK_THAT(outcome.output, Catch::Contains("the reference is 96x64 pixels, the picture 80x64"));
  CHECK(test::Picture(png).contrast(60, 540, 420, 680) > 0.03);  // the lines
}

TEST_CASE("a PNG is saved as shown or unfiltered, by option; an EXR always unfiltered") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  // Without panels the picture fills the window.
  const auto outcome = test::program(
      "scenes/cornell/cornell.gltf",
      "window.size 640 420\nwindow.panels false\nwait_scene\nwait 0.5\nwait_samples 4\nrender.pause\n"
      "wait 0.5\nscreenshot " +
          file("window.png") + "\nimage.save " + file("shown.png") + " as=shown\nimage.save " +
          file("plain.png") + "\nimage.save " + file("named.png") + " as=unfiltered\nquit 0\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const test::Picture window(file("window.png")), shown(file("shown.png")), plain(file("plain.png")),
      named(file("named.png"));
  REQUIRE(shown.image.width == 640);
  REQUIRE(shown.image.height == 420);
  int off = 0, other = 0, differs = 0;
  for (uint32_t y = 0; y < 300; ++y)
    for (uint32_t x = 0; x < 640; ++x) {
      off += glm::length(shown.at(x, y) - window.at(x, y)) > 0.5f / 255;
      other += glm::length(shown.at(x, y) - plain.at(x, y)) > 3.0f / 255;
      differs += plain.at(x, y) != named.at(x, y);
    }
  CHECK(off == 0);
  CHECK(other > 20000);
  CHECK(differs == 0);

  const auto refused = test::program("scenes/cornell/cornell.gltf",
                                     "wait_scene\nimage.save " + file("a.exr") + " as=shown\nquit 0\n");
  CHECK(refused.status == 1);
  CHECK_THAT(refused.output, Catch::Contains("as: only a PNG is saved as shown"));
}

}  // namespace viewer_tests
