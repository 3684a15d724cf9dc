// links: session
// Portals change noise and never the mean: pictures with marked openings equal those without, also where
// portals miss an opening, overlap, lie in the room or face outwards; those that lie in walls are left out.
#include "images/learned_lights_support.h"
#include "session/found_portals.h"

namespace portals_tests {

using namespace lucerna;

namespace {

using test::noise, test::Settings, test::sky, test::window_room, test::with;

/// A portal in the plane of the window of window_room(), over that part of its width and height.
scene::Portal in_window(float wide = 0.5f, float from = 0, float to = 1) {
  return {"window", {1, 0.55f, wide * (from + to - 1)}, {0, 0, wide * (to - from)}, {0, 0.25f, 0}};
}

/// Pictures with portals, for both ways to choose lights, against pictures without. The significance of
/// worst_z() is about 10^-4 for each comparison.
void check_same_light(const char* name, const scene::Scene& plain, std::vector<scene::Portal> portals,
                      uint32_t samples = 128) {
  INFO(name);
  scene::Scene marked = plain;
  marked.portals = std::move(portals);
  const test::Result reference = with(plain, "power", 4 * samples, {{"seed", "10"}});
  for (const char* how : {"power", "learned"}) {
    INFO(how);
    for (const char* seed : {"1", "2"}) {
      const test::Result r = with(marked, how, samples, {{"seed", seed}});
      CHECK(test::worst_z(r.image, reference.image) < 6);
      CHECK(r.stats.dropped == 0);
    }
  }
}

}  // namespace

TEST_CASE("portals leave the mean as it is under several skies") {
  check_same_light("sky", window_room(sky(), false), {in_window()});
  scene::Scene constant = window_room({}, false);
  constant.environment.radiance = vec3(1, 2, 3);
  check_same_light("constant", constant, {in_window()});
  scene::Image sun = sky();
  for (int k = 0; k < 3; ++k) sun.floats[size_t(4 * (6 * 32 + 15) + k)] = 300;
  scene::Scene turned = window_room(std::move(sun), false);
  turned.environment.rotation = 170;
  check_same_light("sun", turned, {in_window()});
}

TEST_CASE("portals leave the mean as it is behind a pane") {
  check_same_light("pane", window_room(sky(), true), {in_window()});
}

TEST_CASE("portals leave the mean as it is wherever they are") {
  const scene::Scene room = window_room(sky(), false);
  check_same_light("half of the window is not marked", room, {in_window(0.5f, 0, 0.5f)});
  check_same_light("overlapping portals", room,
                   {in_window(0.5f, 0, 0.7f), in_window(0.5f, 0.4f, 1), in_window()});
  check_same_light("in a wall, in the room, outwards, upwards", room,
                   {in_window(),
                    {"wall", {-1, 0.5f, 0}, {0, 0, -0.5f}, {0, 0.3f, 0}},
                    {"room", {0, 0.5f, 0}, {0, 0, 0.5f}, {0, 0.3f, 0}},
                    {"outwards", {1, 0.55f, 0}, {0, 0, -0.5f}, {0, 0.25f, 0}},
                    {"floor", {0, 0, 0}, {0, 0, 0.5f}, {0.5f, 0, 0}}});
}

TEST_CASE("portals through which no sky is seen are left out") {
  const auto room = std::make_shared<scene::Scene>(window_room(sky(), false));
  const auto pane = std::make_shared<scene::Scene>(window_room(sky(), true));
  const std::vector<scene::Portal> marked{in_window(),
                                          {"wall", {-1, 0.5f, 0}, {0, 0, -0.5f}, {0, 0.3f, 0}},
                                          {"room", {0, 0.5f, 0}, {0, 0, 0.5f}, {0, 0.3f, 0}},
                                          {"floor", {0, 0, 0}, {0, 0, 0.5f}, {0.5f, 0, 0}}};
  for (const auto& scene : {room, pane}) {
    const std::vector<scene::Portal> open = session::open_portals(scene, marked);
    REQUIRE(open.size() == 2);
    CHECK(open[0].name == "window");
    CHECK(open[1].name == "room");
  }
}

TEST_CASE("portals survive a bad sky and are nothing without a sky") {
  scene::Scene s = window_room(sky(true), false);
  s.portals = {in_window()};
  const test::Result r = with(s, "learned", 32);
  CHECK(r.stats.dropped == 0);
  for (const vec3& v : r.image.components[0]) REQUIRE(std::isfinite(luminance(v)));
  for (const char* how : {"learned", "power"}) {
    scene::Scene dark = window_room(sky(), false), marked = dark;
    dark.environment.scale = marked.environment.scale = 0;
    marked.portals = {in_window()};
    CHECK(test::identical(with(dark, how, 8).image, with(marked, how, 8).image));
  }
}

TEST_CASE("less noise through a marked window") {
  scene::Scene s = window_room(sky(), false, 0.2f);
  const double power = noise(s, "power"), learned = noise(s, "learned");
  s.portals = {in_window(0.2f)};
  const double marked_power = noise(s, "power"), marked_learned = noise(s, "learned");
  INFO("variance " << power << " by power, " << learned << " learned; with a portal " << marked_power << ", "
                   << marked_learned);
  CHECK(5 * marked_power < power);
  CHECK(1.5 * marked_learned < learned);
}

TEST_CASE("found openings leave the mean as it is and lessen noise as marked ones do") {
  for (const bool pane : {false, true}) {
    INFO("pane " << pane);
    const scene::Scene s = window_room(sky(), pane, 0.2f);
    const test::Result reference = with(s, "power", 1024, {{"seed", "10"}});
    for (const char* how : {"power", "learned"}) {
      INFO(how);
      const test::Result r = with(s, how, 256, {{"lights.portals", "found"}});
      CHECK(test::worst_z(r.image, reference.image) < 6);
      CHECK(r.stats.dropped == 0);
    }
    const double plain = noise(s, "power"), found = noise(s, "power", {{"lights.portals", "found"}});
    scene::Scene marked = s;
    marked.portals = {in_window(0.2f)};
    const double by_mark = noise(marked, "power");
    INFO("variance " << plain << ", marked " << by_mark << ", found " << found);
    CHECK(20 * found < plain);
    CHECK(found < 2 * by_mark);
  }
}

TEST_CASE("openings are searched by the setting, and only where none are marked") {
  scene::Scene s = window_room(sky(), false);
  const Settings found = {{"lights.portals", "found"}};
  // These set it after loading.
  const film::Image plain = with(s, "power", 4).image, with_found = with(s, "power", 4, found).image;
  CHECK_FALSE(test::identical(plain, with_found));

  session::Renderer r(test::renderer_options(true));
  r.set_size(32, 32);
  r.set_scene(std::make_shared<scene::Scene>(s), {},
              {{"lights.portals", "found", ""}, {"lights.sampling", "power", ""}, {"samples", "4", ""}});
  CHECK(test::identical(test::finish(r), with_found));
  // An edit of light keeps what was found.
  r.set_environment(0, 90);
  (void)test::finish(r);
  r.set_environment(1, 0);
  CHECK(test::identical(test::finish(r), with_found));
  test::set(r, {{"lights.portals", "marked"}});
  CHECK(test::identical(test::finish(r), plain));

  s.portals = {in_window(0.5f, 0, 0.5f)};
  CHECK(test::identical(with(s, "power", 4).image, with(s, "power", 4, found).image));
}

TEST_CASE("no openings are found from outdoors, in a closed room, or in an empty scene") {
  const Settings found = {{"lights.portals", "found"}};
  scene::Scene outside = window_room(sky(), false);
  outside.cameras[0].to_world[3] = vec4(0, 1.2f, 0, 1);  // above the roof
  const scene::Scene closed = window_room(sky(), false, 0);
  scene::Scene empty;
  empty.environment.radiance = vec3(1), empty.environment.given = true;
  for (const scene::Scene& s : {outside, closed, empty})
    CHECK(test::identical(with(s, "power", 4).image, with(s, "power", 4, found).image));
}

TEST_CASE("with portals a picture is a function of scene, settings and seed") {
  scene::Scene s = window_room(sky(), false);
  s.portals = {in_window(0.5f, 0, 0.7f), in_window(0.5f, 0.4f, 1)};
  for (const char* how : {"learned", "power"}) {
    const film::Image first = with(s, how, 8).image;
    CHECK(test::identical(first, with(s, how, 8, {{"path.batch", "1024"}}).image));
  }
}

}  // namespace portals_tests
