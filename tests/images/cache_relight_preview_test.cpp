// links: session
// What the window shows while records are relit: after a few preview samples it is close to the final
// picture, immediately if the effect of the edit on light is known. Relighting does not depend on it.
#include <catch2/catch.hpp>

#include "images/cache_support.h"
#include "support/rooms.h"

namespace cache_relight_preview_tests {

using namespace lucerna;
using irradiance_cache::Cache;
using irradiance_cache::RawRecords;
using test::begins_with, test::Settings;

namespace {

const Settings k_base = test::dense_records({{"components.secondary", "cache"},
                                             {"components.tertiary", "cache"},
                                             {"components.primary", "off"},
                                             {"cache.rays", "64"},
                                             {"cache.max_rays", "256"},
                                             {"cache.error", "0.4"},
                                             {"cache.gather", "false"},
                                             {"cache.max_records", "5000"},
                                             {"samples", "2"},
                                             {"path.batch", "8192"}});

/// A renderer as in the window, step by step.
struct Bed {
  session::Renderer r;
  explicit Bed(bool interactive, const char* metric)
      : r([&] {
          session::RendererOptions o = test::renderer_options(true);
          o.interactive = interactive;
          return o;
        }()) {
    r.set_size(32, 32);
    r.settings().set("path.batch", "8192");
    r.set_scene(std::make_shared<scene::Scene>(test::block_room(true)));
    Settings all = k_base;
    all["cache.metric"] = metric;
    test::set(r, all);
    test::finish(r);
  }
  ~Bed() { CHECK(r.device().validation_messages() == 0); }
  Cache& cache() { return *const_cast<Cache*>(test::cache(r)); }
  RawRecords records() { return cache().records().raw(cache().records().size()); }
  void set_lamp(vec3 intensity, vec3 position) {
    scene::Light lamp = r.scene()->lights[0];
    lamp.intensity = intensity, lamp.position = position;
    r.set_light(0, lamp);
  }
  /// Draws preview samples before the work continues; returns their number.
  int draw_drafts(int most = 6) {
    int drawn = 0;
    while (drawn < most && r.previews().draw()) ++drawn;
    return drawn;
  }
  /// Mean of the displayed picture, 0..1, encoded.
  double shown() {
    const std::vector<uint8_t> rgba = r.output().shown_picture(r.samples() == 0);
    double sum = 0;
    for (size_t i = 0; i < rgba.size(); i += 4) sum += rgba[i] + rgba[i + 1] + rgba[i + 2];
    return sum / (255.0 * 3 / 4 * double(rgba.size()));
  }
};

}  // namespace

TEST_CASE("the result of relighting does not depend on the preview, bit for bit") {
  for (const char* metric : {"split-sphere", "hessian"}) {
    INFO(metric);
    Bed window(true, metric), batch(false, metric);
    REQUIRE(begins_with(window.records(), batch.records()));
    int round = 0;
    for (const vec3 position : {vec3(-1.2f, 1.5f, 0.6f), vec3(0.8f, 1.6f, -0.4f), vec3(0, 1, 0)}) {
      for (Bed* bed : {&window, &batch}) bed->set_lamp(vec3(2, 5, 9), position);
      if (round != 1) CHECK(window.draw_drafts() >= 3);
      // In the second round the next edit comes during relighting.
      for (int step = 0; step < (round == 1 ? 40 : 0); ++step) {
        window.r.previews().draw();
        window.r.step();
        window.shown();
      }
      if (++round == 2) continue;
      const film::Image a = test::finish(window.r), b = test::finish(batch.r);
      if (round == 1) {
        CHECK(test::identical(a, b));
        CHECK(begins_with(window.records(), batch.records()));
        CHECK(window.records().size() == batch.records().size());
      }
      CHECK_FALSE(window.cache().previews_relighting());
    }
  }
}

TEST_CASE("after an edit the window shows the new light long before records are relit") {
  Bed bed(true, "hessian");
  const double before = bed.shown();
  // Twice as bright and in another position.
  bed.set_lamp(vec3(14), {-1.2f, 1.5f, 0.6f});
  REQUIRE_FALSE(bed.cache().ready());
  REQUIRE(bed.cache().status().relighting.share == 0);
  // At first the previous picture is shown.
  CHECK(bed.shown() == Approx(before).epsilon(0.02));
  CHECK(bed.r.output().preview_shares().stale > 0.95);
  const uint64_t rays = bed.cache().status().rays;
  CHECK(bed.draw_drafts() >= 3);
  for (int i = 0; i < 12; ++i) bed.r.previews().draw(), bed.r.step();
  const double early = bed.shown();
  CHECK(bed.cache().status().relighting.share < 1);
  INFO("before " << before << ", early " << early << ", rays of relighting " << rays);
  test::finish(bed.r);
  const double finally = bed.shown();
  INFO("finally " << finally);
  REQUIRE(std::abs(finally - before) > 0.1 * before);
  CHECK(early == Approx(finally).epsilon(0.06));
}

TEST_CASE("a few preview samples show the final brightness, whatever has changed") {
  Bed bed(true, "hessian");
  auto scene = std::make_shared<scene::Scene>(*bed.r.scene());
  scene->lights.push_back(scene->lights[0]);
  scene->lights[1].intensity *= 0.2f;
  scene->lights[1].position = {0.8f, 1.6f, -0.4f};
  bed.r.set_scene(scene);
  bed.r.set_size(96, 96);
  Settings fine = k_base;
  fine["cache.error"] = "0.15";
  test::set(bed.r, fine);
  test::finish(bed.r);
  const double before = bed.shown();
  // One of two lamps is dimmed to a sixth: the effect on the total light is unknown.
  bed.set_lamp(scene->lights[0].intensity / 6.0f, scene->lights[0].position);
  CHECK_FALSE(bed.cache().previews_relighting());
  CHECK(bed.draw_drafts() >= 4);
  CHECK(bed.cache().status().relighting.share == 0);
  const double early = bed.shown();
  test::finish(bed.r);
  const double finally = bed.shown();
  INFO("before " << before << ", early " << early << ", finally " << finally);
  CHECK(before > 1.3 * finally);  // as encoded
  CHECK(early == Approx(finally).epsilon(0.08));
}

TEST_CASE("a lamp that makes a second light group leaves the picture until it shines") {
  Bed bed(true, "hessian");
  bed.r.set_scene(std::make_shared<scene::Scene>(test::block_room()));
  bed.r.set_size(96, 96);
  test::set(bed.r, {{"components.primary", "path"},
                    {"components.secondary", "path"},
                    {"components.tertiary", "path"},
                    {"samples", "16"}});
  for (const bool filtered : {false, true}) {
    INFO((filtered ? "filtered" : "unfiltered"));
    test::finish(bed.r);
    if (filtered) {
      while (bed.r.output().filter_due()) bed.r.output().step_filter({});
      bed.shown();
      REQUIRE(bed.r.output().preview_shares().filtered > 0.5);
    }
    const double before = bed.shown();
    std::vector<scene::Light> lights = bed.r.scene()->lights;
    lights.push_back(lights[0]);
    lights.back().intensity *= 0.01f, lights.back().group = filtered ? "first" : "second";
    bed.r.set_light_list(lights);
    CHECK(bed.shown() == Approx(before).epsilon(2e-4));
  }
}

TEST_CASE("a picture of almost no light is none of the light that returns") {
  Bed bed(true, "hessian");
  bed.r.set_scene(std::make_shared<scene::Scene>(test::block_room()));  // no sky
  bed.r.set_size(96, 96);
  test::set(bed.r, {{"components.primary", "path"},
                    {"components.secondary", "path"},
                    {"components.tertiary", "path"},
                    {"samples", "4"}});
  const scene::Light lamp = bed.r.scene()->lights[0];
  for (const float dimmed : {0.2f, 1e-4f}) {
    bed.set_lamp(lamp.intensity * dimmed, lamp.position);
    test::finish(bed.r);
    bed.shown();
    bed.set_lamp(lamp.intensity, lamp.position);
    while (bed.r.samples() < 1) REQUIRE(bed.r.step());
    bed.shown();
    INFO("dimmed to " << dimmed << ": " << bed.r.output().preview_shares().stale << " from before");
    CHECK((bed.r.output().preview_shares().stale > 0.5) == (dimmed > 0.1f));
  }
}

TEST_CASE("a lamp in its own group is dimmed and tinted in the preview immediately, without a ray") {
  Bed bed(true, "hessian");
  auto scene = std::make_shared<scene::Scene>(*bed.r.scene());
  scene->lights.push_back(scene->lights[0]);
  scene->lights[0].name = "lamp", scene->lights[1].name = "other";
  scene->lights[1].intensity *= 0.2f;
  scene->lights[1].position = {0.8f, 1.6f, -0.4f};
  bed.r.set_scene(scene);
  Settings fine = k_base;
  fine["cache.error"] = "0.15";
  test::set(bed.r, fine);
  test::finish(bed.r);
  REQUIRE(bed.r.relight().separate);
  const double before = bed.shown();
  bed.set_lamp(scene->lights[0].intensity * vec3(0.1f, 0.3f, 0.2f), scene->lights[0].position);
  // The previous picture is shown with the new mix, and so are records.
  const double recalled = bed.shown();
  CHECK(bed.cache().previews_relighting());
  CHECK(bed.cache().status().relighting.share == 0);
  for (int i = 0; i < 3; ++i) bed.r.previews().draw();
  const double drafted = bed.shown();
  // Nothing is lost when the next edit comes before records are relit.
  bed.set_lamp(scene->lights[0].intensity * 0.5f, scene->lights[0].position);
  bed.set_lamp(scene->lights[0].intensity * vec3(0.1f, 0.3f, 0.2f), scene->lights[0].position);
  for (int i = 0; i < 3; ++i) bed.r.previews().draw();
  const double again = bed.shown();
  test::finish(bed.r);
  const double finally = bed.shown();
  INFO("before " << before << ", recalled " << recalled << ", drafted " << drafted << ", again " << again
                 << ", finally " << finally);
  CHECK(before > 1.3 * finally);  // as encoded
  CHECK(recalled == Approx(finally).epsilon(0.01));
  CHECK(drafted == Approx(finally).epsilon(0.03));
  CHECK(again == Approx(finally).epsilon(0.03));
}

TEST_CASE("after a switch of solvers the preview starts from the previous picture") {
  Bed bed(true, "hessian");
  const double before = bed.shown();
  for (const auto& [key, value] : Settings{{"components.secondary", "path"},
                                           {"components.tertiary", "path"},
                                           {"cache.error", "0.3"},
                                           {"components.secondary", "cache"},
                                           {"seed", "7"}}) {
    INFO(key << " " << value);
    test::set(bed.r, {{key, value}});
    CHECK(bed.r.samples() == 0);
    for (int i = 0; i < 3; ++i) {
      bed.r.previews().draw();
      CHECK(bed.shown() == Approx(before).epsilon(0.05));
      CHECK(bed.r.output().preview_shares().stale > 0.5);
    }
  }
  // Switching a component off is a different light.
  test::set(bed.r, {{"components.tertiary", "off"}});
  for (int i = 0; i < 40 && bed.r.samples() == 0; ++i) bed.r.previews().draw(), bed.r.step();
  test::finish(bed.r);
  CHECK(bed.shown() < 0.9 * before);
}

TEST_CASE("an edit taken back shows the picture from before it at once, and again after that") {
  Bed bed(true, "hessian");
  test::set(bed.r, {{"components.primary", "path"}, {"samples", "16"}});
  test::finish(bed.r);
  const auto picture = [&] { return bed.r.output().shown_picture(bed.r.samples() == 0); };
  const auto difference = [](const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::abs(int(a[i]) - int(b[i]));
    return sum / double(a.size());
  };
  const vec3 intensity = bed.r.scene()->lights[0].intensity, position = bed.r.scene()->lights[0].position;
  const std::vector<uint8_t> before = picture();
  // Seen briefly, or until it is a picture of its own; by way of other places.
  for (const bool settled : {false, true}) {
    INFO((settled ? "a finished picture" : "few samples"));
    for (const float x : {0.2f, 0.4f, 0.5f}) {
      bed.set_lamp(0.4f * intensity, position + vec3(x, 0, 0));
      bed.draw_drafts();
      picture();
    }
    if (settled) test::finish(bed.r);
    const std::vector<uint8_t> edited = picture();
    const double change = difference(edited, before);
    CHECK(change > 4);
    bed.set_lamp(intensity, position);
    bed.draw_drafts();
    CHECK(difference(picture(), before) < 0.15 * change);
    CHECK(bed.r.output().preview_shares().stale > 0.8);
    if (!settled) continue;
    // Done again: the finished picture of the edit.
    bed.set_lamp(0.4f * intensity, position + vec3(0.5f, 0, 0));
    bed.draw_drafts();
    CHECK(difference(picture(), edited) < 0.15 * change);
  }
}

TEST_CASE("batch rendering has no preview samples and no preview light") {
  Bed batch(false, "hessian");
  batch.set_lamp(vec3(1), vec3(0, 1, 0));
  CHECK_FALSE(batch.cache().previews_relighting());
  CHECK_FALSE(batch.r.previews().draw());
  CHECK(batch.r.output().preview_shares().stale == 0);
}

}  // namespace cache_relight_preview_tests
