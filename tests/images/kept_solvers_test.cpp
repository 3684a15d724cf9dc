// links: session
// Work of solvers that are deselected and later selected again: changes in between decide how much of it
// stays valid.
#include <catch2/catch.hpp>

#include "images/cache_support.h"
#include "support/caustics.h"
#include "support/rooms.h"

namespace kept_solvers_tests {

using namespace lucerna;
using test::begins_with, test::identical, test::Settings;

namespace {

const Settings k_base = test::dense_records({{"components.tertiary", "cache"},
                                             {"cache.rays", "64"},
                                             {"cache.max_rays", "256"},
                                             {"cache.error", "0.6"},
                                             {"cache.max_records", "5000"},
                                             {"cache.irradiance_weight", "0"},
                                             {"cache.metric", "split-sphere"},
                                             {"samples", "2"}});
const Settings k_path{{"components.tertiary", "path"}}, k_cache{{"components.tertiary", "cache"}};

/// A picture by solvers that prepare something before its first sample.
struct Prepared {
  session::Renderer r{test::renderer_options()};
  Prepared(const scene::Scene& scene, const Settings& settings) {
    r.settings().set("path.batch", test::k_batch);
    r.set_size(24, 24);
    r.set_scene(std::make_shared<scene::Scene>(scene));
    set(settings);
  }
  void set(const Settings& settings) { test::set(r, settings); }
  film::Image finish() { return test::finish(r); }
  /// Whether more is missing than to read what there is, which takes one step.
  bool prepares() {
    if (r.preparing()) r.step();
    return r.preparing();
  }
};

struct Choice {
  const char* what;
  scene::Scene scene;
  Settings settings, away;
};
std::vector<Choice> choices() {
  const Settings caustics{{"components.caustic", "photons"}, {"samples", "4"}};
  const Settings gathered{
      {"components.tertiary", "photons"}, {"samples", "4"}, {"photons.efficiency", "false"}};
  return {
      {"photons", test::turned_sun(), caustics, {{"components.caustic", "path"}}},
      {"photons", test::turned_sun(), caustics, {{"components.caustic", "off"}}},
      // Another task, for which photons are sent in another way.
      {"photons", test::turned_sun(), caustics, {{"components.secondary", "photons"}}},
      // Photons of the same task, in other kernels.
      {"photons", test::turned_sun(), caustics, {{"components.secondary", "cache"}, {"cache.rays", "64"}}},
      {"photons", test::block_room(true), gathered, {{"components.tertiary", "path"}}},
      {"light",
       test::turned_sun(),
       test::with(caustics, {{"components.caustic", "light"}}),
       {{"components.caustic", "path"}}}};
}

/// What `settings` change, set back to what the renderer has now.
Settings undoing(const session::Renderer& r, const Settings& settings) {
  Settings before;
  for (const auto& [key, value] : settings) before[key] = r.settings().text(key);
  return before;
}

}  // namespace

TEST_CASE("a cache that is switched off is reused when it is switched on") {
  test::CacheRenderer bed(test::block_room(true), 24);
  bed.set(k_base);
  const film::Image first = bed.finish();
  const irradiance_cache::RawRecords records = bed.records();
  const uint64_t rays = bed.status().rays;
  REQUIRE(records.size() > 20);

  bed.set(k_path);
  REQUIRE(bed.r.solver("cache") == nullptr);
  bed.finish();
  bed.set({{"film.ev", "1"}, {"samples", "3"}});
  bed.set({{"film.ev", "0"}, {"samples", "2"}});
  bed.set(k_cache);
  CHECK_FALSE(bed.r.preparing());
  CHECK(identical(bed.records(), records));
  const film::Image second = bed.finish();
  CHECK(bed.status().rays == rays);
  for (const int c : k_components) CHECK(second.components[c] == first.components[c]);
}

TEST_CASE("changes made while a cache is off invalidate the same parts as always") {
  test::CacheRenderer bed(test::block_room(true), 24);
  bed.set(k_base);
  bed.finish();
  const irradiance_cache::RawRecords records = bed.records();

  // Other light: positions stay, and the light is that of a new cache.
  bed.set(k_path);
  scene::Light lamp = bed.r.scene()->lights[0];
  lamp.intensity = {9, 2, 1};
  bed.r.set_light(0, lamp);
  bed.set(k_cache);
  CHECK(bed.r.preparing());
  const film::Image relit = bed.finish();
  CHECK(test::keeps_places(test::lit(bed.records()), test::lit(records)));
  {
    test::CacheRenderer fresh(test::block_room(true), 24);
    fresh.r.set_light(0, lamp);
    fresh.set(k_base);
    const film::Image expected = fresh.finish();
    CHECK(test::mean(relit.components[2]) == Approx(test::mean(expected.components[2])).epsilon(0.02));
  }
  // Another seed gives another cache.
  bed.set(k_path);
  bed.set({{"seed", "7"}});
  bed.set(k_cache);
  bed.finish();
  CHECK_FALSE(identical(bed.records(), records));
  // Shader reloads and scenes.
  for (const bool scene : {false, true}) {
    bed.set(k_path);
    if (scene)
      bed.r.set_scene(std::make_shared<scene::Scene>(test::block_room(true)));
    else
      bed.r.reload_shaders();
    bed.set(k_base);
    CHECK(bed.r.preparing());
    CHECK(bed.records().size() == 0);
  }
}

TEST_CASE("a solver that was put aside works on where it was, and the picture is the same to the bit") {
  for (const Choice& choice : choices()) {
    const auto& [key, value] = *choice.away.begin();
    INFO(choice.what << ", " << key << "=" << value);
    Prepared bed(choice.scene, choice.settings);
    REQUIRE(bed.prepares());
    const film::Image first = bed.finish();
    const Settings back = undoing(bed.r, choice.away);
    bed.set(choice.away);
    bed.finish();
    // Undone while it is aside, or with it: only what differs in the end counts.
    const Settings more{{"photons.radius", "3"}, {"light.per_round", "20000"}, {"film.ev", "1"}};
    const Settings and_back = test::with(back, undoing(bed.r, more));
    bed.set(more);
    bed.set(and_back);
    CHECK_FALSE(bed.prepares());
    CHECK(identical(bed.finish(), first));
  }
}

TEST_CASE("of photons that were put aside nothing counts that another light, view or setting has made") {
  const Settings settings{{"components.caustic", "photons"}, {"samples", "4"}};
  const Settings away{{"components.caustic", "path"}}, back{{"components.caustic", "photons"}};
  Prepared bed(test::turned_sun(), settings);
  bed.finish();
  const auto check_fresh = [&](const Settings& changed) {
    bed.set(back);
    CHECK(bed.r.preparing());
    const film::Image image = bed.finish();
    Prepared fresh(*bed.r.scene(), test::with(settings, changed));
    fresh.r.set_camera(bed.r.camera());
    CHECK(identical(image, fresh.finish()));
  };
  {
    INFO("a lamp");
    bed.set(away);
    scene::Light lamp = bed.r.scene()->lights[0];
    lamp.intensity = {9, 2, 1};
    lamp.direction = glm::normalize(vec3(1, 0.1f, 0));
    bed.r.set_light(0, lamp);
    check_fresh({});
  }
  {
    INFO("a material");
    bed.set(away);
    scene::Material mirror = bed.r.scene()->materials[1];
    mirror.roughness = 0.3f;
    bed.r.set_material(1, mirror);
    check_fresh({});
  }
  {
    INFO("the camera");
    bed.set(away);
    scene::Camera camera = bed.r.camera();
    camera.to_world[3] += vec4(0.1f, 0, 0.05f, 0);
    bed.r.set_camera(camera);
    check_fresh({});
  }
  {
    INFO("a setting");
    bed.set(away);
    bed.set({{"photons.per_round", "20000"}});
    check_fresh({{"photons.per_round", "20000"}});
  }
}

TEST_CASE("records of a setting that is undone are there again") {
  test::CacheRenderer bed(test::block_room(true), 24);
  bed.set(k_base);
  const film::Image first = bed.finish();
  const irradiance_cache::RawRecords records = bed.records();
  bed.set({{"cache.min_radius", "8"}});
  CHECK(bed.r.preparing());
  bed.finish();
  REQUIRE_FALSE(identical(bed.records(), records));
  bed.set({{"cache.min_radius", "3"}});
  CHECK_FALSE(bed.r.preparing());
  CHECK(identical(bed.records(), records));
  CHECK(identical(bed.finish(), first));
}

TEST_CASE("a restart by hand makes everything from scratch, whatever was put aside") {
  const Settings settings{{"components.caustic", "photons"}, {"samples", "2"}};
  Prepared bed(test::turned_sun(), settings);
  bed.finish();
  bed.set({{"components.caustic", "path"}});
  bed.r.restart();
  bed.set({{"components.caustic", "photons"}});
  CHECK(bed.r.preparing());
}

}  // namespace kept_solvers_tests
