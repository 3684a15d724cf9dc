// links: base film_io
// 'lucerna script' and 'lucerna help': exit statuses, report, headless runs, and the example of
// scenes/README.md.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/file.h"
#include "film/io/image_file.h"
#include "support/folder.h"
#include "support/run.h"

namespace script_tests {

using namespace lucerna;
using Catch::Contains;

namespace {

std::string write(const test::Folder& folder, const std::string& name, const std::string& text) {
  const auto file = folder.path / name;
  std::ofstream(file) << text;
  return file.string();
}

const std::string k_start =
    "scene.open scenes/cornell/cornell.gltf\nview.size 32 32\nsamples 4\nwait scene within 60\n";

test::Run script(const std::string& arguments, const std::string& wrapper = "") {
  return test::run("script " + arguments + " --headless", wrapper);
}

}  // namespace

TEST_CASE("a script passes with 0, fails with 1, and with 2 if it cannot be read") {
  const test::Folder folder;
  const std::string report = " --report " + (folder.path / "report").string();
  const std::string good =
                        write(folder, "good.lucerna", k_start + "wait idle\nexpect picture.samples is 4\n"),
                    bad = write(folder, "bad.lucerna",
                                k_start + "film.ev ${ev}\nexpect film.ev is 1\nexpect film.ev < 9\n"),
                    stuck = write(folder, "stuck.lucerna",
                                  k_start + "wait until film.ev is 3 within 0.2\nfilm.ev 3\n");
  auto run = script(good);
  INFO(run.out);
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Contains("good.lucerna: 3 passed"));
  run = script(bad + " ev=1");
  INFO(run.out);
  CHECK(run.status == 0);
  run = script(good + " " + bad + " " + stuck + " ev=2" + report);
  INFO(run.out);
  CHECK(run.status == 2);  // 'ev' is no variable of the first one
  CHECK_THAT(run.out, Contains("good.lucerna: no line uses the variable 'ev'"));
  run = script(bad + " ev=2" + report);
  INFO(run.out);
  CHECK(run.status == 1);
  CHECK_THAT(run.out, Contains("bad.lucerna: 2 passed, 1 failed") &&
                          Contains("bad.lucerna:6: film.ev is 2, expected is 1") && Contains("report.html"));
  CHECK_THAT(read_file(folder.path / "report/junit.xml"),
             Contains("failures=\"1\"") && Contains("film.ev is 2, expected is 1"));
  run = script(stuck);
  INFO(run.out);
  CHECK(run.status == 1);
  CHECK_THAT(run.out, Contains("stuck.lucerna:5: wait: gave up after 0.2 s") && Contains("1 lines left out"));
}

TEST_CASE("what cannot be read is one located message") {
  const test::Folder folder;
  const auto refused = [&](const std::string& text, const std::string& message,
                           const std::string& more = "") {
    const auto run = script(write(folder, "s.lucerna", text) + more);
    INFO(run.out);
    CHECK(run.status == 2);
    CHECK_THAT(run.out, Contains(message));
    CHECK(std::count(run.out.begin(), run.out.end(), '\n') == 1);
  };
  refused("film.ev 1\nexpect film.ev == 1\n", "s.lucerna:2: expect: word 2 ('=='): expected one of is");
  refused("film.evv 1\n", "s.lucerna:1: unknown command 'film.evv'; did you mean 'film.ev'?");
  refused("include missing.lucerna\n", "s.lucerna:1: include: ");
  refused("wait 1\n", "s.lucerna: no line uses the variable 'x'", " x=1");
  refused("wait 1\n", "'X=1': expected NAME=VALUE", " X=1");
  refused("wait 1\n", "the variable 'x' is given twice", " x=1 x=2");
  refused("wait 1\n", "holds other files and no report", " --report " + folder.path.string());
  const auto missing = script((folder.path / "missing.lucerna").string());
  CHECK(missing.status == 2);
  CHECK_THAT(missing.out, Contains("missing.lucerna: "));
  // A window without display and without xvfb-run.
  const auto window = script(write(folder, "w.lucerna", "mouse.move 1 1\n"),
                             "env -u DISPLAY -u WAYLAND_DISPLAY PATH=/nowhere");
  INFO(window.out);
  CHECK(window.status == 2);
  CHECK_THAT(window.out, Contains("needs a window, and there is no display"));
}

TEST_CASE("without a window pictures have overlays, and references are accepted by the printed command") {
  const test::Folder folder;
  const std::string steps =
      "scene.open scenes/cornell/cornell.gltf\nview.size 48 48\nsamples 8\nwait scene within 60\n"
      "components.secondary cache\ncomponents.tertiary cache\noverlay.records true\n"
      "wait cache within 120\nwait idle within 120\n"
      "expect solver cache records > 10\nexpect picture records.png\n";
  const std::string file = write(folder, "records.lucerna", steps);
  const std::string all = file + " --report " + (folder.path / "report").string();
  auto run = script(all);
  INFO(run.out);
  CHECK(run.status == 1);
  const size_t at = run.out.find("accept the new picture: cp ");
  REQUIRE(at != std::string::npos);
  const size_t begin = run.out.find("cp ", at);
  REQUIRE(std::system(run.out.substr(begin, run.out.find('\n', begin) - begin).c_str()) == 0);
  CHECK(script(all).status == 0);
  // The overlay is in the picture.
  std::ofstream(file) << steps << "overlay.records false\nwait idle\nexpect picture records.png\n";
  run = script(all);
  INFO(run.out);
  CHECK(run.status == 1);
  CHECK_THAT(run.out, Contains("records.lucerna:14: differs in "));
  CHECK(std::filesystem::exists(folder.path / "report/1-difference.png"));
}

TEST_CASE("the example of a test of a scene passes, and fails on a changed lamp") {
  const test::Folder folder;
  for (const char* name : {"cornell.gltf", "cornell.bin", "settings.json", "light.lucerna", "light.exr"})
    std::filesystem::copy_file(std::string("scenes/cornell/") + name, folder.path / name);
  const std::string file = (folder.path / "light.lucerna").string();
  auto run = script(file);
  INFO(run.out);
  CHECK(run.status == 0);
  std::string scene = read_file(folder.path / "cornell.gltf");
  const std::string key = "\"emissiveStrength\":";
  const size_t at = scene.find(key);
  REQUIRE(at != std::string::npos);
  const double strength = std::stod(scene.substr(at + key.size()));
  const size_t end = scene.find_first_of(",}", at);
  scene.replace(at + key.size(), end - at - key.size(), std::to_string(1.03 * strength));
  std::ofstream(folder.path / "cornell.gltf") << scene;
  run = script(file + " --report " + (folder.path / "report").string());
  INFO(run.out);
  CHECK(run.status == 1);
  CHECK_THAT(run.out, Contains("differ beyond noise"));
}

TEST_CASE("a session saved as a test passes, and fails when the scene has changed") {
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  for (const char* name : {"cornell.gltf", "cornell.bin"})
    std::filesystem::copy_file(std::string("scenes/cornell/") + name, folder.path / name);
  const std::string session =
      write(folder, "session.lucerna",
            "scene.open ${here}/cornell.gltf\nview.size 48 48\nsamples 32\nwait scene within 60\n"
            "material.set red color=0.1,0.1,0.9\nwait idle within 120\n"
            "script.save_test ${here}/saved.lucerna\n");
  auto run = script(session);
  INFO(run.out);
  REQUIRE(run.status == 0);
  REQUIRE(std::filesystem::exists(file("saved.exr")));
  run = script(file("saved.lucerna"));
  INFO(run.out);
  CHECK(run.status == 0);
  // Another wall: the test has set the red one itself.
  std::string scene = read_file(file("cornell.gltf"));
  const size_t at = scene.find("0.3984");
  REQUIRE(at != std::string::npos);
  scene.replace(at, 6, "0.3000");
  std::ofstream(file("cornell.gltf")) << scene;
  run = script(file("saved.lucerna") + " --report " + file("report"));
  INFO(run.out);
  CHECK(run.status == 1);
  CHECK_THAT(run.out, Contains("differ beyond noise"));
}

TEST_CASE("help explains commands, settings and scripts without a device") {
  CHECK_THAT(test::run("help").out,
             Contains("light.set LIGHT") && Contains("window.fold") && Contains("expect WHAT"));
  CHECK_THAT(test::run("help expect").out, Contains("expect image FILE.exr") && Contains("expect text"));
  CHECK_THAT(test::run("help wait").out, Contains("until X"));
  CHECK_THAT(test::run("help film.ev").out, Contains("set film.ev VALUE"));
  CHECK_THAT(test::run("help values").out, Contains("picture.samples"));
  CHECK_THAT(test::run("help scripts").out, Contains("let NAME VALUE"));
  const auto unknown = test::run("help expct");
  CHECK(unknown.status == 1);
  CHECK_THAT(unknown.out, Contains("there is no command 'expct'; did you mean 'expect'?"));
}

}  // namespace script_tests
