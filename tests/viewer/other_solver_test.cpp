// links: ui film_io
// A solver unknown to the window, defined here: its table and report give it a panel, keys, a legend, a card,
// files and commands. Over a session without a renderer.
#include "inside.h"
#include "solvers/registry.h"
#include "solvers/solver.h"

using namespace lucerna;

namespace {

const vec3 k_pink(255, 64, 200), k_green(40, 230, 90), k_accent(112, 164, 222), k_gold(255, 219, 115);

const solvers::SolverInfo& lantern() {
  static const solvers::SolverInfo info{
      .name = "lantern",
      .label = "Lantern",
      .title = "the magic lantern",
      .help = "Throws slides on walls.",
      .serves = {false, false, false, true},
      .looked_up = true,
      .options = {integer_option("lantern.slides", 24, 1, 100, "slides", "Slides in the tray.", "Slides"),
                  without_restart(choice_option("overlay.slides", "off", {"off", "rims", "whole"}, "",
                                                "Slides.", "Slides"))},
      .views = {{.option = "overlay.slides", .label = "Slides", .shortcut = 'M', .inspects_pointer = true}},
      .commands = {{.name = "next",
                    .label = "Next slide",
                    .help = "Changes it.",
                    .shortcut = 'Y',
                    .until_still = true}},
      .file =
          solvers::FileInfo{
              .extension = ".tray", .content = "the slides of the lantern", .fits = "of this projector"},
  };
  return info;
}

const solvers::SolverType k_lantern{.info = lantern()};

solvers::Report reported(const plan::Settings& settings, std::optional<vec2> looked_at) {
  solvers::Report r{.solver = "lantern", .state = "shines"};
  r.sections = {
      {.title = "Lantern",
       .note = "shines",
       .items = {
           solvers::ValueRow{"Slides", settings.text("lantern.slides"), "In the tray."},
           solvers::ViewButtons{{"overlay.slides"}},
           solvers::CommandButtons{{{.command = "next", .help = "Changes it."}}},
           solvers::Histogram{
               {{.height = 1, .ink = k_pink / 255.0f},
                {.height = 1, .ink = k_pink / 255.0f, .lower = 0.5f, .lower_ink = k_green / 255.0f}}}}}};
  if (settings.text("overlay.slides") != "off")
    r.legends = {{.title = "Slides",
                  .marks = {{k_green / 255.0f, "one"}, {k_pink / 255.0f, "the other"}},
                  .marks_in_line = false}};
  r.looked_at = looked_at;
  if (looked_at) {
    r.card.emplace();
    r.card->lines = {{solvers::Card::Title{"A slide", "12"}},
                     {solvers::Card::Weight{"glass", 0.8f, 0.8f}},
                     {solvers::Card::Weight{"film", 0.2f, 0.8f}}};
  }
  return r;
}

/// Before the first use of the solver list.
const bool k_added = [] {
  solvers::add(k_lantern);
  session::fake::more = [](const plan::Settings& settings,
                           std::optional<vec2> looked_at) -> std::optional<solvers::Report> {
    if (settings.text("components.caustic") != "lantern") return std::nullopt;
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
  const auto outcome = test::window(
      "wait_scene\nwait_samples 2\nrender.pause\nwindow.side lantern\nwait 0.2\nscreenshot " +
      file("empty.png") +
      // The button of the empty panel, at the same place for every solver.
      "\nmouse.move 1290 154\nmouse.down\nmouse.up\nwait 0.3\nkey k\nkey k\nkey m\nkey "
      "y\nwait_lantern\nmouse.move 500 400\nwait "
      "0.7\nscreenshot " +
      file("all.png") + "\nkey m\nkey m\nwait 0.3\nscreenshot " + file("off.png") +
      "\nlantern.save slow.tray\nlantern.load a.tray\nhelp wait_lantern\nhelp lantern.save\nscript.save " +
      file("session.lucerna") + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const std::string script = read_file(file("session.lucerna"));
  CHECK_THAT(script,
             Catch::Contains("set components.caustic lantern\nwindow.side scene\nwindow.side lantern\n"
                             "set overlay.slides rims\nlantern.next\nwait_lantern\n"));
  CHECK_THAT(script, Catch::Contains("set overlay.slides whole\nset overlay.slides off\nlantern.save"));
  CHECK_THAT(outcome.output, Catch::Contains("lantern: command next") && Catch::Contains("saved slow.tray"));
  CHECK_THAT(outcome.output, Catch::Contains("preparation of the magic lantern") &&
                                 Catch::Contains("Saves the slides of the lantern"));
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
