// links: ui film_io
// Guarantees of scripts: they end, wait for files that they save, report failure by exit status, and replace
// no file of another kind. Over a session without a renderer, and in the program itself.
#include <sys/stat.h>

#include <future>

#include "inside.h"
#include "ui/runner.h"
#include "ui/state.h"

namespace script_tests {

using namespace lucerna;

namespace {

std::string bytes(const std::string& file) { return read_file(file); }

}  // namespace

TEST_CASE("a script ends the program, with 1 after an error unless it sets a status") {
  if (test::no_display()) return;
  // Its end acts as quit.
  CHECK(test::window("wait_scene\n").status == 0);
  CHECK(test::window("wait_scene\nquit\n").status == 0);
  // An error that no step waited for is reported after the last step.
  const std::string broken = "wait_scene\nreference.load missing.exr\n";
  CHECK(test::window(broken).status != 0);
  CHECK(test::window(broken + "quit\n").status != 0);
  CHECK(test::window(broken + "quit 0\n").status == 0);
  CHECK(test::window("wait_scene\nscene.open missing.gltf\nwait_load\nquit\n").status != 0);
  // A cancelled load is no error.
  const auto given_up = test::window("wait_scene\nscene.open slow.gltf\nscene.cancel\nquit\n");
  INFO(given_up.output);
  CHECK(given_up.status == 0);
}

TEST_CASE("a script waits for its saves, and fails if one fails") {
  if (test::no_display()) return;
  const auto saved = test::window("wait_scene\nimage.save slow.exr\ncache.save slow.cache\n");
  INFO(saved.output);
  CHECK(saved.status == 0);
  CHECK_THAT(saved.output, Catch::Contains("saved slow.exr") && Catch::Contains("saved slow.cache"));
  for (const char* save : {"image.save missing/a.exr", "cache.save missing/a.cache"}) {
    const auto failed = test::window("wait_scene\n" + std::string(save) + "\nlog.clear\nquit 0\n");
    INFO(failed.output);
    CHECK(failed.status != 0);
    CHECK_THAT(failed.output, Catch::Contains("script:2: ") && Catch::Contains("nothing was written"));
  }
}

TEST_CASE("file names of other formats are refused before the script runs") {
  session::FakeSession session;
  ui::Ui window(session);
  commands::ReportFolder report;
  ui::Runner runner(window.viewport, window.areas, window.log, window.requests, report);
  for (const char* line : {"image.save a.jpg", "image.save .exr", "image.save a", "screenshot a.exr",
                           "script.save a.txt", "cache.save a.exr"})
    CHECK_THROWS_WITH(commands::parse_script(window.work.registry, {line}, "s"),
                      Catch::StartsWith("s:1: ") && Catch::Contains("expected a file name that ends in ."));
}

TEST_CASE("the busy card names the running command, not a finished one") {
  session::FakeSession session;
  ui::Ui window(session);
  session.busy_ms = 150, session.drawing_ms = 300;
  for (const char* line : {"film.ev 1", "window.fold left true", "image.save slow.exr"})
    window.work.run(line);
  const auto& busy = window.cards.busy;
  std::vector<std::string> texts;
  const auto begin = std::chrono::steady_clock::now();
  while (texts.empty() || busy.command != 0) {
    window.work.refresh(window.time());
    window.follow_busy();
    const std::string text = busy.command == 0 ? "" : busy.done ? "drawing" : busy.text;
    // A finished command is not shown.
    if (!busy.done && busy.command != 0) CHECK(session.commands_done() <= busy.command);
    if (!text.empty() && (texts.empty() || texts.back() != text)) texts.push_back(text);
    REQUIRE(std::chrono::steady_clock::now() - begin < std::chrono::seconds(20));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  session.busy_ms = 0, session.drawing_ms = 0;
  CHECK(texts == std::vector<std::string>{"film.ev 1", "image.save slow.exr", "drawing"});
}

TEST_CASE("a script that calls itself is refused") {
  if (test::no_display()) return;
  const test::Folder folder;
  const std::string a = (folder.path / "a.lucerna").string(), b = (folder.path / "b.lucerna").string();
  std::ofstream(a) << "wait_scene\nscript.run " << b << "\n";
  std::ofstream(b) << "script.run " << (folder.path / "." / "a.lucerna").string() << "\n";
  const auto outcome = test::window("script.run " + a + "\nquit 0\n");
  INFO(outcome.output);
  CHECK(outcome.status != 0);
  CHECK_THAT(outcome.output,
             Catch::Contains("b.lucerna:1: script.run: ") && Catch::Contains("a script cannot run itself"));
  // Two calls in sequence are no recursion.
  std::ofstream(b) << "wait_scene\n";
  CHECK(test::window("script.run " + a + "\nscript.run " + a + "\n").status == 0);
}

TEST_CASE("in the console a failing script stops, and the window stays") {
  if (test::no_display()) return;
  const test::Folder folder;
  const std::string a = (folder.path / "a.lucerna").string(), end = (folder.path / "end.png").string();
  std::ofstream(a) << "select light 99\nfilm.ev 3\n";
  const auto outcome = test::window("wait_scene\nkey ctrl+l\nwait 0.3\ntype \"script.run " + a +
                                    "\"\nkey enter\nwait 3\nscreenshot " + end + "\nquit 0\n");
  INFO(outcome.output);
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.output, Catch::Contains("there is no light 99"));
  CHECK(std::filesystem::exists(end));
}

TEST_CASE("screenshots and saved sessions replace only files of their kind") {
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  std::ofstream(file("letter.png")) << "dear";
  film::write_png(file("holiday.png"), 1, 1, std::vector<uint8_t>(4, 255));
  std::ofstream(file("letter.lucerna")) << "dear";
  const std::string holiday = bytes(file("holiday.png"));
  for (const char* name : {"letter.png", "holiday.png", "letter.lucerna"}) {
    const bool script = std::string(name).ends_with(".lucerna");
    const auto refused = test::window((script ? "script.save " : "screenshot ") + file(name) + "\nquit 0\n");
    INFO(refused.output);
    CHECK(refused.status != 0);
    CHECK_THAT(refused.output, Catch::Contains("exists and is no "));
  }
  CHECK(bytes(file("letter.png")) == "dear");
  CHECK(bytes(file("holiday.png")) == holiday);
  CHECK(bytes(file("letter.lucerna")) == "dear");
  std::ofstream(file("theirs.tmp")) << "dear";
  const std::string both = "screenshot " + file("a.png") + "\nscript.save " + file("theirs") + ".lucerna\n";
  const auto twice = test::window("wait_scene\n" + both + "select light 2\n" + both);
  INFO(twice.output);
  CHECK(twice.status == 0);
  CHECK_THAT(bytes(file("theirs.lucerna")), Catch::EndsWith("select light 2\n"));
  CHECK(bytes(file("theirs.tmp")) == "dear");
  // A pipe is written into.
  REQUIRE(mkfifo(file("pipe.lucerna").c_str(), 0600) == 0);
  auto read = std::async(std::launch::async, [&] { return test::run("cat " + file("pipe.lucerna")); });
  CHECK(test::window("wait_scene\nselect light 2\nscript.save " + file("pipe.lucerna") + "\n").status == 0);
  CHECK_THAT(read.get().output, Catch::EndsWith("select light 2\n"));
}

TEST_CASE("in the program a picture saved by a script is complete, however soon the script ends") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const std::string start = "view.size 64 48\nwait_scene\n";
  for (const char* end : {"", "quit\n"}) {
    std::filesystem::remove(file("a.exr"));
    const auto outcome =
        test::program("scenes/cornell/cornell.gltf",
                      start + "image.save " + file("a.exr") + "\nimage.save " + file("a.png") + "\n" + end);
    INFO(outcome.output);
    CHECK(outcome.status == 0);
    REQUIRE(std::filesystem::exists(file("a.exr")));
    CHECK(std::filesystem::exists(file("a.png")));
    const film::FilmImage image = film::read_exr(file("a.exr"));
    const std::vector<float>& samples = *image.find("samples");
    CHECK(*std::min_element(samples.begin(), samples.end()) >= 1);
  }
  const auto failed = test::program("scenes/cornell/cornell.gltf",
                                    start + "image.save " + file("no") + "/such/a.exr\nquit 0\n");
  INFO(failed.output);
  CHECK(failed.status == 1);
  CHECK_THAT(failed.output, Catch::Contains("the folder '") && Catch::Contains("nothing was written"));

  // The script of a session that saved a picture saves the same one: it waits for the number of samples.
  const std::string session = file("session.lucerna"), again = file("again.lucerna");
  const auto first = test::program("scenes/cornell/cornell.gltf",
                                   start + "samples 40\nwait_samples 40\nimage.save " + file("b.exr") +
                                       "\nimage.save " + file("no.exr") + "\nscript.save " + session + "\n");
  INFO(first.output);
  REQUIRE(first.status == 0);
  const film::FilmImage before = film::read_exr(file("b.exr"));
  std::filesystem::remove(file("b.exr"));
  const auto second = test::program("", "script.run " + session + "\nscript.save " + again + "\n");
  INFO(second.output);
  REQUIRE(second.status == 0);
  const film::FilmImage after = film::read_exr(file("b.exr"));
  CHECK(after.metadata.at("settings") == before.metadata.at("settings"));
  for (size_t i = 0; i < before.channels.size(); ++i) {
    INFO(before.channels[i].first);
    CHECK((after.channels[i].second == before.channels[i].second));
  }
  CHECK(bytes(again) == bytes(session));
}

TEST_CASE("in the program a saved picture shows the camera and the size of earlier commands") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto outcome = test::program("scenes/cornell/cornell.gltf",
                                     "wait_scene\nview.size 64 48\nsamples 4\nimage.save " + file("a.exr") +
                                         "\ncamera.orbit 0.5 0\nimage.save " + file("b.exr") +
                                         "\nview.size 48 32\nimage.save " + file("c.exr") +
                                         "\nundo\nview.size 0 0\nimage.save " + file("d.exr") +
                                         "\nview.divisor 4\nimage.save " + file("e.exr") + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const auto image = [&](const char* name) { return film::read_exr(file(name)); };
  const auto a = image("a.exr"), b = image("b.exr"), c = image("c.exr"), d = image("d.exr"),
             e = image("e.exr");
  CHECK(a.metadata.at("view") != b.metadata.at("view"));
  CHECK(b.metadata.at("view") == c.metadata.at("view"));
  CHECK(d.metadata.at("view") == a.metadata.at("view"));
  CHECK((b.width == 64 && c.width == 48 && c.height == 32));
  CHECK(d.width > 64);
  CHECK(e.width == d.width / 4);
}

TEST_CASE("the what-if target stays when the sampling mode changes, in one step to undo") {
  session::FakeSession session;
  ui::Ui window(session);
  const auto target = [&] { return window.open.setting_real("sampling.target_error"); };
  const auto act = [&](const std::string& line) { window.work.run(line); };
  act("accuracy.what_if 0.023");
  act("set sampling.mode adaptive");
  CHECK(target() == Approx(0.023));
  CHECK(window.accuracy.target() == Approx(0.023));
  act("undo");
  CHECK(window.open.setting("sampling.mode") == "uniform");
  CHECK(target() == Approx(0.05));
  // A target that is set directly is not overridden, neither before nor after.
  act("accuracy.what_if 0.03");
  act("set sampling.target_error 0.2");
  act("set sampling.mode adaptive");
  CHECK(target() == Approx(0.2));
  // Back to uniform: the line stays.
  act("set sampling.mode uniform");
  CHECK(window.accuracy.target() == Approx(0.2));
}

}  // namespace script_tests
