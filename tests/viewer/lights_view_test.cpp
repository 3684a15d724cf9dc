// links: session
// Views of learned lights in the real program's window: arrows and their card at a point, the heat map with
// its legend.
#include "viewer/support.h"

namespace lights_view_tests {

using namespace lucerna;

namespace {

size_t differ(const test::Picture& a, const test::Picture& b, uint32_t x0, uint32_t y0, uint32_t x1,
              uint32_t y1) {
  size_t count = 0;
  for (uint32_t y = y0; y < y1; ++y)
    for (uint32_t x = x0; x < x1; ++x) count += glm::length(a.at(x, y) - b.at(x, y)) > 0.1f;
  return count;
}

}  // namespace

TEST_CASE("a point's lights are shown with their shares, and a map shows where shadow rays arrive") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const std::string steps =
      "window.size 1100 700\nwait_scene\nset preview.filter off\nset lights.portals marked\nview.size 160 "
      "100\nsamples 8\nwait_samples "
      "8\nwait "
      "0.5\nscreenshot " +
      file("plain.png") + "\nset overlay.lights true\ninspect.at 0.5 0.75\nwait 0.5\nscreenshot " +
      file("arrows.png") +
      "\ninspect.none\nset overlay.lights false\nset overlay.light_arrival true\nwait "
      "0.5\nscreenshot " +
      file("heat.png") + "\nset overlay.light_arrival false\nwait 0.5\nscreenshot " + file("off.png") +
      "\ninspect.at 0.5 0.5\nquit 0\n";
  const auto outcome = test::run(test::with_display(
      std::string(LUCERNA_BINARY) + " scenes/window/window.gltf --script " + test::script_of(steps)));
  INFO(outcome.output);
  // Without the view and without a cache there is nothing to inspect.
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.output, Catch::Contains("inspect.at: no component takes its light from the cache"));
  const test::Picture plain(file("plain.png")), arrows(file("arrows.png")), heat(file("heat.png")),
      off(file("off.png"));
  CHECK(differ(arrows, plain, 0, 60, 790, 560) > 2000);
  CHECK(differ(heat, plain, 0, 60, 790, 560) > 12000);
  CHECK(differ(off, plain, 0, 60, 790, 560) < 500);
}

}  // namespace lights_view_tests
