// links: session
// Lights that come and go: pictures are those of a scene that had them from the start, also while a cache is
// being built; names and groups cost no samples; a saved scene renders bit-identically.
#include <catch2/catch.hpp>
#include <filesystem>

#include "images/cache_support.h"
#include "scene/io/save.h"
#include "scene/sky_image.h"
#include "scene/solar.h"
#include "support/folder.h"
#include "support/rooms.h"

namespace light_list_tests {

using namespace lucerna;
using test::Settings;

namespace {

scene::Light lamp(const char* name, const vec3& position, float strength, scene::Id id) {
  scene::Light l{.name = name, .intensity = vec3(strength), .position = position};
  l.id = id;
  return l;
}

/// The room without lamps, lit by its environment.
scene::Scene dark_room() {
  scene::Scene s = test::block_room(true);
  s.lights.clear();
  return s;
}

struct Bed {
  session::Renderer r;
  explicit Bed(const scene::Scene& s, Settings settings = {}) : r(test::renderer_options(true, {}, true)) {
    r.set_size(16, 16);
    r.settings().set("path.batch", "4096");
    r.set_scene(std::make_shared<scene::Scene>(s));
    settings.try_emplace("samples", "2");
    test::set(r, settings);
  }
  ~Bed() { CHECK(r.device().validation_messages() == 0); }
};

film::Image picture(const scene::Scene& s, const Settings& settings = {}) {
  Bed bed(s, settings);
  return test::finish(bed.r);
}

scene::Scene with(scene::Scene s, const std::vector<scene::Light>& lights) {
  s.lights = lights;
  return s;
}

}  // namespace

TEST_CASE("the first lamp, several, and none again") {
  const scene::Scene dark = dark_room();
  scene::Light spot = lamp("spot", {0.5f, 1.5f, 0}, 3, scene::k_first_added + 1);
  spot.kind = scene::LightKind::spot, spot.direction = {0, -1, 0};
  scene::Light sun = lamp("sun", {}, 2, scene::k_first_added + 2);
  sun.kind = scene::LightKind::directional, sun.direction = vec3(glm::normalize(glm::dvec3(1, -2, 1)));
  const std::vector<std::vector<scene::Light>> lists{
      {lamp("lamp", {0, 1, 0}, 2, scene::k_first_added)},
      {lamp("lamp", {0, 1, 0}, 2, scene::k_first_added), spot, sun},
      {sun},
      {}};
  Bed bed(dark);
  test::finish(bed.r);
  for (const auto& list : lists) {
    INFO(list.size());
    bed.r.set_light_list(list);
    CHECK(test::identical(test::finish(bed.r), picture(with(dark, list))));
  }
}

TEST_CASE("a lamp is added and removed at every stage of the building of a cache") {
  const Settings cached = test::dense_records({{"components.secondary", "cache"},
                                               {"components.tertiary", "cache"},
                                               {"cache.rays", "64"},
                                               {"cache.max_rays", "256"},
                                               {"cache.max_records", "2000"},
                                               {"cache.passes", "2"},
                                               {"samples", "1"}});
  const scene::Scene dark = dark_room();
  const std::vector<scene::Light> one{lamp("lamp", {0, 1, 0}, 2, scene::k_first_added)};
  const film::Image expected = picture(with(dark, one), cached);
  Bed bed(dark, cached);
  for (int steps = 1; steps < 40; steps += 6) {
    INFO(steps);
    bed.r.restart();
    for (int i = 0; i < steps && bed.r.step(); ++i) {
    }
    bed.r.set_light_list(one);
    for (int i = 0; i < steps / 2 && bed.r.step(); ++i) {
    }
    bed.r.set_light_list({});
    bed.r.step();
    bed.r.set_light_list(one);
    const film::Image image = test::finish(bed.r);
    // Records may lie elsewhere than in a cache from scratch, and paths part elsewhere: the light is the
    // same.
    for (const int c : k_components)
      CHECK(test::mean(image.components[c]) ==
            Approx(test::mean(expected.components[c])).epsilon(0.1).margin(1e-4));
    bed.r.set_light_list({});
  }
}

TEST_CASE("names and ids cost no samples; groups only where they are separate") {
  scene::Scene s = dark_room();
  s.lights = {lamp("left", {-0.5f, 1, 0}, 2, 1), lamp("right", {0.5f, 1, 0}, 1, 2)};
  Bed bed(s, {{"samples", "4"}, {"relight.enabled", "off"}});
  test::finish(bed.r);
  const uint64_t before = bed.r.restarts();
  s.lights[0].name = "window", s.lights[1].group = "evening", s.lights[1].id = 7;
  bed.r.set_light_list(s.lights);
  CHECK(bed.r.restarts() == before);
  CHECK(bed.r.samples() == 4);
  CHECK(bed.r.scene()->lights == s.lights);
  // With separate groups the films change.
  test::set(bed.r, {{"relight.enabled", "compact"}});
  test::finish(bed.r);
  s.lights[0].group = "morning";
  bed.r.set_light_list(s.lights);
  CHECK(bed.r.relight().groups->find("morning") < bed.r.relight().groups->groups.size());
  Bed fresh(s, {{"samples", "4"}, {"relight.enabled", "compact"}});
  CHECK(test::identical(test::finish(bed.r), test::finish(fresh.r)));
}

TEST_CASE("an invalid list changes nothing") {
  scene::Scene s = dark_room();
  s.lights = {lamp("left", {0, 1, 0}, 2, 1)};
  Bed bed(s);
  const film::Image before = test::finish(bed.r);
  std::vector<scene::Light> list = s.lights;
  list.push_back(lamp("wrong", {0, 2e9f, 0}, 1, 2));
  CHECK_THROWS_WITH(bed.r.set_light_list(list), Catch::Contains("light 'wrong'"));
  CHECK(bed.r.scene()->lights == s.lights);
  CHECK(test::identical(bed.r.image(), before));
  CHECK_THROWS_WITH(bed.r.set_environment_sky({.turbidity = 99}, 1), Catch::Contains("the turbidity is 99"));
}

TEST_CASE("a sky lights the scene like its image") {
  scene::Scene s = dark_room();
  const scene::SkyModel sky{.turbidity = 4, .to_sun = {0.6f, 0.8f, 0}};
  Bed bed(s);
  bed.r.set_environment_sky(sky, 0.5f);
  const film::Image edited = test::finish(bed.r);
  s.environment = {.image = scene::Id(s.images.size()), .scale = 0.5f, .given = true, .sky = sky};
  s.images.push_back(scene::sky_image(sky));
  CHECK(test::identical(edited, picture(s)));
  // And back to its own.
  bed.r.set_environment_file("");
  CHECK_FALSE(bed.r.scene()->environment.sky);
}

TEST_CASE("a saved scene renders bit-identically") {
  const std::filesystem::path source = std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf";
  session::Renderer r(test::renderer_options(false));
  r.set_size(24, 24);
  r.settings().set("path.batch", "4096");
  r.load(source);
  std::vector<scene::Light> lights = r.scene()->lights;
  scene::Light spot = lamp("desk", {0.123f, 0.7f, 0.2f}, 0.371f, scene::k_first_added);
  spot.kind = scene::LightKind::spot, spot.intensity = {0.371f, 0.3f, 0.17f};
  spot.direction = vec3(glm::normalize(glm::dvec3(0.2, -1, 0.1)));
  lights.push_back(spot);
  r.set_light_list(lights);
  scene::Material painted = r.scene()->materials[0];
  painted.base_color = {0.123f, 0.456f, 0.789f, 1};
  r.set_material(0, painted);
  r.set_environment_sky({.turbidity = 5, .to_sun = {0, 1, 0}}, 0.01f);
  test::set(r, {{"samples", "4"}});
  const film::Image before = test::finish(r);
  test::Folder folder;
  for (const char* name : {"a.gltf", "b.glb"}) {
    INFO(name);
    scene::SaveRequest request{.loaded = r.loaded(), .edited = r.scene(), .file = folder / name};
    for (const auto& [key, value] : r.loaded()->settings) request.settings.emplace_back(key, value);
    scene::save(request);
    session::RendererOptions options = test::renderer_options(false);
    options.scenes.outside = true;  // the .gltf names the source's buffers
    session::Renderer again(options);
    again.set_size(24, 24);
    again.settings().set("path.batch", "4096");
    again.load(folder / name);
    test::set(again, {{"samples", "4"}});
    CHECK(test::identical(before, test::finish(again)));
  }
}

}  // namespace light_list_tests
