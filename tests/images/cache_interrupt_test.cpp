// links: session
// Edits while an irradiance cache is being built, as when a user drags a lamp: every kind of edit at every
// stage of every pass, and a long seeded run of all kinds. The final picture is that of the edited scene, and
// no intermediate picture shows invalid data.
#include <catch2/catch.hpp>
#include <random>

#include "images/cache_support.h"
#include "support/rooms.h"

namespace cache_interrupt_tests {

using namespace lucerna;
using test::Settings;

namespace {

/// All overlays that read data under construction.
const Settings k_shown = test::dense_records({{"components.secondary", "cache"},
                                              {"components.tertiary", "cache"},
                                              {"cache.rays", "64"},
                                              {"cache.max_rays", "256"},
                                              {"cache.error", "0.6"},
                                              {"cache.max_records", "2000"},
                                              {"cache.passes", "2"},
                                              {"samples", "1"},
                                              {"overlay.records", "true"},
                                              {"overlay.normals", "true"},
                                              {"overlay.overlap", "true"},
                                              {"overlay.placement", "stage"},
                                              {"overlay.discontinuity", "irradiance"}});

struct Bed {
  session::Renderer r;
  const scene::Scene before = room();

  /// The room has a second lamp, an emissive and a glossy surface in every state, so edits compile no new
  /// kernels except the kinds that are meant to.
  static scene::Scene room() {
    scene::Scene s = test::block_room(true);
    s.lights.push_back(s.lights[0]);
    s.lights[1].name = "other", s.lights[1].intensity = vec3(1), s.lights[1].position.x = -1;
    s.materials.push_back(test::diffuse({0.5f, 0.5f, 0.5f}, vec3(1)));
    s.materials[2].metallic = 0.5f;
    test::add_quad(s, {1, 1, -1.9f}, {0.3f, 0, 0}, {0, 0.3f, 0}, 2);
    return s;
  }

  /// `validation`: takes twice as long.
  explicit Bed(bool validation = false) : r(test::renderer_options(validation, {}, true)) {
    r.set_size(16, 16);
    r.settings().set("path.batch", "4096");
    r.set_scene(std::make_shared<scene::Scene>(before));
    test::set(r, k_shown);
    r.overlays().inspect(vec2(0.4f, 0.6f));
  }
  ~Bed() { CHECK(r.device().validation_messages() == 0); }

  /// The edits, each with a strength that makes it different.
  static constexpr int k_kinds = 10;
  static const char* name(int kind) {
    constexpr const char* k_names[k_kinds] = {"lamp",     "lamp off", "environment", "colour",  "mirror",
                                              "emission", "camera",   "size",        "setting", "kernels"};
    return k_names[kind];
  }
  void edit(int kind, float by) {
    scene::Light lamp = before.lights[0];
    scene::Material material = before.materials[1];
    switch (kind) {
      case 0:
        lamp.intensity = vec3(1 + by), lamp.position.x = 0.3f * by;
        return r.set_light(0, lamp);
      case 1:
        lamp.enabled = false;
        return r.set_light(0, lamp);
      case 2:
        return r.set_environment(by, 30 * by);
      case 3:
        material.base_color = vec4(0.1f + 0.1f * by, 0.3f, 0.2f, 1);
        return r.set_material(1, material);
      case 4:
        material.metallic = 1;
        return r.set_material(1, material);
      case 5:
        material.emission = vec3(by);
        return r.set_material(1, material);
      case 6:
        return r.choose_camera(by > 2 ? "above" : "front");
      case 7:
        return r.set_size(16 + 8 * uint32_t(by), 16);
      case 8:
        return test::set(r, {{"cache.noise", by > 2 ? "0.2" : "0.03"}});
      default:
        return test::set(r, {{"sampling.coherent", by > 2 ? "true" : "false"}});
    }
  }
  void undo() {
    r.set_light(0, before.lights[0]);
    r.set_environment(1, 0);
    r.set_material(1, before.materials[1]);
    r.choose_camera("front");
    r.set_size(16, 16);
  }

  /// Reads picture and report as the window does: both are valid.
  void watch() {
    REQUIRE(r.output().picture(false).size() == size_t{4} * r.film().width() * r.film().height());
    const auto report = test::cache_report(r);
    REQUIRE(report);
    const irradiance_cache::CacheStatus& s = report->status;
    CHECK(s.records <= test::cache(r)->records().size());
    for (const irradiance_cache::Record& record : test::cache(r)->records().read())
      REQUIRE(std::isfinite(record.radius));
  }

  /// Builds to the end and renders; all pixels are finite.
  void finish() {
    test::set(r, {{"cache.pause", "off"}});
    const film::Image image = test::finish(r);
    REQUIRE(test::cache(r)->ready());
    for (const auto& component : image.components)
      for (const vec3& v : component) REQUIRE((v.x >= 0 && v.x < 1e4f && v.y >= 0 && v.z >= 0));
  }

  /// ... and has the light of that picture. Uncovered points are path traced, with the noise of 64 samples of
  /// 256 pixels.
  void finish_as(const film::Image& complete) {
    finish();
    watch();
    const film::Image image = r.image();
    for (const int c : {0, 1, 2})
      CHECK(test::mean(image.components[c]) == Approx(test::mean(complete.components[c])).epsilon(0.06));
  }
};

/// The current build stage, to locate a failure.
std::string where(const session::Renderer& r) {
  const irradiance_cache::CacheStatus& s = test::cache(r)->status();
  return s.last ? irradiance_cache::stage_words(*s.last) : "the beginning";
}

void edit_at_random(Bed& bed, int edits, uint32_t seed) {
  session::Renderer& r = bed.r;
  std::mt19937 random(seed);
  const auto below = [&](uint32_t n) { return uint32_t(random() % n); };
  for (int i = 0; i < edits; ++i) {
    const int kind = i % 25 == 24 ? 9 : int(below(9));
    INFO("edit " << i << ", " << Bed::name(kind) << ", after " << where(r));
    bed.edit(kind, float(below(4)));
    for (uint32_t piece = below(6); piece > 0; --piece) r.step();
    if (below(6) == 0) bed.watch();
  }
}

}  // namespace

TEST_CASE("an edit at any stage of the build is followed by a valid build") {
  Bed bed;
  session::Renderer& r = bed.r;
  uint32_t interrupted = 0;
  for (int kind = 0; kind < Bed::k_kinds; ++kind) {
    // As many stages as a build has; the last edit finds a finished cache. Kernels take long to compile.
    for (int stages = 1; stages < 40; stages += kind == 9 ? 4 : 1) {
      bed.undo();
      test::set(r, {{"cache.pause", "stage"}, {"cache.noise", "0.03"}});
      r.restart();
      for (int stage = 0; stage < stages && !test::cache(r)->ready(); ++stage) {
        while (r.step()) {
        }
        if (stage + 1 < stages) r.solvers().command("cache", "step");
      }
      INFO("a change of " << Bed::name(kind) << " after " << where(r));
      const bool complete = test::cache(r)->ready();
      bed.edit(kind, 5);
      bed.watch();
      r.solvers().command("cache", "step");
      for (int piece = 0; piece < 3; ++piece) r.step();
      ++interrupted;
      if (complete) break;
    }
    bed.finish();
    bed.watch();
  }
  // Two passes of about six stages each, for every kind.
  CHECK(interrupted > 9 * Bed::k_kinds);
}

TEST_CASE("no validation errors while a cache is built and edited") {
  Bed bed(true);
  edit_at_random(bed, 40, 8);
  bed.finish();
}

TEST_CASE("three hundred edits during a build end in the picture of the edited scene") {
  Bed bed;
  session::Renderer& r = bed.r;
  edit_at_random(bed, 300, 7);
  bed.undo();
  // The same scene with a new cache: secondary and tertiary light agree up to the positions of records.
  test::set(r, {{"cache.rays", "1024"}, {"cache.max_rays", "1024"}, {"samples", "64"}});
  bed.finish();
  const film::Image lived = r.image();
  r.restart();
  bed.finish();
  const film::Image fresh = r.image();
  for (const int c : {0, 1, 2}) {
    INFO("component " << c);
    CHECK(test::mean(lived.components[c]) == Approx(test::mean(fresh.components[c])).epsilon(0.05));
  }
}

TEST_CASE("a cache build can finish early at any time, and the picture is that of a complete one") {
  Bed bed;
  session::Renderer& r = bed.r;
  test::set(r, {{"samples", "64"}});
  bed.finish();
  const film::Image complete = r.image();
  const uint32_t records = test::cache(r)->status().records;
  uint32_t none = 0, some = 0, stage = 0;
  for (bool ready = false; !ready; ++stage) {
    test::set(r, {{"cache.pause", "stage"}});
    r.restart();
    for (uint32_t i = 0; i <= stage; ++i) {
      while (r.step()) {
      }
      if (i < stage) r.solvers().command("cache", "step");
    }
    INFO("after " << where(r));
    ready = test::cache(r)->ready();
    const irradiance_cache::CacheStatus& s = test::cache(r)->status();
    // After a first level its records are complete but for the octree.
    const bool evaluated = s.last->stage == irradiance_cache::BuildStage::evaluate && s.last->level == 1;
    const uint32_t before = evaluated ? test::cache(r)->records().size() : s.records;
    r.solvers().finish_early();
    REQUIRE(test::cache(r)->ready() == !evaluated);
    if (evaluated) REQUIRE(r.step());
    REQUIRE(test::cache(r)->ready());
    CHECK((s.stop == irradiance_cache::StopReason::finished_early) == !ready);
    CHECK(s.records == before);
    CHECK((r.solvers().statistics().at("cache").at("stopped_by") == "finished early") == !ready);
    CHECK(test::cache(r)->records().size() == before);
    if (ready) break;
    ++(before == 0 ? none : some);
    bed.finish_as(complete);
    // The next light edit relights the existing records.
    bed.edit(0, 0);
    bed.watch();
    bed.undo();
  }
  CHECK(none >= 4);
  CHECK(some >= 4);
  CHECK(records > 0);
}

TEST_CASE("a build that ends within a first level of rays keeps the records that have them") {
  Bed bed;
  session::Renderer& r = bed.r;
  test::set(r, {{"samples", "64"}});
  bed.finish();
  const film::Image complete = r.image();
  for (const uint32_t pass : {0u, 1u}) {
    r.restart();
    const irradiance_cache::CacheStatus& s = test::cache(r)->status();
    const auto thinned = [&] {
      return s.last && s.last->stage == irradiance_cache::BuildStage::thin && s.last->pass == pass;
    };
    while (!thinned()) REQUIRE(r.step());
    const uint32_t before = s.records, placed = test::cache(r)->records().size();
    const uint64_t rays = s.rays;
    while (s.rays == rays) REQUIRE(r.step());  // until a batch of records has its rays
    REQUIRE(thinned());
    r.solvers().finish_early();
    while (!test::cache(r)->ready()) REQUIRE(r.step());
    INFO("pass " << pass << ": " << before << " records, " << s.records << " of " << placed);
    CHECK(s.stop == irradiance_cache::StopReason::finished_early);
    CHECK(s.records == test::cache(r)->records().size());
    CHECK(s.records > before);
    CHECK(s.records < placed);
    CHECK(s.passes.back().records == s.records - before);
    for (const irradiance_cache::Record& record : test::cache(r)->records().read()) {
      CHECK(record.rays >= 64);
      CHECK(record.radius > 0);
    }
    bed.finish_as(complete);
    // An edit relights these records and completes the build.
    bed.edit(0, 0);
    bed.finish();
    CHECK(test::cache(r)->status().records > 0);
    bed.undo();
  }
}

TEST_CASE("moving a lamp during the first pass discards only the work that used its light") {
  for (const char* metric : {"split-sphere", "hessian"}) {
    Bed bed;
    session::Renderer& r = bed.r;
    test::set(r, {{"cache.metric", metric}, {"cache.pause", "stage"}});
    // Passes that have evaluated their first level have records, which are relit.
    for (int stages = 1; stages <= 4; ++stages) {
      bed.undo();
      test::set(r, {{"cache.pause", "stage"}});
      r.restart();
      for (int stage = 0; stage < stages; ++stage) {
        while (r.step()) {
        }
        if (stage + 1 < stages) r.solvers().command("cache", "step");
      }
      // Also some steps into the next pass.
      test::set(r, {{"cache.pause", "off"}});
      r.step();
      INFO(metric << ", after " << where(r));
      REQUIRE(test::cache(r)->status().records == 0);
      const uint32_t candidates = test::cache(r)->status().passes.back().candidates;
      CHECK(candidates > 0);
      bed.edit(0, 3);
      const irradiance_cache::CacheStatus& s = test::cache(r)->status();
      REQUIRE(s.passes.size() == 1);
      CHECK(s.passes.back().candidates == candidates);
      bed.finish();
      const irradiance_cache::RawRecords lived =
          test::cache(r)->records().raw(test::cache(r)->records().size());
      r.restart();
      bed.finish();
      const irradiance_cache::RawRecords fresh =
          test::cache(r)->records().raw(test::cache(r)->records().size());
      CHECK(lived.size() == fresh.size());
      CHECK(test::begins_with(lived, fresh));
    }
  }
}

}  // namespace cache_interrupt_tests
