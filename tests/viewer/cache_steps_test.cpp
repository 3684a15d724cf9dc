// links: ui film_io
// Building the irradiance cache stage by stage, by keys, buttons and commands: over a session without a
// renderer, and in the program itself.
#include "inside.h"

namespace cache_steps_tests {

using namespace lucerna;

namespace {

/// The middle of the line under the last completed stage, in the strip of stages; -1 if there is none.
int marked_stage(const test::Picture& p) {
  const vec3 accent(112, 164, 222);
  for (int y = 380; y < 560; ++y) {
    int n = 0, sum = 0;
    for (int x = 1150; x < 1430; ++x)
      if (test::near_colour(p, x, y, x + 1, y + 1, accent, 0.03f)) ++n, sum += x;
    if (n >= 18) return sum / n;
  }
  return -1;
}

const char* const k_start =
    "wait_scene\nwait_samples 2\nkey k\ncomponents.secondary cache\noverlay.placement stage\ncache.pause "
    "stage\n"
    "render.restart\nwait_cache\nmouse.move 640 800\n";

}  // namespace

TEST_CASE("keys and commands advance stage by stage, and the panel shows where building waits") {
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto outcome = test::window(
      std::string(k_start) + "screenshot " + file("probe.png") + "\nkey x\nwait_cache\nscreenshot " +
      file("choose.png") + "\ncache.step\ncache.step limit=20\nscreenshot " + file("thin.png") +
      "\nkey p\nscreenshot " + file("plain.png") + "\nkey j\nwait_cache\nwait_samples 3\nscreenshot " +
      file("complete.png") + "\nscript.save " + file("session.lucerna") + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const test::Picture probe(file("probe.png")), choose(file("choose.png")), thin(file("thin.png")),
      plain(file("plain.png"));
  const int at_probe = marked_stage(probe), at_choose = marked_stage(choose), at_thin = marked_stage(thin);
  INFO(at_probe << " " << at_choose << " " << at_thin);
  CHECK(at_probe > 1150);
  CHECK(at_choose > at_probe + 25);
  CHECK(at_thin > at_choose + 45);
  // The legend at the picture's lower left: colours of chosen candidates; none when nothing is shown.
  const vec3 chosen(255, 219, 115);
  CHECK(test::near_colour(thin, 280, 560, 600, 680, chosen) > 40);
  CHECK(test::near_colour(probe, 280, 560, 600, 680, chosen) == 0);
  CHECK(test::near_colour(plain, 280, 560, 600, 680, chosen) == 0);
  const std::string script = read_file(file("session.lucerna"));
  CHECK_THAT(script, Catch::Contains("set cache.pause stage"));
  CHECK_THAT(script, Catch::Contains("cache.step\nwait_cache\ncache.step\ncache.step limit=20\n"));
  CHECK_THAT(script, Catch::Contains("set overlay.placement off\ncache.run"));
}

TEST_CASE("a script that waits for a picture while the cache waits gets an error") {
  if (test::no_display()) return;
  auto outcome = test::window(std::string(k_start) + "wait_samples 2\nquit\n");
  INFO(outcome.output);
  CHECK(outcome.status != 0);
  CHECK_THAT(outcome.output,
             Catch::Contains("building of the cache is paused (cache.pause); cache.run continues"));
  for (const char* command : {"cache.step", "cache.run", "wait_cache"}) {
    outcome = test::window("wait_scene\n" + std::string(command) + "\nquit\n");
    INFO(outcome.output);
    CHECK(outcome.status != 0);
    CHECK_THAT(outcome.output, Catch::Contains(std::string(command) + ": no component takes its light from "
                                                                      "the cache"));
  }
}

TEST_CASE("in the program candidates, clusters and chosen candidates are drawn in turn") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto outcome =
      test::program("scenes/cornell/cornell.gltf",
                    "window.size 1100 700\nwait_scene\nview.divisor 4\nwindow.side cache\nsamples 2\n"
                    "cache.rays 64\ncache.max_rays 64\ncache.pause stage\noverlay.placement stage\n"
                    "components.secondary cache\ncomponents.tertiary cache\nwait_cache\nscreenshot " +
                        file("candidates.png") + "\ncache.step\nscreenshot " + file("clusters.png") +
                        "\ncache.step\ncache.step\nscreenshot " + file("chosen.png") +
                        "\ncamera.orbit 0.3 0\nwait_cache\nwait 0.5\nscreenshot " + file("turned.png") +
                        "\ncache.run\nwait_samples 2\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  // The picture is 524 x 408 at (280, 68).
  const vec3 ink(255, 219, 115), screen(255, 154, 99), white(255, 255, 255);
  const auto count = [&](const char* name, const vec3& colour, float reach) {
    return test::near_colour(test::Picture(file(name)), 290, 80, 800, 400, colour, reach);
  };
  CHECK(count("candidates.png", screen, 0.2f) > 1000);
  CHECK(count("clusters.png", white, 0.1f) > 500);
  CHECK(count("candidates.png", ink, 0.1f) < 100);
  CHECK(count("chosen.png", ink, 0.15f) > 500);
  CHECK(count("turned.png", ink, 0.15f) > 300);
}

}  // namespace cache_steps_tests
