// links: session
// If applying a scene, settings, lights, a size or shaders fails – no memory at any point, a shader that does
// not compile – scene, settings, picture and records stay as they were, and the picture continues as if
// nothing had happened.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "base/file.h"
#include "images/cache_support.h"
#include "support/folder.h"
#include "support/rooms.h"

namespace strong_guarantee_tests {

using namespace lucerna;
using test::Settings;

namespace {

const Settings k_base = test::dense_records({{"components.secondary", "cache"},
                                             {"components.tertiary", "cache"},
                                             {"cache.rays", "64"},
                                             {"cache.max_rays", "64"},
                                             {"cache.error", "0.6"},
                                             {"cache.max_records", "1000"},
                                             {"cache.passes", "1"},
                                             {"samples", "4"},
                                             {"path.batch", "4096"}});

struct Bed {
  test::CacheRenderer shown{test::block_room(true), 16};
  Bed() {
    shown.set(k_base);
    // During a picture, with records.
    while (shown.r.samples() < 2) REQUIRE(shown.r.step());
  }
};

struct Action {
  const char* name;
  std::function<void(session::Renderer&)> run;
};

scene::Scene other_room() {
  scene::Scene s = test::block_room(true);
  s.name = "other";
  s.materials[0].emission = vec3(1);
  return s;
}

const std::vector<Action>& actions() {
  static const std::vector<Action> all{
      {"another scene",
       [](session::Renderer& r) { r.set_scene(std::make_shared<scene::Scene>(other_room())); }},
      {"a lamp switched off, so that kernels are made for no lamps",
       [](session::Renderer& r) {
         scene::Light lamp = r.scene()->lights[0];
         lamp.enabled = false;
         r.set_light(0, lamp);
       }},
      {"a material that glosses, which needs other kernels",
       [](session::Renderer& r) {
         scene::Material m = r.scene()->materials[0];
         m.metallic = 1, m.roughness = 0.3f, m.emission = vec3(0.1f);
         r.set_material(0, m);
       }},
      {"an object moved",
       [](session::Renderer& r) {
         mat4 there = r.scene()->instances[1].to_world;
         there[3].x += 0.5f;
         r.set_instances({{1, there}});
       }},
      {"the environment", [](session::Renderer& r) { r.set_environment(3, 10); }},
      {"tertiary light path traced",
       [](session::Renderer& r) {
         test::set(r, {{"components.tertiary", "path"}});
       }},
      {"another tracer",
       [](session::Renderer& r) {
         test::set(r, {{"tracer", "compute-bvh"}});
       }},
      {"the sky held by records",
       [](session::Renderer& r) {
         test::set(r, {{"components.primary", "cache"}});
       }},
      {"separate light groups, which need other films",
       [](session::Renderer& r) {
         test::set(r, {{"relight.enabled", "compact"}});
       }},
      {"a mix that changes the lights",
       [](session::Renderer& r) {
         test::set(r, {{"relight.mix", "sky: ev=1"}});
       }},
      {"lights and mix together",
       [](session::Renderer& r) { r.set_lights({.environment_scale = 0.5f, .mix = "sky: ev=2"}); }},
      {"another size", [](session::Renderer& r) { r.set_size(40, 24); }},
      {"the shaders again", [](session::Renderer& r) { r.reload_shaders(); }},
  };
  return all;
}

}  // namespace

TEST_CASE("if memory runs out at any point the state is unchanged") {
  Bed undisturbed;
  const film::Image wanted = undisturbed.shown.finish();
  const uint32_t records = undisturbed.shown.status().records;
  REQUIRE(records > 20);
  for (const Action& action : actions()) {
    INFO(action.name);
    Bed bed;
    session::Renderer& r = bed.shown.r;
    const auto scene = r.scene();
    const auto settings = r.settings().all();
    const uint64_t restarts = r.restarts();
    bool failed = true;
    size_t failures = 0;
    // Ever later points, until the change succeeds.
    for (uint64_t allowed = 0; failed && allowed < 4000; allowed += 1 + allowed / 6) {
      INFO("after " << allowed << " allocations");
      r.device().limit_allocations(allowed);
      try {
        action.run(r);
        failed = false;
      } catch (const Error& e) {
        ++failures;
        CHECK_THAT(e.what(), Catch::Contains("out of device memory"));
      }
      r.device().limit_allocations(std::nullopt);
      if (!failed) break;
      CHECK(r.scene() == scene);
      CHECK(r.settings().all() == settings);
      CHECK(r.restarts() == restarts);
      CHECK(r.samples() >= 2);
      REQUIRE(test::cache(r));
      CHECK(test::cache(r)->ready());
      CHECK(bed.shown.status().records == records);
      // Reading the picture does not fail either.
      CHECK(r.output().picture(false).size() == 16 * 16 * 4);
    }
    CHECK_FALSE(failed);
    CHECK(failures > 0);
  }
}

TEST_CASE("after a failure the picture continues, bit for bit") {
  Bed undisturbed;
  const film::Image wanted = undisturbed.shown.finish();
  for (const uint64_t allowed : {0, 1, 2, 4}) {
    Bed bed;
    session::Renderer& r = bed.shown.r;
    for (const Action& action : actions()) {
      INFO(action.name << ", after " << allowed << " allocations");
      r.device().limit_allocations(allowed);
      bool failed = false;
      try {
        action.run(r);
      } catch (const Error&) {
        failed = true;
      }
      r.device().limit_allocations(std::nullopt);
      REQUIRE(failed);
    }
    CHECK(test::identical(bed.shown.finish(), wanted));
  }
}

TEST_CASE("shaders that do not compile leave the kernels in use") {
  const test::Folder folder;
  const std::filesystem::path shaders = folder.path / "shaders";
  std::filesystem::copy(std::string(LUCERNA_SOURCE_DIR) + "/shaders", shaders,
                        std::filesystem::copy_options::recursive);
  const auto render = [&](const char* broken) {
    session::RendererOptions options = test::renderer_options();
    options.shaders = shaders;
    session::Renderer r(options);
    r.set_size(16, 16);
    r.set_scene(std::make_shared<scene::Scene>(test::block_room(true)));
    test::set(r, k_base);
    while (r.samples() < 2) REQUIRE(r.step());
    if (broken) {
      const std::filesystem::path file = shaders / broken;
      const std::string text = read_file(file);
      std::ofstream(file) << text << "\nvoid broken() { nonsense; }\n";
      const auto scene = r.scene();
      CHECK_THROWS_WITH(r.reload_shaders(), Catch::Contains("nonsense"));
      // Edits that need new kernels are refused too, and change nothing. No edit needs film kernels.
      if (!std::string_view(broken).starts_with("film/")) {
        scene::Material m = scene->materials[0];
        m.metallic = 1, m.roughness = 0.3f, m.emission = vec3(0.1f);
        CHECK_THROWS_WITH(r.set_material(0, m), Catch::Contains("nonsense"));
        CHECK(r.scene() == scene);
        CHECK_THROWS(test::set(r, {{"cache.metric", "split-sphere"}}));
        CHECK(r.settings().text("cache.metric") == "hessian");
      }
      std::ofstream(file) << text;
    }
    return test::finish(r);
  };
  {
    // The window's preview has kernels too, which are reloaded with the others.
    session::RendererOptions options = test::renderer_options();
    options.shaders = shaders, options.interactive = true;
    session::Renderer r(options);
    r.set_size(16, 16);
    r.set_scene(std::make_shared<scene::Scene>(test::block_room(true)));
    const std::filesystem::path file = shaders / "film/preview_resolve.comp";
    const std::string text = read_file(file);
    std::ofstream(file) << text << "\nvoid broken() { nonsense; }\n";
    CHECK_THROWS_WITH(r.reload_shaders(), Catch::Contains("nonsense"));
    CHECK(r.output().shown_picture(true).size() == 16 * 16 * 4);
    std::ofstream(file) << text;
    CHECK_NOTHROW(r.reload_shaders());
    CHECK(r.output().shown_picture(true).size() == 16 * 16 * 4);
  }
  {
    // So does the first scene; without it, no film is left behind.
    session::RendererOptions options = test::renderer_options();
    options.shaders = shaders, options.interactive = true;
    session::Renderer r(options);
    r.set_size(16, 16);
    const auto scene = std::make_shared<scene::Scene>(test::block_room(true));
    const std::filesystem::path file = shaders / "film/preview_resolve.comp";
    const std::string text = read_file(file);
    std::ofstream(file) << text << "\nvoid broken() { nonsense; }\n";
    CHECK_THROWS_WITH(r.set_scene(scene), Catch::Contains("nonsense"));
    CHECK_FALSE(r.ready());
    CHECK(r.scene() == nullptr);
    std::ofstream(file) << text;
    r.set_size(24, 24);
    r.set_scene(scene);
    CHECK(r.output().picture(true).size() == 24 * 24 * 4);
  }
  const film::Image wanted = render(nullptr);
  for (const char* broken : {"transport/shade.comp", "irradiance_cache/radius.comp", "film/tonemap.comp"}) {
    INFO(broken);
    CHECK(test::identical(render(broken), wanted));
  }
}

}  // namespace strong_guarantee_tests
