// links: commands
// Lines of text as commands: words, types, messages, completion.
#include "viewer/fake_session.h"
#include "viewer/round_trip.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "commands/workspace.h"

namespace commands_registry_tests {

using namespace lucerna;
using namespace lucerna::commands;
using Catch::Contains;

namespace {

std::string failure(const Registry& registry, const std::string& line, const std::string& where = "") {
  try {
    registry.parse(line, where);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// One command with a parameter of each type.
Registry one_of_each() {
  Registry r;
  r.add({.name = "thing.set",
         .help = "Sets a thing.",
         .parameters = {{.name = "thing", .which = true},
                        {.name = "on", .type = Type::boolean, .optional = true},
                        {.name = "count", .type = Type::integer, .lo = 1, .hi = 9, .optional = true},
                        {.name = "size", .type = Type::real, .lo = 0, .unit = "m", .optional = true},
                        {.name = "at", .type = Type::vector, .lo = -1, .hi = 1, .optional = true},
                        {.name = "mode", .type = Type::choice, .choices = {"fast", "good"}, .optional = true},
                        {.name = "out", .type = Type::file, .choices = {".png"}, .optional = true}},
         .run = [](const Arguments&) {}});
  return r;
}

}  // namespace

TEST_CASE("words are split and quoted so that they round-trip") {
  const auto texts = [](std::string_view line) {
    std::vector<std::string> list;
    for (const Word& w : split(line)) list.push_back(w.text);
    return list;
  };
  CHECK(texts("  a\tb  # rest") == std::vector<std::string>{"a", "b"});
  CHECK(texts("a#b \"c d\" e=\"f g\"h") == std::vector<std::string>{"a#b", "c d", "e=f gh"});
  CHECK(texts("").empty());
  CHECK(texts("\"\"") == std::vector<std::string>{""});
  for (const char* text : {"", " ", "plain", "a b", "\"", "\\", "a\\\"b", "#x", "k=v", "\xC3\xA9t\xC3\xA9"})
    CHECK(texts("x " + quote(text) + " y") == std::vector<std::string>{"x", text, "y"});
  CHECK_THROWS_WITH(split("a \"b", "here"), "here: a quotation mark is not closed");
  CHECK(last_word("") == 0);
  CHECK(last_word("ab") == 0);
  CHECK(last_word("ab cd") == 3);
  CHECK(last_word("ab ") == 3);
  CHECK(last_word("ab \"c d") == 3);
}

TEST_CASE("numbers are written in shortest form and read in full") {
  for (const float v : {0.1f, -1e-7f, 16777216.0f, 3.14159274f, 1e30f}) {
    double back = 0;
    REQUIRE(read_number(number_text(v), back));
    CHECK(static_cast<float>(back) == v);
  }
  CHECK(number_text(0.1f) == "0.1");
  CHECK(number_text(-0.0) == "0");
  double number = 0;
  for (const char* bad : {"", "x", "1x", " 1", "nan", "inf", "1e999", "0x10", "--1", "+-1"})
    CHECK_FALSE(read_number(bad, number));
  CHECK(read_number("+2", number));
  vec3 v{0};
  for (const char* bad : {"", "1", "1,2", "1,2,3,4", "1,,3", "1,2,nan", "1, 2,3", "1,2,1e39"})
    CHECK_FALSE(read_vector(bad, v));
  REQUIRE(read_vector("1,-0.5,2e3", v));
  CHECK(v == vec3(1, -0.5f, 2000));
}

TEST_CASE("a mistyped word gets the nearest suggestion, or none if nothing is near") {
  const std::vector<std::string> known{"camera.orbit", "camera.pan", "film.ev", "render.restart", "quit"};
  CHECK(nearest("camera.orbti", known) == "camera.orbit");
  CHECK(nearest("Camera.Pan", known) == "camera.pan");
  CHECK(nearest("orbit", known) == "camera.orbit");
  CHECK(nearest("restrat", known) == "render.restart");
  CHECK(nearest("film.evv", known) == "film.ev");
  CHECK(nearest("qiut", known) == "quit");
  CHECK(nearest("zzzzzz", known).empty());
  CHECK(nearest("", known).empty());
}

TEST_CASE("invalid input of each type is refused with the expected form") {
  const Registry r = one_of_each();
  const auto fails = [&](const std::string& line) { return failure(r, line, "script: line 2"); };
  CHECK(fails("thing.set a on=on count=3 size=0.5 at=0,0,1 mode=good out=x.png").empty());
  CHECK_THAT(fails("thing.set a on=maybe"),
             Catch::StartsWith("script: line 2: thing.set: on = 'maybe': expected true or false"));
  CHECK_THAT(fails("thing.set a count=2.5"), Contains("expected a whole number from 1 to 9"));
  CHECK_THAT(fails("thing.set a count=10"), Contains("expected a whole number from 1 to 9"));
  CHECK_THAT(fails("thing.set a size=-1"), Contains("expected a number of at least 0 m"));
  CHECK_THAT(fails("thing.set a size=nan"), Contains("expected a number"));
  CHECK_THAT(fails("thing.set a at=0,0"), Contains("expected three numbers x,y,z, each from -1 to 1"));
  CHECK_THAT(fails("thing.set a at=0,0,2"), Contains("each from -1 to 1"));
  CHECK_THAT(fails("thing.set a mode=fats"), Contains("expected one of fast, good; did you mean 'fast'?"));
  CHECK_THAT(fails("thing.set a out=\"\""), Contains("expected a file (.png)"));
  CHECK_THAT(fails("thing.set \"two\nlines\""), Contains("expected a text on one line"));
  CHECK_THAT(fails("thing.set"), Contains("thing is missing; expected thing.set THING [on=true|false]"));
  CHECK_THAT(fails("thing.set a sise=2"), Contains("there is no parameter 'sise'; did you mean 'size'?"));
  CHECK_THAT(fails("thing.set a size=1 size=2"), Contains("size is given twice"));
  CHECK_THAT(fails("thing.set a true 1 1 0,0,0 fast x.png more"), Contains("'more' is one word too many"));
  CHECK_THAT(fails("thing.sit a"), Contains("unknown command 'thing.sit'; did you mean 'thing.set'?"));
  CHECK_THAT(fails("zzzzz"), Contains("unknown command 'zzzzz'; 'help' lists the commands"));
}

TEST_CASE("a quoted word is a value, whatever its content") {
  const Registry r = one_of_each();
  CHECK(r.parse("thing.set \"size=2\"").arguments.text("thing") == "size=2");
  CHECK(r.parse("thing.set thing=\"a b\"").arguments.text("thing") == "a b");
  CHECK(r.print(r.parse("thing.set size=2.50 thing=a on=off")) == "thing.set a on=false size=2.5");
  CHECK(r.target(r.parse("thing.set a size=2")) == r.target(r.parse("thing.set a size=3")));
  CHECK(r.target(r.parse("thing.set a size=2")) != r.target(r.parse("thing.set b size=2")));
  CHECK(r.target(r.parse("thing.set a size=2")) != r.target(r.parse("thing.set a count=2")));
}

TEST_CASE("every command of the workspace round-trips through its text") {
  session::FakeSession session;
  Workspace work(session);
  CHECK(test::round_trip(work.registry) > 150);
  for (const auto& [name, command] : work.registry.all()) {
    INFO(name);
    CHECK(command.help.size() > 10);
    CHECK(command.help.back() == '.');
    CHECK_THAT(work.registry.manual(command), Contains(command.help) && Catch::StartsWith(name));
    CHECK_FALSE(work.manual(name).empty());
  }
}

TEST_CASE("settings are commands, with the option table's messages") {
  session::FakeSession session;
  Workspace work(session);
  CHECK(work.registry.print(work.registry.parse("film.ev=1.50")) == "set film.ev 1.50");
  CHECK(work.registry.print(work.registry.parse("set film.ev=2")) == "set film.ev 2");
  CHECK_THAT(failure(work.registry, "set film.evv 1"),
             Contains("there is no setting 'film.evv'; did you mean 'film.ev'?"));
  CHECK_THAT(failure(work.registry, "film.evv 1"), Contains("did you mean 'film.ev'?"));
  CHECK_THAT(failure(work.registry, "film.ev 99", "x"),
             Contains("x: set: film.ev = '99': expected a number from -20 to 20 EV"));
  CHECK_THAT(failure(work.registry, "components.primary of"),
             Contains("expected one of path, cache, photons, auto, off"));
  CHECK_THAT(work.manual("settings"), Contains("film.tone_curve neutral|agx|linear"));
  CHECK_THROWS_WITH(work.manual("camera.orbti"), Contains("did you mean 'camera.orbit'?"));
}

TEST_CASE("partial input is completed") {
  const auto folder =
      std::filesystem::temp_directory_path() / ("lucerna-complete-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder / "sub");
  for (const char* name : {"a scene.gltf", "b.glb", "c.png"}) std::ofstream(folder / name) << "x";
  session::FakeSession session;
  Workspace work(session);
  const auto offers = [&](const std::string& line) { return work.registry.complete(line); };
  using List = std::vector<std::string>;
  CHECK(offers("camera.or") == List{"camera.orbit"});
  CHECK(offers("film.e") == List{"film.ev", "film.exposure_at_load"});
  CHECK(offers("set film.tone") == List{"film.tone_curve"});
  CHECK(offers("set film.tone_curve a") == List{"agx"});
  CHECK(offers("film.tone_curve l") == List{"linear"});
  CHECK(offers("view.solo te") == List{"tertiary"});
  CHECK(offers("light.set lamp in") == List{"intensity=", "inner_cone="});
  CHECK(offers("light.set lamp on=t") == List{"on=true"});
  CHECK(offers("light.set lamp on=true o").empty());
  CHECK(offers("nonsense x").empty());
  CHECK(offers("scene.open " + (folder / "").string()) ==
        List{(folder / "sub/").string(), "\"" + (folder / "a scene.gltf").string() + "\"",
             (folder / "b.glb").string()});
  CHECK(offers("").size() >= work.registry.all().size());
  std::filesystem::remove_all(folder);
}

}  // namespace commands_registry_tests
