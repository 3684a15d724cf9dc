// links: commands
// Scripts as tests: waits and their limits, expectations, results, and the report. Over a session without a
// renderer.
#include <catch2/catch.hpp>
#include <fstream>

#include "base/file.h"
#include "commands/script_runner.h"
#include "film/io/image_file.h"
#include "support/folder.h"
#include "support/ocio.h"
#include "workspace_bench.h"

namespace script_runner_tests {

using namespace lucerna;
using namespace lucerna::commands;
using Catch::Contains;
using Catch::EndsWith;
using Outcome = ScriptCase::Outcome;

namespace {

/// Runs scripts over a workspace.
struct Bench {
  test::Folder folder;
  session::FakeSession session;
  Workspace work{session};
  ReportFolder report{folder.path / "report"};
  std::optional<int> status;
  ScriptRunner runner{work, report, {.quit = [this](int s) { status = s; }}};
  Timer timer;
  std::mutex mutex;
  std::vector<std::pair<log::Level, std::string>> inbox;
  int token;

  Bench() {
    log::set_console_level(log::Level(99));
    session.set_size(64, 36);
    token = log::add_listener([this](log::Level level, const std::string& text) {
      std::lock_guard lock(mutex);
      inbox.emplace_back(level, text);
    });
  }
  ~Bench() { log::remove_listener(token); }

  ScriptResult run(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in("scene.open hall.gltf\nwait scene\n" + text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    const auto file = folder.path / "s.lucerna";
    std::ofstream(file) << text;
    runner.start(lines, file.string(), false);
    const Timer waited;
    while (!status && waited.seconds() < 30) {
      decltype(inbox) taken;
      {
        std::lock_guard lock(mutex);
        taken = std::exchange(inbox, {});
      }
      for (const auto& [level, line] : taken) work.note_log(level, line);
      work.refresh(timer.seconds());
      runner.advance();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    REQUIRE(status);
    return runner.result();
  }
};

/// The message of the only case that did not pass.
std::string failure(const std::string& script, Outcome outcome = Outcome::failed) {
  Bench b;
  const ScriptResult result = b.run(script);
  CHECK(b.status == 1);
  CHECK(result.count(outcome) == 1);
  for (const ScriptCase& c : result.cases)
    if (c.outcome != Outcome::passed) {
      CHECK(c.outcome == outcome);
      CHECK_THAT(c.where, Contains("s.lucerna:"));
      return c.message;
    }
  return "";
}

std::string mistake(const std::string& line) {
  Bench b;
  try {
    b.work.registry.parse(line, "s:1");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("expectations of values pass and fail, and the script goes on") {
  Bench b;
  const ScriptResult result = b.run(
      "film.ev 1.5\nexpect film.ev is 1.5\nexpect film.ev is 1 within 0.5\nexpect film.ev is not 2\n"
      "expect film.ev < 2\nexpect film.ev >= 1.5\nexpect scene.name is hall\nexpect scene.name contains al\n"
      "light.set 2 on=off\nexpect light \"Brass lamp\" on is off\nexpect light 2 on is false\n"
      "expect material Brass color is 0.91,0.72,0.35\nexpect history.undo is 2\n"
      "undo\nexpect history.undo is 1\nexpect history.redo is 1\nexpect light 2 on is on\n"
      "wait samples 4\nexpect picture.samples >= 4\nexpect picture.width is 64\nexpect component primary "
      "solver is path\n");
  INFO(summary(result));
  CHECK(b.status == 0);
  CHECK(result.passed());
  CHECK(result.cases.size() == 19);  // two of them waits
  CHECK(failure("film.ev 1\nexpect film.ev is 2\nexpect film.ev is 1\n") == "film.ev is 1, expected is 2");
  CHECK(failure("expect light 2 on is off\n") == "light 2 on is true, expected is off");
  CHECK_THAT(failure("expect light 9 on is off\n"), Contains("there is no light 9"));
  CHECK_THAT(failure("expect light 2 colour is off\n"),
             Contains("there is no part 'colour'; expected one of on"));
  CHECK_THAT(failure("expect scene.name > 2\n"), Contains("'hall' is no number"));
}

TEST_CASE("a wait ends, or fails after its limit with its place") {
  Bench b;
  CHECK(b.run("wait 0.01\nwait seconds 0.01\nwait samples 4\nwait until picture.samples >= 6 within 20\n"
              "samples 12\nwait idle\nexpect picture.finished is true\n")
            .passed());
  CHECK(failure("render.pause\nwait until film.ev is 3 within 0.1\n", Outcome::error) ==
        "wait: gave up after 0.1 s");
  CHECK_THAT(failure("render.pause\nwait samples 100000\n", Outcome::error), Contains("rendering is paused"));
  CHECK_THAT(failure("wait cache\n", Outcome::error),
             Contains("no component takes its light from the cache"));
  CHECK_THAT(failure("samples 8\nwait error 0.0001\n", Outcome::error),
             Contains("the picture is finished with an error of"));
  // What follows is not run.
  Bench c;
  const ScriptResult result = c.run("wait until film.ev is 3 within 0.05\nfilm.ev 3\nexpect film.ev is 3\n");
  CHECK(result.not_run == 2);
  CHECK(c.work.open.setting("film.ev") != "3");
}

TEST_CASE("errors of the log fail a script unless it states them, and refusals can be stated") {
  CHECK_THAT(failure("reference.load missing.exr\n", Outcome::error),
             Contains("that no 'expect log' states") && Contains("missing.exr"));
  // The report names the line that was running, though the file is read on a thread.
  const std::string no_picture = std::string(LUCERNA_SOURCE_DIR) + "/README.md";
  CHECK_THAT(failure("wait samples 2\ncompare.load " + no_picture + "\nwait samples 2\n", Outcome::error),
             Contains("README.md: cannot read this image") && EndsWith("s.lucerna:4)"));
  Bench b;
  CHECK(b.run("reference.load missing.exr\nexpect log missing.exr\nfails \"no light 9\" light.set 9 on=off\n")
            .passed());
  CHECK(b.status == 0);
  CHECK_THAT(failure("expect log nothing\n"),
             Contains("no error or warning contains 'nothing'; found hall.gltf: the extension"));
  CHECK_THAT(failure("fails \"no light\" light.set 2 on=off\n", Outcome::error), Contains("was not refused"));
  CHECK_THAT(failure("fails \"no lamp\" light.set 9 on=off\n", Outcome::error),
             Contains("expected a message that contains 'no lamp', found: light.set: there is no light 9"));
}

TEST_CASE("lines that cannot be read name the word") {
  CHECK(mistake("expect film.evv is 1") ==
        "s:1: expect: word 1: there is no value 'film.evv'; did you mean 'film.ev'?");
  CHECK(mistake("expect film.ev == 1") ==
        "s:1: expect: word 2 ('=='): expected one of is, <, <=, >, >=, contains");
  CHECK(mistake("expect film.ev < big") == "s:1: expect: word 3 ('big'): expected a number");
  CHECK(mistake("expect film.ev is") == "s:1: expect: word 3 is missing: expected the expected value");
  CHECK(mistake("expect film.ev is 1 or 2") == "s:1: expect: word 4 ('or'): expected the end of the line");
  CHECK(mistake("expect film.ev is 1 within -1") ==
        "s:1: expect: word 5 ('-1'): expected a tolerance of at least 0");
  CHECK_THAT(mistake("expect light 2"), Contains("light: PART is missing; expected light LIGHT PART"));
  CHECK_THAT(mistake("expect picture a.png within 2"),
             Contains("word 4 ('2'): expected a difference from 0 to 1"));
  CHECK_THAT(mistake("expect image a.exr layr caustic"), Contains("word 3 ('layr'): expected layer LAYER"));
  CHECK_THAT(mistake("expect"), Contains("what is missing"));
  CHECK_THAT(mistake("wait smaples 3"),
             Contains("word 1 ('smaples'): expected a number of seconds, or one of") &&
                 Contains("did you mean 'samples'?"));
  CHECK_THAT(mistake("wait samples"), Contains("word 2 is missing: expected a number of samples"));
  CHECK_THAT(mistake("wait samples 3 limit 5"), Contains("word 3 ('limit'): expected within SECONDS"));
  CHECK_THAT(mistake("wait samples 3 within soon"), Contains("word 4 ('soon'): expected seconds"));
  CHECK_THAT(mistake("wait until film.evv is 1"), Contains("there is no value 'film.evv'"));
  CHECK_THAT(mistake("get film.ev 2"), Contains("'2' is one word too many"));
}

TEST_CASE("a picture that differs leaves pictures, a page and the command to accept it") {
  const std::string steps = "samples 8\nwait idle\nexpect picture shown.png\n";
  Bench b;
  ScriptResult result = b.run(steps);
  REQUIRE(result.cases.back().outcome == Outcome::failed);
  CHECK_THAT(result.cases.back().message, Contains("shown.png"));
  REQUIRE(result.cases.back().pictures.size() == 1);
  b.report.write({result});
  const std::string accept = result.cases.back().pictures[0].accept;
  CHECK_THAT(read_file(b.folder.path / "report/junit.xml"),
             Contains("<testsuite name=") && Contains("failures=\"1\"") && Contains(accept));
  CHECK_THAT(read_file(b.folder.path / "report/report.html"),
             Contains("accept") && Contains("1-picture.png"));
  // The command makes the new picture the reference.
  REQUIRE(std::system(accept.c_str()) == 0);
  const auto reference = b.folder.path / "shown.png";
  Bench same;
  std::filesystem::copy_file(reference, same.folder.path / "shown.png");
  CHECK(same.run(steps).passed());
  Bench other;
  std::filesystem::copy_file(reference, other.folder.path / "shown.png");
  result = other.run("film.ev 1\n" + steps);
  CHECK_THAT(result.cases.back().message, Contains("differs in "));
  CHECK(file_exists(other.folder.path / "report/1-difference.png"));
  Bench sized;
  std::filesystem::copy_file(reference, sized.folder.path / "shown.png");
  sized.session.set_size(32, 36);
  CHECK_THAT(sized.run(steps).cases.back().message, Contains("is 64x36 pixels; the picture has 32x36"));
}

TEST_CASE("light is compared within its noise") {
  Bench b;
  const std::string steps = "samples 8\nwait idle\nexpect image light.exr\n";
  ScriptResult result = b.run(steps);
  REQUIRE(result.cases.back().outcome == Outcome::failed);
  REQUIRE(std::system(result.cases.back().pictures[0].accept.c_str()) == 0);
  Bench same;
  std::filesystem::copy_file(b.folder.path / "light.exr", same.folder.path / "light.exr");
  result = same.run(steps);
  INFO(summary(result));
  CHECK(result.passed());
  film::FilmImage image = film::read_exr(b.folder.path / "light.exr");
  for (auto& [name, plane] : image.channels)
    if (name == "G" || name == "odd.G")
      for (uint32_t i = 0; i < 256; ++i) plane[size_t{i / 16} * 64 + i % 16] *= 1.5f;
  Bench other;
  film::write_exr(other.folder.path / "light.exr", image);
  result = other.run(steps);
  CHECK_THAT(result.cases.back().message,
             Contains("1 of 12 tiles differ beyond noise") && Contains("at 0,0: G"));
}

TEST_CASE("light that differs is reported as the picture is shown, also by OpenColorIO") {
  const test::Folder f;
  const test::OcioVariable variable(test::write_ocio(f.path).string());
  const auto first_red = [](const std::string& ocio) {
    Bench b;
    const ScriptResult result =
        b.run("samples 8\nset film.ocio \"" + ocio + "\"\nwait idle\nexpect image light.exr\n");
    REQUIRE(result.cases.back().pictures.size() == 1);
    const film::FilmImage light = film::read_exr(b.folder.path / "report" / "1-now.exr");
    const film::FilmImage shown =
        film::read_exr(b.folder.path / "report" / result.cases.back().pictures[0].now);
    return std::pair((*light.find("R"))[0], (*shown.find("R"))[0]);
  };
  const auto [light, plain] = first_red("Other: Plain");
  CHECK(plain == Approx(std::pow(light, 1 / 2.2f)).margin(0.005));
  CHECK(first_red("Screen: sRGB: Film").second == Approx((std::log2(light) + 10) / 16).margin(0.01));
}

TEST_CASE("a report folder with other files is refused") {
  const test::Folder folder;
  std::ofstream(folder.path / "letter.txt") << "dear";
  CHECK_THROWS_WITH(ReportFolder(folder.path), Contains("holds other files and no report"));
  CHECK_THROWS_WITH(ReportFolder(folder.path / "letter.txt"), Contains("the report folder cannot be made"));
  CHECK(shell_word("a b'c") == "'a b'\\''c'");
}

}  // namespace script_runner_tests
