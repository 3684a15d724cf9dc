// links: commands
// The language of scripts: variables, loops, included files, and where mistakes are located.
#include "viewer/fake_session.h"

#include <catch2/catch.hpp>
#include <fstream>

#include "commands/script.h"
#include "commands/workspace.h"
#include "support/folder.h"

namespace script_tests {

using namespace lucerna;
using namespace lucerna::commands;
using Catch::Contains;

namespace {

struct Bench {
  session::FakeSession session;
  Workspace work{session};
  test::Folder folder;

  std::string file(const std::string& name, const std::string& text) {
    const auto path = folder.path / name;
    std::ofstream(path) << text;
    return path.string();
  }
  std::vector<std::string> lines(const std::string& text, const Variables& given = {}) {
    std::vector<std::string> result;
    for (const Step& step : steps(text, given)) result.push_back(step.line);
    return result;
  }
  std::vector<Step> steps(const std::string& text, const Variables& given = {}) {
    const std::string name = file("main.lucerna", text);
    return parse_script(work.registry, read_script(name), name, given);
  }
  /// The message, without the folder.
  std::string failure(const std::string& text, const Variables& given = {}) {
    try {
      steps(text, given);
    } catch (const Error& error) {
      std::string message = error.what();
      const std::string head = folder.path.string() + "/";
      for (size_t at; (at = message.find(head)) != std::string::npos;) message.erase(at, head.size());
      return message;
    }
    return "";
  }
};

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("variables are replaced, loops are repeated, and files are included") {
  Bench b;
  CHECK(b.lines("let ev 2\nfilm.ev ${ev}\n\n# ${unknown}\nfilm.ev 1 # ${unknown}\n") ==
        Lines{"film.ev 2", "film.ev 1 "});
  CHECK(b.lines("for ev in 1 2\nfor s in 8 16\nfilm.ev ${ev}\nsamples ${s}\nend\nend\n") ==
        Lines{"film.ev 1", "samples 8", "film.ev 1", "samples 16", "film.ev 2", "samples 8", "film.ev 2",
              "samples 16"});
  CHECK(b.lines("let name \"Brass \\\"lamp\\\"\"\nselect light \"${name}\"\n") ==
        Lines{"select light \"Brass \\\"lamp\\\"\""});
  // Outside of quotation marks a variable can be several words.
  CHECK(b.lines("let list \"1 2\"\nfor ev in ${list}\nfilm.ev ${ev}\nend\n").size() == 2);
  CHECK(b.lines("let text \"$${x}\"\nselect light ${text}\n") == Lines{"select light ${x}"});
  b.file("part.lucerna", "film.ev ${ev}\nlet ev 7\n");
  const std::vector<Step> steps = b.steps("let ev 3\ninclude part.lucerna\nfilm.ev ${ev}\n");
  REQUIRE(steps.size() == 2);
  CHECK((steps[0].line == "film.ev 3" && steps[1].line == "film.ev 7"));
  CHECK(steps[0].where == (b.folder.path / "part.lucerna").string() + ":1");
  CHECK(steps[0].folder == b.folder.path.string());
  CHECK(b.lines("scene.open ${here}/a.gltf\n") == Lines{"scene.open " + b.folder.path.string() + "/a.gltf"});
}

TEST_CASE("variables of the command line take precedence, and must be used") {
  Bench b;
  CHECK(b.lines("let ev 2\nfilm.ev ${ev}\n", {{"ev", "4"}}) == Lines{"film.ev 4"});
  CHECK(b.failure("film.ev 2\nlet exposure 1\n", {{"exposre", "4"}}) ==
        "main.lucerna: no line uses the variable 'exposre'; did you mean 'exposure'?");
  CHECK(parse_variable("a_1=b=c", "x") == std::pair<std::string, std::string>("a_1", "b=c"));
  for (const char* bad : {"=1", "A=1", "1a=2", "a", "here=1"})
    CHECK_THROWS_WITH(parse_variable(bad, "script"),
                      Contains("script: '") && Contains("expected NAME=VALUE"));
}

TEST_CASE("a mistake in a script is found before anything runs, and located") {
  Bench b;
  CHECK_THAT(b.failure("film.ev 1\nfilm.ev ${ex}\nlet e 1\n"),
             Catch::StartsWith("main.lucerna:2: column 9: there is no variable 'ex'"));
  CHECK(b.failure("film.ev ${ex") == "main.lucerna:1: column 9: '${' without '}'; $${ stands for it");
  CHECK(b.failure("film.ev 1\nend\n") == "main.lucerna:2: 'end' without 'for'");
  CHECK(b.failure("for a in 1\nfilm.ev 1\n") == "main.lucerna:1: for: its 'end' is missing");
  CHECK_THAT(b.failure("for a 1\nend\n"), Contains("main.lucerna:1: for: expected for NAME in A B C"));
  CHECK_THAT(b.failure("for a in\nend\n"), Contains("with at least one value"));
  CHECK_THAT(b.failure("for Big in 1\nend\n"), Contains("'Big': expected a name of lower-case letters"));
  CHECK_THAT(b.failure("for a in 1\nfor a in 2\nend\nend\n"),
             Contains("main.lucerna:2 (a = 1): for: 'a' is the variable"));
  CHECK_THAT(b.failure("for a in 1\nlet a 2\nend\n"), Contains("let: 'a' is the variable of a loop"));
  CHECK_THAT(b.failure("for a in 1\nfilm.ev 1\nend now\n"), Contains(":3: end: expected nothing behind it"));
  CHECK_THAT(b.failure("let a\n"), Contains("main.lucerna:1: let: expected let NAME VALUE"));
  CHECK_THAT(b.failure("let here x\n"), Contains("'here': expected a name"));
  CHECK_THAT(b.failure("for ev in 1 99\nfilm.ev ${ev}\nend\n"),
             Contains("main.lucerna:2 (ev = 99): set: film.ev"));
  CHECK_THAT(b.failure("include missing.lucerna\n"), Contains("main.lucerna:1: include: missing.lucerna: "));
  CHECK_THAT(b.failure("include main.lucerna\n"), Contains("a script cannot include itself"));
  b.file("b.lucerna", "include main.lucerna\n");
  CHECK_THAT(b.failure("include b.lucerna\n"),
             Contains("b.lucerna:1: include: main.lucerna is already being read"));
  const std::string ten = " 1 2 3 4 5 6 7 8 9 0";
  CHECK_THAT(b.failure("for a in" + ten + "\nfor b in" + ten + "\nfor c in" + ten + "\nfor d in" + ten +
                       "\nfor e in" + ten + "\nfilm.ev 1\nfilm.ev 2\nend\nend\nend\nend\nend\n"),
             Contains("the script has more than 100000 lines"));
}

TEST_CASE("the rest of a line is kept as written") {
  CHECK(text_after("expect  film.ev is \"a b\"  # why", 1) == "film.ev is \"a b\"");
  CHECK(text_after("fails \"a # b\" light.set 2 on=off", 2) == "light.set 2 on=off");
  CHECK(text_after("expect", 1).empty());
  CHECK(text_after("expect \"a \\\" b\" c", 2) == "c");
}

}  // namespace script_tests
