// links: ui film_io
// A solver unknown to the window (support/ambient/ambient.h): its table and report give it a panel, keys, a
// legend, a card, files and commands. Over a session without a renderer.
#include "inside.h"
#include "solvers/registry.h"
#include "support/ambient/ambient.h"

namespace other_solver_tests {

using namespace lucerna;

namespace {

const vec3 k_pink(255, 64, 200), k_green(40, 230, 90), k_accent(112, 164, 222), k_gold(255, 219, 115);

solvers::Report reported(const plan::Settings& settings, std::optional<vec2> looked_at) {
  solvers::Report r{.solver = "ambient", .state = "constant"};
  r.sections = {
      {.title = "Ambient light",
       .note = "constant",
       .items = {
           solvers::ValueRow{"Radiance", settings.text("ambient.radiance"), "From every direction."},
           solvers::ViewButtons{{"overlay.ambient"}},
           solvers::CommandButtons{{{.command = "double", .help = "Doubles the light."}}},
           solvers::Histogram{
               {{.height = 1, .ink = k_pink / 255.0f},
                {.height = 1, .ink = k_pink / 255.0f, .lower = 0.5f, .lower_ink = k_green / 255.0f}}}}}};
  if (settings.text("overlay.ambient") != "off")
    r.legends = {{.title = "Middle",
                  .marks = {{k_green / 255.0f, "one"}, {k_pink / 255.0f, "the other"}},
                  .marks_in_line = false}};
  r.looked_at = looked_at;
  if (looked_at) {
    r.card.emplace();
    r.card->lines = {{solvers::Card::Title{"A place", "12"}},
                     {solvers::Card::Weight{"glass", 0.8f, 0.8f}},
                     {solvers::Card::Weight{"film", 0.2f, 0.8f}}};
  }
  return r;
}

/// Before the first use of the solver list.
const bool k_added = [] {
  solvers::add(lucerna::ambient::type());
  session::fake::more = [](const plan::Settings& settings,
                           std::optional<vec2> looked_at) -> std::optional<solvers::Report> {
    if (settings.text("components.tertiary") != "ambient") return std::nullopt;
    return reported(settings, looked_at);
  };
  return true;
}();

}  // namespace

TEST_CASE("a solver unknown to the window has its panel, keys, legend, card and commands") {
  REQUIRE(k_added);
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto outcome =
      test::window("wait_scene\nwait_samples 2\nrender.pause\nwindow.side ambient\nwait 0.2\nscreenshot " +
                   file("empty.png") +
                   // The button of the empty panel, at the same place for every solver.
                   "\nmouse.move 1290 154\nmouse.down\nmouse.up\nwait 0.3\nkey k\nkey k\nkey m\nkey "
                   "y\nwait_ambient\nmouse.move 500 400\nwait "
                   "0.7\nscreenshot " +
                   file("all.png") + "\nkey m\nkey m\nwait 0.3\nscreenshot " + file("off.png") +
                   "\nambient.save slow.ambient\nambient.load a.ambient\nhelp wait_ambient\nhelp "
                   "ambient.save\nscript.save " +
                   file("session.lucerna") + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const std::string script = read_file(file("session.lucerna"));
  CHECK_THAT(script,
             Catch::Contains("set components.tertiary ambient\nwindow.side scene\nwindow.side ambient\n"
                             "set overlay.ambient small\nambient.double\nwait_ambient\n"));
  CHECK_THAT(script, Catch::Contains("set overlay.ambient large\nset overlay.ambient off\nambient.save"));
  CHECK_THAT(outcome.output,
             Catch::Contains("ambient: command double") && Catch::Contains("saved slow.ambient"));
  CHECK_THAT(outcome.output, Catch::Contains("preparation of the ambient light") &&
                                 Catch::Contains("Saves the ambient radiance"));
  const test::Picture empty(file("empty.png")), all(file("all.png")), off(file("off.png"));
  // The last of three titles is that of the displayed panel.
  CHECK(test::near_colour(all, 1345, 32, 1435, 36, k_accent) > 100);
  CHECK(test::near_colour(all, 1150, 32, 1335, 36, k_accent) == 0);
  // The histogram, half of one column in another colour; the legend; the card's bars.
  CHECK(test::near_colour(empty, 1150, 80, 1436, 400, k_pink) == 0);
  CHECK(test::near_colour(all, 1150, 80, 1436, 400, k_pink) > 1000);
  CHECK(test::near_colour(all, 1150, 80, 1436, 400, k_green) > 500);
  CHECK(test::near_colour(all, 280, 500, 600, 680, k_green) > 60);
  CHECK(test::near_colour(off, 280, 500, 600, 680, k_green) == 0);
  CHECK(test::near_colour(all, 820, 80, 1132, 300, k_gold) > 200);
  CHECK(test::near_colour(off, 820, 80, 1132, 300, k_gold) == 0);
}

}  // namespace other_solver_tests
