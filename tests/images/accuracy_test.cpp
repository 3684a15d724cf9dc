// links: session
// What a render reports about itself: which time it counts, that it reports no error before the first sample,
// and the time per sample.
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "images/cache_support.h"
#include "session/accuracy.h"
#include "session/session.h"
#include "support/device_name.h"
#include "support/rooms.h"

namespace accuracy_tests {

using namespace lucerna;
using test::Settings;

namespace {

void sleep_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

double total_ms(const transport::TransportStats& stats) {
  double ms = 0;
  for (const transport::StageSum& s : stats.stages) ms += s.ms;
  return ms;
}

struct Bed : test::CacheRenderer {
  explicit Bed(bool interactive = false) : CacheRenderer(test::block_room(true), 24, true, interactive) {
    set({{"components.secondary", "cache"},
         {"components.tertiary", "cache"},
         {"cache.rays", "64"},
         {"cache.max_rays", "256"},
         {"cache.error", "0.6"},
         {"samples", "16"},
         {"path.batch", "8192"}});
  }
};

}  // namespace

TEST_CASE("no accuracy is reported while a cache is built, however often progress is published") {
  Bed bed(true);
  session::AccuracyKeeper keeper;
  const double pixels = 24 * 24;
  int shown = 0;
  while (!test::cache(bed.r)->ready()) {
    REQUIRE(bed.r.step());
    // Preview samples, as the window draws them while records are built: each is a sixteenth or a quarter of
    // a sample.
    shown += bed.r.previews().draw();
    keeper.follow(bed.r, 1);
    const auto reported = keeper.publish(bed.r, true);
    CHECK(reported->ledger.entries().empty());
    REQUIRE(reported->paths == 0);
    CHECK_FALSE(session::seconds_to(*reported, 10).has_value());
  }
  REQUIRE(shown > 4);
  CHECK(bed.r.stats().paths == 0);
  // During the first pass over the picture there is no error and no crossing either.
  bed.set({{"path.batch", "1024"}});
  while (bed.r.step()) {
    keeper.follow(bed.r, 1);
    const auto reported = keeper.publish(bed.r, true);
    if (bed.r.samples() < 2) {
      for (const stats::Entry& e : reported->ledger.entries()) CHECK_FALSE(e.has_error);
      bed.r.finish_ledger();
      CHECK_FALSE(bed.r.progress().ledger().entries().back().has_error);
      CHECK_FALSE(stats::seconds_to(bed.r.progress().ledger(), 10).has_value());
    }
  }
  bed.r.finish_ledger();
  for (const stats::Entry& e : bed.r.progress().ledger().entries()) {
    if (!e.has_error) continue;
    CHECK(e.samples >= 2);
    CHECK(e.error[0] > 0);
  }
  CHECK(bed.r.progress().ledger().entries().back().samples == 16);
  CHECK(double(bed.r.stats().paths) == 16 * pixels);
}

TEST_CASE("the time per sample excludes preparation before the first sample") {
  Bed bed;
  while (!test::cache(bed.r)->ready()) bed.r.step();
  const double building = total_ms(bed.r.stats());
  REQUIRE(building > 0);
  CHECK(bed.r.progress().component_ms_a_sample() == ByComponent<double>{});
  session::AccuracyKeeper keeper;
  keeper.follow(bed.r, 1);
  while (bed.r.step()) keeper.follow(bed.r, 1);
  double each = 0, passes = 0;
  for (const double ms : bed.r.progress().component_ms_a_sample()) each += ms;
  CHECK(16 * each == Approx(total_ms(bed.r.stats()) - building).epsilon(1e-6));
  // The times of the passes exclude it too.
  for (const session::PassStatus& pass : keeper.publish(bed.r, true)->passes)
    for (const float ms : pass.stage_ms) passes += double{ms};
  CHECK(passes == Approx(16 * each).epsilon(1e-4));
}

TEST_CASE("the session clock counts the time between steps and stops while rendering is paused") {
  session::Renderer r(test::renderer_options(true));
  r.set_size(16, 16);
  r.set_scene(std::make_shared<scene::Scene>(test::block_room(true)));
  test::set(r, {{"samples", "8"}});
  sleep_ms(20);
  CHECK(r.progress().seconds() == 0);  // no picture has been requested yet
  int steps = 0;
  while (r.samples() < 4) {
    REQUIRE(r.step());
    sleep_ms(20);  // the user looks at the picture
    ++steps;
  }
  const double looked = 0.02 * steps;
  CHECK(r.progress().seconds() >= r.progress().render_seconds() + looked);
  // The ledger entry was written before the last read of the clock.
  const stats::Entry& line = r.progress().ledger().entries().back();
  CHECK(line.wall_s >= line.render_s + looked - 0.02);
  CHECK(line.wall_s <= r.progress().seconds());
  r.progress().rest();
  const double paused = r.progress().seconds();
  sleep_ms(20);
  CHECK(r.progress().seconds() == paused);
  while (r.step()) {
  }
  r.finish_ledger();
  // Once the picture is finished the clock stands still.
  const double all = r.progress().seconds();
  CHECK(all > paused);
  sleep_ms(20);
  CHECK(r.progress().seconds() == all);
  CHECK(r.progress().ledger().entries().back().wall_s == all);
  CHECK(r.progress().ledger().entries().back().render_s == r.progress().render_seconds());
  r.restart();
  CHECK(r.progress().seconds() == 0);
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("every report of a session uses one clock, which stands still while rendering is paused") {
  const auto made =
      session::start_session({.device = test::device_name(), .validation = false, .shaders = {}});
  session::Session& s = *made;
  const auto wait = [&](const auto& until) {
    for (int i = 0; i < 6000; ++i, sleep_ms(5))
      if (const auto at = s.snapshot(); at && until(*at)) return at;
    FAIL("the session does not reach the expected state");
    return s.snapshot();
  };
  s.set_size(16, 16);
  s.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  s.set("samples", "1048576");
  wait([](const session::Snapshot& at) { return at.samples >= 8; });
  s.set_paused(true);
  const auto before = wait([&](const session::Snapshot& at) { return at.paused && at.commands >= 4; });
  sleep_ms(50);
  s.set("overlay.tiles", "true");  // the picture is shown again
  const auto after = wait([&](const session::Snapshot& at) { return at.commands >= 5; });
  CHECK(after->seconds == before->seconds);
  CHECK(after->seconds > 0);
  CHECK(after->accuracy->ledger.entries().back().wall_s <= after->seconds);
  s.set_paused(false);
  wait([&](const session::Snapshot& at) { return !at.paused && at.seconds > after->seconds; });
}

}  // namespace accuracy_tests
