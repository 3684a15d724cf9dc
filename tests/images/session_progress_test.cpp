// links: session
// Progress while light is prepared: the completed share, the time that path tracing would take, and whether
// the displayed picture must be updated.
#include <catch2/catch.hpp>

#include "images/cache_support.h"
#include "support/rooms.h"

namespace session_progress_tests {

using namespace lucerna;
using test::Settings;

namespace {

const Settings k_cached = test::dense_records({{"components.secondary", "cache"},
                                               {"components.tertiary", "cache"},
                                               {"cache.rays", "64"},
                                               {"cache.max_rays", "256"},
                                               {"cache.max_records", "5000"},
                                               {"samples", "2"},
                                               {"path.batch", "8192"}});

/// The window's renderer of a room with cached light, at its start.
struct Window {
  session::Renderer r;
  explicit Window(uint32_t size, const Settings& settings = k_cached)
      : r([] {
          session::RendererOptions o = test::renderer_options(true);
          o.interactive = true;
          return o;
        }()) {
    r.set_size(size, size);
    test::set(r, settings);
    r.set_scene(std::make_shared<scene::Scene>(test::block_room(true)));
    test::set(r, settings);
  }
  ~Window() { CHECK(r.device().validation_messages() == 0); }
  std::optional<solvers::Report::Progress> progress() {
    for (const auto& report : r.solvers().reports())
      if (report->progress) return report->progress;
    return std::nullopt;
  }
};

}  // namespace

TEST_CASE("progress is reported while a cache is built or relit") {
  Window window(48);
  double least = 1, most = 0;
  CHECK_FALSE(window.progress());  // no estimate yet
  for (int i = 0; i < 10000 && window.r.preparing(); ++i) {
    window.r.step();
    if (const auto p = window.progress()) {
      CHECK(p->left_ms > 0);
      least = std::min(least, p->done), most = std::max(most, p->done);
    }
  }
  REQUIRE_FALSE(window.r.preparing());
  CHECK(least < 0.3);
  CHECK(most > least + 0.15);  // how far depends on the time of the last stages
  CHECK(most < 1);
  CHECK_FALSE(window.progress());
  // During relighting progress is measured in the records' rays.
  scene::Light lamp = window.r.scene()->lights[0];
  lamp.position.x += 0.2f;
  window.r.set_light(0, lamp);
  double before = 0;
  int reported = 0;
  for (int i = 0; i < 10000 && window.r.preparing(); ++i, window.r.step())
    if (const auto p = window.progress()) {
      CHECK(p->done > before - 0.05);
      before = p->done, ++reported;
    }
  CHECK(reported > 0);
}

TEST_CASE("preview samples estimate the time of path tracing before any lookup is possible") {
  Window window(64);
  CHECK_FALSE(window.r.previews().path_pace());
  for (int i = 0; i < 12 && !window.r.previews().path_pace(); ++i) window.r.previews().draw();
  const auto pace = window.r.previews().path_pace();
  REQUIRE(pace);
  CHECK(pace->seconds > 0);
  // The noise of one sample of a path-traced picture.
  Settings paths = k_cached;
  paths["components.secondary"] = paths["components.tertiary"] = "path";
  paths["samples"] = "16", paths["lights.sampling"] = "power";  // preview samples precede learned lights
  Window traced(64, paths);
  test::finish(traced.r);
  const double noise = traced.r.image_error().seen(0) * 4;
  INFO("noise of one sample " << noise << ", estimated " << pace->noise);
  CHECK(pace->noise == Approx(noise).epsilon(0.35));
  CHECK(pace->seconds_to(pace->noise / 10) == Approx(100 * pace->seconds));
  // A larger picture takes proportionally more. After a change of light there is no estimate, and records
  // have light by then.
  window.r.set_size(64, 128);
  REQUIRE(window.r.previews().path_pace());
  CHECK(window.r.previews().path_pace()->seconds == Approx(2 * pace->seconds));
  while (window.r.preparing()) window.r.step();
  scene::Light lamp = window.r.scene()->lights[0];
  lamp.position.x += 0.2f;
  window.r.set_light(0, lamp);
  for (int i = 0; i < 12; ++i) window.r.previews().draw();
  CHECK_FALSE(window.r.previews().path_pace());
}

TEST_CASE("an unchanged preview is recognized as unchanged") {
  Window window(48);
  CHECK_FALSE(window.r.output().shows_the_same());  // no preview was shown
  window.r.previews().draw();
  const auto shown = [&] { return window.r.output().shown_picture(true); };
  const std::vector<uint8_t> first = shown();
  CHECK(window.r.output().shows_the_same());
  window.r.step();  // builds records that no lookup has read yet
  CHECK(window.r.output().shows_the_same());
  CHECK(shown() == first);
  while (!window.r.previews().draw()) window.r.step();
  CHECK_FALSE(window.r.output().shows_the_same());
  shown();
  CHECK(window.r.output().shows_the_same());
  // Overlays may change whenever records do.
  test::set(window.r, {{"overlay.records", "true"}});
  shown();
  CHECK_FALSE(window.r.output().shows_the_same());
  test::set(window.r, {{"overlay.records", "false"}});
  shown();
  CHECK(window.r.output().shows_the_same());
  window.r.overlays().inspect(vec2(0.5f));
  CHECK_FALSE(window.r.output().shows_the_same());
  window.r.overlays().inspect({});
  // New samples change it; the finished picture is filtered once, and then stays.
  for (int i = 0; i < 10000 && window.r.samples() == 0; ++i) window.r.step();
  CHECK_FALSE(window.r.output().shows_the_same());
  test::finish(window.r);
  CHECK_FALSE(window.r.output().shows_the_same());
  shown();
  CHECK(window.r.output().shows_the_same());
}

}  // namespace session_progress_tests
