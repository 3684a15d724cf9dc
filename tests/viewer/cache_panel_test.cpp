// links: ui film_io
// The panel of the irradiance cache and the card of the inspected point: over a session without a renderer,
// and in the program itself.
#include "inside.h"

namespace cache_panel_tests {

using namespace lucerna;

namespace {

const vec3 k_gold(255, 219, 115), k_accent(112, 164, 222), k_teal(64, 184, 172), k_violet(156, 128, 224),
    k_warning(222, 178, 88);

}  // namespace

TEST_CASE("the panel opens beside the scene's, and says if the cache is not used, and how to use it") {
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto outcome = test::window(
      "wait_scene\nwait_samples 2\nrender.pause\nwindow.section \"Stages of building\" false\nscreenshot " +
      file("scene.png") +
      // The tab, then the button in the empty panel.
      "\nmouse.move 1257 48\nmouse.down\nmouse.up\nwait 0.2\nscreenshot " + file("empty.png") +
      "\nmouse.move 1290 154\nmouse.down\nmouse.up\nwait 0.3\nmouse.move 640 800\nwait 0.3\nscreenshot " +
      file("cache.png") + "\nscript.save " + file("session.lucerna") + "\nkey k\nwait 0.2\nscreenshot " +
      file("back.png") + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const std::string script = read_file(file("session.lucerna"));
  CHECK_THAT(script, Catch::Contains("window.side cache"));
  CHECK_THAT(script, Catch::Contains("set components.secondary cache\nset components.tertiary cache"));
  const test::Picture scene(file("scene.png")), empty(file("empty.png")), cache(file("cache.png")),
      back(file("back.png"));
  // The line over the title of the displayed panel.
  for (const auto& [picture, left] :
       {std::pair{&scene, true}, {&empty, false}, {&cache, false}, {&back, true}}) {
    CHECK((test::near_colour(*picture, 1150, 32, 1218, 36, k_accent) > 70) == left);
    CHECK((test::near_colour(*picture, 1224, 32, 1292, 36, k_accent) > 70) == !left);
  }
  // Numbers, bars of the overlap, colours of the passes; none of them in the empty panel.
  const vec3 unserved(191, 31, 41), first_pass(255, 154, 99);
  CHECK(test::near_colour(cache, 1150, 260, 1436, 350, unserved) > 20);
  CHECK(test::near_colour(empty, 1150, 260, 1436, 350, unserved) == 0);
  CHECK(test::near_colour(cache, 1150, 440, 1436, 672, first_pass, 0.15f) > 20);
  CHECK(cache.contrast(1150, 90, 1430, 240) > 0.05);
}

TEST_CASE("keys show the cache over the picture, and a pointer at rest inspects the point under it") {
  if (test::no_display()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto outcome = test::window(
      "wait_scene\nwait_samples 2\nrender.pause\ncomponents.secondary cache\nwait 0.3\n"
      // No view is on yet: no inspection.
      "mouse.move 500 400\nwait 0.7\nscreenshot " +
      file("nothing.png") + "\nkey c\nkey n\nkey v\nkey v\nwait 0.7\nscreenshot " + file("card.png") +
      // No inspection while the view is rotated; after that there is.
      "\nmouse.down\nmouse.move 520 420\nmouse.move 560 440\nwait 0.5\nscreenshot " + file("turning.png") +
      "\nmouse.up\nwait 0.7\nscreenshot " + file("turned.png") +
      // The card moves away from the pointer, and disappears when the pointer leaves the picture.
      "\nmouse.move 1000 120\nwait 0.7\nscreenshot " + file("aside.png") +
      "\nmouse.move 640 800\nwait 0.5\nscreenshot " + file("gone.png") +
      "\ninspect.at 0.25 0.75\nscreenshot " + file("asked.png") +
      // Where lookups are not possible, or find no record, the card says so instead of listing weights.
      "\ninspect.at 0.02 0.5\nscreenshot " + file("mirror.png") + "\ninspect.at 0.98 0.5\nscreenshot " +
      file("steep.png") + "\ninspect.none\nscript.save " + file("session.lucerna") + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const auto bars = [&](const char* name, bool right) {  // of the weights, in the card
    return test::near_colour(test::Picture(file(name)), right ? 820 : 292, 80, right ? 1132 : 580, 460,
                             k_gold) > 200;
  };
  CHECK_FALSE(bars("nothing.png", true));
  CHECK(bars("card.png", true));
  CHECK_FALSE(bars("card.png", false));
  CHECK_FALSE(bars("turning.png", true));
  CHECK(bars("turned.png", true));
  CHECK(bars("aside.png", false));
  CHECK_FALSE(bars("aside.png", true));
  CHECK_FALSE(bars("gone.png", true));
  CHECK(bars("asked.png", true));
  for (const bool steep : {false, true}) {
    const char* name = steep ? "steep.png" : "mirror.png";
    INFO(name);
    CHECK_FALSE(bars(name, true));
    const test::Picture note(file(name));
    CHECK(note.contrast(820, 84, 1132, 108) > 0.05);
    CHECK((test::near_colour(note, 820, 82, 1132, 124, k_warning) > 50) == steep);
    // Its second line, which a point without records does not have.
    CHECK((test::near_colour(note, 820, 107, 1132, 124, k_warning) > 20) == steep);
  }
  // Light by part has its component's colour.
  const test::Picture card(file("card.png"));
  CHECK(test::near_colour(card, 818, 200, 860, 300, k_teal) > 30);
  CHECK(test::near_colour(card, 818, 200, 860, 300, k_violet) > 30);
  const std::string script = read_file(file("session.lucerna"));
  CHECK_THAT(script, Catch::Contains("set overlay.records true\nset overlay.normals true"));
  CHECK_THAT(script, !Catch::Contains("inspect"));  // inspection is not recorded
}

TEST_CASE("in the program lines lead from a point to the records that it reads") {
  if (test::no_program()) return;
  const test::Folder folder;
  const auto file = [&](const char* name) { return (folder.path / name).string(); };
  const auto outcome = test::program(
      "scenes/cornell/cornell.gltf",
      "window.size 1100 700\nwait_scene\nview.divisor 4\nwindow.side cache\npreview.filter off\n"
      "inspect.none\ncache.rays 64\ncache.min_radius 1\ncache.max_rays 64\ncomponents.secondary cache\n"
      "components.tertiary cache\nsamples 2\nwait_samples 2\nwait 0.5\nscreenshot " +
          file("plain.png") + "\ninspect.at 0.5 0.85\nscreenshot " + file("lines.png") +
          "\ninspect.none\noverlay.normals true\nwait 0.5\nscreenshot " + file("normals.png") + "\nquit\n");
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
  const test::Picture plain(file("plain.png")), lines(file("lines.png")), normals(file("normals.png"));
  const auto differ = [&](const test::Picture& a, int x0, int y0, int x1, int y1) {
    int n = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const vec3 d = glm::abs(a.at(uint32_t(x), uint32_t(y)) - plain.at(uint32_t(x), uint32_t(y)));
        n += std::max({d.x, d.y, d.z}) > 0.1f;
      }
    return n;
  };
  // The picture is 572 x 604 at (232, 68): the point, the far wall, and the card.
  CHECK(differ(lines, 498, 561, 538, 601) > 40);
  CHECK(differ(lines, 250, 150, 440, 300) == 0);
  CHECK(test::near_colour(lines, 470, 80, 800, 560, k_gold) > 100);
  CHECK(differ(normals, 240, 80, 800, 660) > 500);
}

TEST_CASE("inspecting a cache that is not used is an error with advice") {
  if (test::no_display()) return;
  const auto outcome = test::window("wait_scene\ninspect.at 0.5 0.5\nquit\n");
  INFO(outcome.output);
  CHECK(outcome.status != 0);
  CHECK_THAT(outcome.output, Catch::Contains(":2: inspect.at: no component takes its light from the "
                                             "cache; set components.secondary cache"));
}

}  // namespace cache_panel_tests
