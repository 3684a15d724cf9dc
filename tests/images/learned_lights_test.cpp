// links: session
// Learned light selection: the same light as selection by power in every scene, reproducible bit for bit, and
// less noise where walls hide most of the lights.
#include "images/learned_lights_support.h"
#include "transport/light_learning.h"

namespace learned_lights_tests {

using namespace lucerna;

namespace {

using test::noise, test::Settings, test::sky, test::window_room, test::with;

/// Lamps of very different power behind a screen: the brightest is next to a surface, one is in a niche.
scene::Scene lamps() {
  scene::Scene s = test::block_room();
  s.materials.push_back(test::diffuse(vec3(0.5f), vec3(40, 20, 10)));
  s.lights[0].intensity = vec3(1);
  const auto add = [&](vec3 at, float intensity, scene::LightKind kind = scene::LightKind::point) {
    scene::Light lamp = s.lights[0];
    lamp.kind = kind, lamp.position = at, lamp.intensity = vec3(intensity), lamp.direction = vec3(0, -1, 0);
    lamp.inner_cone = 0.3f, lamp.outer_cone = 0.6f;
    s.lights.push_back(lamp);
  };
  add({3, 1, 0}, 1000);                 // outside
  add({0, 0.5f, -0.5f}, 300);           // in the block
  add({-1.99f, 0.02f, -1.99f}, 0.01f);  // in a corner of the floor
  add({-1, 2.4f, 1}, 4, scene::LightKind::spot);
  test::add_quad(s, {-0.7f, 2.4f, 0.4f}, {0.2f, 0, 0}, {0, 0, 0.2f}, uint32_t(s.materials.size() - 1));
  test::add_quad(s, {1.9f, 0.1f, 1.9f}, {-0.05f, 0, 0}, {0, 0.05f, 0}, uint32_t(s.materials.size() - 1));
  return s;
}

/// Pictures by power and learned, with the same number of samples for each of that many seeds.
void check_same_light(const char* name, const scene::Scene& s, uint32_t samples,
                      const Settings& settings = {}) {
  INFO(name);
  for (const char* seed : {"1", "2"}) {
    Settings of = settings;
    of["seed"] = seed;
    const test::Result learned = with(s, "learned", samples, of);
    of["seed"] = std::string(seed) + "0";
    const test::Result power = with(s, "power", samples, of);
    CHECK(test::worst_z(learned.image, power.image) < 6);
    CHECK(learned.stats.dropped == 0);
  }
}

}  // namespace

TEST_CASE("the same light through a window, through a pane and under a constant environment") {
  check_same_light("window", window_room(sky(), false), 128);
  check_same_light("pane", window_room(sky(), true), 128);
  scene::Scene constant = window_room({}, false);
  constant.environment.radiance = vec3(1, 2, 3);
  check_same_light("constant", constant, 128);
}

TEST_CASE("the same light of lamps that are mostly hidden") { check_same_light("lamps", lamps(), 256); }

TEST_CASE("the same light in an open room and with materials that reflect and refract") {
  check_same_light("open", test::room(), 128, {{"relight.enabled", "off"}});
}

TEST_CASE("texels that are huge, negative or NaN do not invalidate the estimate") {
  const scene::Scene s = window_room(sky(true), false);
  const test::Result r = with(s, "learned", 64);
  CHECK(r.stats.dropped == 0);
  for (const vec3& v : r.image.components[0]) REQUIRE(std::isfinite(luminance(v)));
}

TEST_CASE("with one lamp or no light nothing is learned and nothing is spent") {
  const scene::Scene one = test::block_room();
  CHECK(test::identical(with(one, "learned", 8).image, with(one, "power", 8).image));
  scene::Scene dark = window_room(sky(), false);
  dark.environment.scale = 0;
  CHECK(test::identical(with(dark, "learned", 8).image, with(dark, "power", 8).image));
}

TEST_CASE("the picture is a function of scene, settings and seed") {
  const scene::Scene s = lamps();
  const film::Image first = with(s, "learned", 8).image;
  CHECK(test::identical(first, with(s, "learned", 8).image));
  CHECK(test::identical(first, with(s, "learned", 8, {{"path.batch", "1024"}}).image));
  CHECK_FALSE(test::identical(first, with(s, "power", 8).image));
  // Cancelled work changes nothing.
  session::Renderer renderer(test::renderer_options(false));
  renderer.settings().set("path.batch", test::k_batch);
  renderer.set_size(32, 32);
  renderer.set_scene(std::make_shared<scene::Scene>(s));
  test::set(renderer,
            {{"lights.sampling", "learned"}, {"samples", "8"}, {"cache.max_records", test::k_room}});
  for (int limit = 0; !renderer.done(); ++limit) {
    int calls = 0;
    renderer.step([&] { return ++calls > limit; });
  }
  CHECK(test::identical(first, renderer.image()));
}

TEST_CASE("a picture of the same view with other solvers replays what was learned, bit for bit") {
  const auto scene = std::make_shared<scene::Scene>(window_room(sky(), false));
  const auto make = [&] {
    auto renderer = std::make_unique<session::Renderer>(test::renderer_options(false));
    renderer->settings().set("path.batch", test::k_batch);
    renderer->set_size(32, 32);
    renderer->set_scene(scene);
    return renderer;
  };
  const auto finish = [](session::Renderer& renderer, const char* solver, const char* samples) {
    test::set(renderer, {{"components.secondary", solver},
                         {"components.tertiary", solver},
                         {"samples", samples},
                         {"cache.max_records", test::k_room}});
    test::finish(renderer);
    const nlohmann::ordered_json lights = renderer.solvers().statistics().at("lights");
    CHECK(lights.at("records") > 0);
    return lights.at("replayed").get<uint32_t>();
  };
  const auto renderer = make(), fresh = make();
  CHECK(finish(*renderer, "path", "4") == 0);
  // Two generations after one and two samples; the third one is new.
  CHECK(finish(*renderer, "cache", "8") == 2);
  CHECK(finish(*fresh, "cache", "8") == 0);
  CHECK(test::identical(renderer->image(), fresh->image()));
  CHECK(finish(*renderer, "path", "8") == 3);
  CHECK(finish(*fresh, "path", "8") == 3);
  CHECK(test::identical(renderer->image(), fresh->image()));
  // Another view learns for itself.
  const scene::Camera other = test::looking_down({0.1f, 0.9f, 0.1f}, 1.3f);
  renderer->set_camera(other);
  CHECK(finish(*renderer, "path", "8") == 0);
  const auto there = make();
  there->set_camera(other);
  CHECK(finish(*there, "path", "8") == 0);
  CHECK(test::identical(renderer->image(), there->image()));
}

TEST_CASE("pilots end where learning gains little, and go on where it gains much") {
  const auto lights = [](const auto& load) {
    session::Renderer renderer(test::renderer_options(false));
    renderer.settings().set("path.batch", test::k_batch);
    renderer.set_size(48, 40);
    load(renderer);
    test::set(renderer, {{"samples", "8"}, {"cache.max_records", test::k_room}});
    test::finish(renderer);
    return renderer.solvers().statistics().at("lights");
  };
  // One lamp, visible from everywhere: samples of the second pilot show it, and no third follows.
  const auto open = lights([](session::Renderer& renderer) {
    renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  });
  CHECK(open.at("gain").get<double>() < transport::k_least_gain);
  CHECK(open.at("records") < 5000);  // three pilots have 9353
  const auto narrow = lights([](session::Renderer& renderer) {
    renderer.set_scene(std::make_shared<scene::Scene>(window_room(sky(), false, 0.2f)));
  });
  CHECK(narrow.at("gain").get<double>() > transport::k_least_gain);
  CHECK(narrow.at("records") > 5000);
}

TEST_CASE("less noise through a window") {
  const scene::Scene s = window_room(sky(), false, 0.2f);
  const double power = noise(s, "power"), learned = noise(s, "learned");
  INFO("variance " << power << " by power, " << learned << " learned");
  CHECK(2.5 * learned < power);
}

}  // namespace learned_lights_tests
