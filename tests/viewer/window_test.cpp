// links: ui film_io
// The window over a session without a renderer: panels, steps, errors. Each test case runs this executable
// again with a display.
#include "inside.h"
#include "round_trip.h"
#include "ui/layout.h"
#include "ui/runner.h"
#include "ui/state.h"

#include <numeric>
#include <sstream>

namespace window_tests {

using namespace lucerna;

namespace {

/// Runs the steps in a window of this program; SCENE and steps are passed in the environment.
test::Outcome window(const std::string& scene, const std::string& steps, const std::string& more = "") {
  return test::window(steps, "LUCERNA_TEST_SCENE='" + scene + "' " + more);
}

std::vector<std::string> lines_of(const std::string& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("a script is checked before it runs") {
  session::FakeSession session;
  ui::Ui window(session);
  commands::ReportFolder report;
  ui::Runner runner(window.viewport, window.areas, window.log, window.requests, report);
  const auto message = [&](const std::vector<std::string>& lines) -> std::string {
    try {
      commands::parse_script(window.work.registry, lines, "s");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message({"wait 1", "# remark", "", "camera.orbit 0.3 -1  # a turn", "scene.open \"a file.gltf\"",
                 "quit", "film.ev=1", "key ctrl+shift+z"})
            .empty());
  CHECK_THAT(message({"wait 1", "orbt 1 2"}),
             Catch::StartsWith("s:2: unknown command 'orbt'; did you mean 'camera.orbit'?"));
  CHECK_THAT(message({"camera.orbit 1"}), Catch::StartsWith("s:1: camera.orbit: up is missing"));
  CHECK_THAT(message({"wait soon"}),
             Catch::StartsWith("s:1: wait: word 1 ('soon'): expected a number of seconds, or one of"));
  CHECK_THAT(message({"scene.open \"a"}), Catch::StartsWith("s:1: a quotation mark"));
  CHECK_THAT(message({"key ctrl+hyper"}), Catch::Contains("there is no key 'ctrl+hyper'"));
  CHECK(commands::parse_script(window.work.registry, {"", "quit 0"}, "s").at(0).where == "s:2");
}

TEST_CASE("every command of the window is unchanged after read, write and read") {
  session::FakeSession session;
  ui::Ui window(session);
  commands::ReportFolder report;
  ui::Runner runner(window.viewport, window.areas, window.log, window.requests, report);
  CHECK(test::round_trip(window.work.registry) > 200);
  for (const char* name : {"window.panels", "measure", "screenshot", "drop", "camera.orbit", "log.clear"})
    CHECK(window.work.registry.find(name));
}

TEST_CASE("the parts of the window tile it and leave room for the picture") {
  for (const auto& [width, height, scale] :
       {std::array{1440.0f, 900.0f, 1.0f}, {1100.0f, 700.0f, 1.0f}, {2200.0f, 1400.0f, 2.0f}})
    for (int folds = 0; folds < 8; ++folds) {
      ui::Layout layout;
      layout.left = 4000, layout.right = 10, layout.bottom = 3000;  // the most that splitters can set
      layout.left_open = folds & 1, layout.right_open = folds & 2, layout.bottom_open = folds & 4;
      const ui::Areas areas = ui::arrange(layout, {width, height}, scale);
      float covered = 0;
      for (const ui::Area& a : {areas.bar, areas.left, areas.toolbar, areas.picture, areas.right,
                                areas.accuracy, areas.passes, areas.log}) {
        CHECK(a.width() > 0);
        CHECK(a.height() > 0);
        covered += a.width() * a.height();
      }
      CHECK(covered == Approx(width * height));
      CHECK(areas.picture.width() >= ui::k_least_picture_width * scale - 1);
      CHECK(areas.picture.height() >= ui::k_least_picture_height * scale - 1);
      layout.panels = false;
      CHECK(ui::arrange(layout, {width, height}, scale).picture.width() == width);
    }
}

TEST_CASE("a small window folds and narrows panels, and a larger one restores them") {
  ui::Layout chosen;
  chosen.left = 300, chosen.right = 320, chosen.bottom = 260;
  for (const auto& [width, height] : {std::array{640.0f, 420.0f}, {700.0f, 480.0f}, {900.0f, 600.0f}}) {
    INFO(width << " x " << height);
    for (const auto last : {std::optional<ui::Panel>(), std::optional(ui::Panel::left),
                            std::optional(ui::Panel::right), std::optional(ui::Panel::bottom)}) {
      chosen.opened_last = last;
      const ui::Areas small = ui::arrange(chosen, {width, height}, 1);
      CHECK(small.picture.width() >= ui::k_least_picture_width);
      CHECK(small.picture.height() >= ui::k_least_picture_height);
      for (const bool left : {true, false}) {
        const bool open = left ? small.shown.left_open : small.shown.right_open;
        const float size = left ? small.left.width() : small.right.width();
        CHECK(size >= (open ? ui::k_least_side : ui::k_folded));
      }
      // The panel opened last is shown.
      if (last == ui::Panel::left) CHECK(small.shown.left_open);
      if (last == ui::Panel::right) CHECK(small.shown.right_open);
      if (last == ui::Panel::bottom) CHECK(small.shown.bottom_open);
    }
  }
  const ui::Areas large = ui::arrange(chosen, {1440, 900}, 1);
  CHECK(large.left.width() == 300);
  CHECK(large.right.width() == 320);
  CHECK(large.log.height() == 260);
}

TEST_CASE("the picture has half of a small window until the user arranges panels, which then stay") {
  for (const auto& [width, height, scale] : {std::array{1100.0f, 700.0f, 1.0f},
                                             {1280.0f, 720.0f, 1.0f},
                                             {640.0f, 420.0f, 1.0f},
                                             {1600.0f, 1000.0f, 2.0f},
                                             {2200.0f, 1400.0f, 2.0f},
                                             {1024.0f, 1200.0f, 1.0f},
                                             {2560.0f, 600.0f, 1.0f}}) {
    INFO(width << " x " << height << ", scale " << scale);
    const auto share = [&](const ui::Layout& layout) {
      const ui::Area picture = ui::arrange(layout, {width, height}, scale).picture;
      return picture.width() * picture.height() / (width * height);
    };
    CHECK(share({}) >= 0.499f);  // whole pixels
    // The user opens the panel on the right.
    ui::Layout opened;
    opened.right_open = opened.right_arranged = true, opened.opened_last = ui::Panel::right;
    CHECK(ui::arrange(opened, {width, height}, scale).shown.right_open);
  }
  // Opening or folding one panel moves no other.
  const ui::Layout fresh = ui::arrange({}, {1100, 700}, 1).shown;
  CHECK((fresh.left_open && !fresh.right_open && !fresh.bottom_open));
  for (const auto& [panel, open] :
       {std::pair{ui::Panel::right, true}, {ui::Panel::bottom, true}, {ui::Panel::left, false}}) {
    ui::Layout chosen;
    (panel == ui::Panel::right    ? chosen.right_arranged
     : panel == ui::Panel::bottom ? chosen.bottom_arranged
                                  : chosen.left_arranged) = true;
    if (open) chosen.opened_last = panel;
    if (!open) chosen.left_open = false;
    const ui::Layout shown = ui::arrange(chosen, {1100, 700}, 1).shown;
    CHECK(shown.left_open == (panel != ui::Panel::left));
    CHECK(shown.right_open == (panel == ui::Panel::right));
    CHECK(shown.bottom_open == (panel == ui::Panel::bottom));
  }
  // What was arranged stays, though it leaves less than half.
  ui::Layout all;
  all.left_arranged = all.right_arranged = all.bottom_arranged = true;
  const ui::Areas areas = ui::arrange(all, {1100, 700}, 1);
  CHECK(areas.left.width() == all.left);
  CHECK(areas.right.width() == all.right);
  CHECK(areas.log.height() == all.bottom);
  // A window with room shows all.
  const ui::Layout shown = ui::arrange({}, {1440, 900}, 1).shown;
  CHECK((shown.left_open && shown.right_open && shown.bottom_open));
}

TEST_CASE("percentiles") {
  CHECK(ui::percentile({}, 0.5) == 0);
  CHECK(ui::percentile({4, 1, 3, 2, 5}, 0.5) == 3);
  CHECK(ui::percentile({0, 10}, 0.95) == Approx(9.5));
}

TEST_CASE("a picture is shown, panels hide, and the window is saved at its size") {
  if (test::no_display()) return;
  const test::Folder folder;
  const std::string a = (folder.path / "a.png").string(), b = (folder.path / "b.png").string();
  const auto outcome =
      window("hall.gltf",
             "wait_scene\nwait_samples 2\nscreenshot " + a +
                 "\nwindow.panels off\nwait 0.4\nwait_samples 1\nscreenshot " + b + "\nquit\n",
             "LUCERNA_TEST_SIZE=1100x700");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const test::Picture panels(a), bare(b);
  CHECK(panels.image.width == 1100);
  CHECK(panels.image.height == 700);
  CHECK(panels.contrast(400, 150, 700, 400) > 0.02);  // the picture
  CHECK(panels.contrast(10, 40, 270, 400) > 0.02);    // text on the left panel
  // Panels are neutral: all channels are equal without text.
  const vec3 grey = panels.at(3, 300);
  CHECK(grey.x == grey.y);
  CHECK(grey.y == grey.z);
  CHECK(grey.x > 0.08f);
  CHECK(grey.x < 0.18f);
  CHECK(bare.contrast(0, 0, 200, 200) > 0.02);  // the picture extends to the corner
}

TEST_CASE("an error is shown over the previous scene, and a failing script reports the line") {
  if (test::no_display()) return;
  const test::Folder folder;
  const std::string a = (folder.path / "a.png").string(), b = (folder.path / "b.png").string();
  const auto outcome =
      window("hall.gltf", "wait_scene\nwait_samples 2\nscene.open missing.gltf\nwait_load\nscreenshot " + a +
                              "\ndismiss\nscreenshot " + b + "\nquit 0\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const test::Picture strip(a), without(b);
  const vec3 red = strip.at(1084, 72), below = strip.at(500, 400);
  CHECK(red.x > 1.5f * red.y);                               // the strip
  CHECK(std::abs(below.x - without.at(500, 400).x) < 0.2f);  // the scene stays
  CHECK(without.at(1084, 72).x < 1.5f * without.at(1084, 72).y);

  const auto failed = window("missing.gltf", "wait_scene\nquit\n");
  INFO(failed.output);
  CHECK(failed.status != 0);
  CHECK_THAT(failed.output, Catch::Contains("script:1: wait_scene: no scene was loaded"));
}

TEST_CASE("an empty window, a cancelled load, and every step run") {
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto outcome =
      window("", "screenshot " + file("empty.png") + "\nscene.open slow.gltf\nwait 0.3\nscreenshot " +
                     file("loading.png") +
                     "\nscene.cancel\nwait 0.3\nscene.open hall.gltf\nwait_scene\n"
                     "camera.orbit 0.2 0.1\ncamera.look 0.1 0\ncamera.pan 0.02 0.01\ncamera.dolly 2\n"
                     "camera.fly 0 0 0.5\nselect light 2\ncamera.frame\nselect material 1\ncamera.frame\n"
                     "camera.select 2\ncamera.select Detail\nview.solo secondary\nview.solo none\n"
                     "film.ev 1.5\nwindow.size 1200 800\nrender.pause\nrender.resume\nrender.restart\n"
                     "dialog.open\nwait 0.2\ndismiss\nwait_samples 2\nmeasure 2\n"
                     "screenshot " +
                     file("end.png") + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.output, Catch::Contains("\"measure\"") && Catch::Contains("\"answered\": 1"));
  const test::Picture empty(file("empty.png")), end(file("end.png"));
  CHECK(empty.contrast(450, 300, 1000, 560) > 0.01);  // the empty state
  CHECK(end.image.width == 1200);
  CHECK(end.image.height == 800);
}

TEST_CASE("mouse, keys and console act through commands, which a saved session contains") {
  if (test::no_display()) return;
  const test::Folder folder;
  const std::string saved = (folder.path / "session.lucerna").string();
  const auto outcome =
      window("hall.gltf",
             "wait_scene\nwindow.size 1440 900\nwait 0.3\n"
             // A click in the picture on the room's triangle.
             "camera.place 3,1.5,20 1,0.5,-1.5 0,1,0\nmouse.move 712 380\nmouse.down\nmouse.up\n"
             // A drag there moves the view; it is no click.
             "mouse.down\nmouse.move 740 390\nmouse.move 780 400\nmouse.up\n"
             // A drag of the exposure in the toolbar, undone and redone by keys.
             "mouse.move 980 50\nmouse.down\nmouse.move 990 50\nmouse.move 1000 50\nmouse.up\n"
             "key ctrl+z\nkey ctrl+shift+z\n"
             // The console completes, reports errors and continues.
             "key ctrl+l\nwait 0.3\ntype \"film.tone_curve ag\"\nkey tab\nkey enter\n"
             "type \"film.ev bright\"\nkey enter\nwait 0.3\n"
             "script.save " +
                 saved + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const std::vector<std::string> lines = lines_of(saved);
  INFO(std::accumulate(lines.begin(), lines.end(), std::string(),
                       [](const std::string& all, const std::string& line) { return all + line + "\n"; }));
  REQUIRE(lines.size() == 11);
  CHECK_THAT(lines[1], Catch::StartsWith("scene.open ") && Catch::EndsWith("hall.gltf"));
  CHECK(lines[2] == "wait_scene");
  CHECK(lines[3] == "window.size 1440 900");
  CHECK(lines[4] == "camera.place 3,1.5,20 1,0.5,-1.5 0,1,0");
  CHECK(lines[5] == "select object 1");
  CHECK_THAT(lines[6], Catch::StartsWith("camera.place "));
  CHECK_THAT(lines[7], Catch::StartsWith("set film.ev "));
  CHECK(lines[8] == "undo");
  CHECK(lines[9] == "redo");
  CHECK(lines[10] == "set film.tone_curve agx");

  // The script runs, and its session gives the same script.
  const std::string again = (folder.path / "again.lucerna").string();
  const auto replay = window("", "script.run " + saved + "\nscript.save " + again + "\nquit\n");
  INFO(replay.output);
  REQUIRE(replay.status == 0);
  std::ifstream second(again);
  for (const std::string& line : lines) {
    std::string other;
    std::getline(second, other);
    CHECK(line == other);
  }
}

TEST_CASE("a shortcut pressed and released within a frame works in a text field") {
  if (test::no_display()) return;
  const test::Folder folder;
  const std::string saved = (folder.path / "session.lucerna").string();
  const auto outcome = window("hall.gltf",
                              "wait_scene\nkey ctrl+l\nwait 0.3\ntype \"wrong\"\nkey ctrl+a\n"
                              "type \"film.ev 1.25\"\nkey enter\nwait 0.3\nscript.save " +
                                  saved + "\nquit\n");
  INFO(outcome.output);
  CHECK(outcome.status == 0);
  const std::vector<std::string> lines = lines_of(saved);
  REQUIRE(!lines.empty());
  CHECK(lines.back() == "set film.ev 1.25");
}

TEST_CASE("a pointer that rests on the picture inspects nothing during a load") {
  if (test::no_display()) return;
  const auto outcome = window("hall.gltf",
                              "wait_scene\nset components.secondary cache\nset overlay.records true\n"
                              "mouse.move 712 380\nwait 0.5\nscene.open slow.gltf\nwait 0.3\n"
                              "mouse.move 740 400\nwait 0.5\nwait_scene\nwait 0.3\nquit\n");
  INFO(outcome.output);
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.output, !Catch::Contains("inspect.at"));
}

TEST_CASE("a dropped scene opens; a file that cannot be opened is an error, and the scene stays") {
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto outcome = window(
      "hall.gltf",
      "wait_scene\nwait_samples 1\ndrop missing.glb\nwait 0.2\nwait_load\nwait_samples 1\nscreenshot " +
          file("missing.png") + "\ndismiss\ndrop picture.jpg\nwait 0.3\nscreenshot " + file("jpg.png") +
          "\ndrop other.gltf\nwait 0.1\nwait_scene\nselect light 3\n" + "wait_samples 1\nscreenshot " +
          file("other.png") + "\nscript.save " + file("session.lucerna") + "\nquit 0\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  CHECK_THAT(outcome.output,
             Catch::Contains("missing.glb: no such file") &&
                 Catch::Contains("picture.jpg: cannot be opened; expected a scene (.gltf or .glb)"));
  const auto strip = [&](const char* name) {
    const vec3 c = test::Picture(file(name)).at(1084, 72);
    return c.x > 1.5f * c.y;
  };
  CHECK(strip("missing.png"));
  CHECK(strip("jpg.png"));
  CHECK_FALSE(strip("other.png"));  // opening a scene closes the messages
  CHECK(test::Picture(file("missing.png")).contrast(400, 300, 900, 500) > 0.02);
  const std::string script = read_file(file("session.lucerna"));
  // Failed commands are not recorded.
  CHECK_THAT(script,
             !Catch::Contains("missing.glb") && Catch::Contains("other.gltf choose=true\nwait_scene"));
}

TEST_CASE("during a render the strip shows error over time, the forecast and the passes") {
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  // 1440 x 900: the strip is 224 high; accuracy 0..576, passes 576..1008.
  const auto outcome = window(
      "hall.gltf",
      "wait_scene\nwindow.size 1440 900\nwait 0.3\nwait_samples 40\nrender.pause\nwait 0.2\nscreenshot " +
          file("uniform.png") +
          // Another render: the first stays as a faint line until it is cleared.
          "\nrender.resume\nrender.restart\nwait 0.2\nwait_samples 20\nrender.pause\nwait 0.2\nscreenshot " +
          file("earlier.png") + "\naccuracy.clear_runs\nwait 0.2\nscreenshot " + file("cleared.png") +
          "\nfilm.layer error\noverlay.tiles true\nreference.load ref.exr\nwait 0.3\nscreenshot " +
          file("legend.png") + "\nreference.clear\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const test::Picture uniform(file("uniform.png")), earlier(file("earlier.png")),
      cleared(file("cleared.png")), legend(file("legend.png"));
  const vec3 amber(235, 168, 66), teal(64, 184, 172), violet(156, 128, 224), coral(242, 116, 94);
  for (const vec3& c : {amber, teal, violet, coral}) {
    INFO(c.x);
    CHECK(test::near_colour(uniform, 56, 730, 560, 880, c, 0.09f) > 20);  // its line
  }
  CHECK(test::near_colour(uniform, 56, 730, 560, 880, {92, 131, 175}, 0.09f) >
        400);  // the target's line and its tag
  CHECK(test::near_colour(uniform, 56, 730, 560, 880, {65, 65, 65}, 0.03f) > 150);     // the forecast's fan
  CHECK(test::near_colour(uniform, 590, 710, 760, 880, {178, 178, 178}, 0.02f) > 40);  // stages, stacked
  CHECK(uniform.contrast(770, 710, 1000, 880) > 0.05);  // their names and times
  // The faint line.
  const auto faint = [](const test::Picture& p) {
    return test::near_colour(p, 60, 732, 500, 870, {92, 92, 92}, 0.04f);
  };
  CHECK(faint(earlier) > faint(cleared) + 20);
  // Lower left of the picture: ramps of both legends.
  CHECK(test::near_colour(legend, 288, 380, 580, 660, {254, 159, 109}, 0.05f) > 20);  // magma
  CHECK(test::near_colour(legend, 288, 380, 580, 660, {176, 42, 45}, 0.05f) >
        10);  // tiles, far from the target
  CHECK(test::near_colour(uniform, 288, 380, 580, 660, {254, 159, 109}, 0.05f) == 0);
}

TEST_CASE(
    "dragging the target's line sets a what-if value in uniform sampling, the setting in adaptive sampling") {
  if (test::no_display()) return;
  const test::Folder folder;
  const std::string saved = (folder.path / "session.lucerna").string();
  const std::string png = (folder.path / "a.png").string();
  // The line's position is read from a first picture; both runs are paused at the same sample.
  const std::string start =
      "wait_scene\nwindow.size 1440 900\nwait 0.3\nsamples 32\nwait_samples 32\nwait 0.3\n";
  REQUIRE(window("hall.gltf", start + "screenshot " + png + "\nquit\n").status == 0);
  const test::Picture first(png);
  int line = 0;
  for (int y = 730; y < 880; ++y)
    if (test::near_colour(first, 100, y, 400, y + 1, {92, 131, 175}, 0.12f) > 200) line = y;
  REQUIRE(line > 0);
  const auto drag = [&](int from, int by) {
    return fmt::format("mouse.move 200 {}\nmouse.down\nmouse.move 200 {}\nmouse.move 200 {}\nmouse.up\n",
                       from, from + by / 2, from + by);
  };
  const auto outcome = window("hall.gltf", start + drag(line, -30) +
                                               "sampling.mode adaptive\nsampling.target_error 0.1\n"
                                               "mouse.move 700 300\nwait_samples 32\nwait 0.3\nscreenshot " +
                                               png + "\nscript.save " + saved + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const auto recorded = lines_of(saved);
  double what_if = 0;
  for (const std::string& l : recorded)
    if (l.starts_with("accuracy.what_if ")) what_if = std::stod(l.substr(17));
  CHECK(what_if > 0.012);
  CHECK(what_if < 0.1);
  CHECK(std::count_if(recorded.begin(), recorded.end(), [](const std::string& l) {
          return l.starts_with("accuracy.what_if") || l.starts_with("set sampling.target_error");
        }) == 2);  // one gesture, one line

  const test::Picture second(png);
  int adaptive = 0;
  for (int y = 730; y < 880; ++y)
    if (test::near_colour(second, 100, y, 400, y + 1, {92, 131, 175}, 0.12f) > 200) adaptive = y;
  REQUIRE(adaptive > 0);
  const auto set = window("hall.gltf", start + "sampling.mode adaptive\nsampling.target_error 0.1\n" +
                                           "wait_samples 32\nwait 0.3\n" + drag(adaptive, 30) +
                                           "script.save " + saved + "\nundo\nquit\n");
  INFO(set.output);
  REQUIRE(set.status == 0);
  const std::string last = lines_of(saved).back();
  INFO(last);
  REQUIRE(last.starts_with("set sampling.target_error "));
  const double target = std::stod(last.substr(26));
  CHECK(target < 0.09);
  CHECK(target > 0.01);
}

}  // namespace window_tests
