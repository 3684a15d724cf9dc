// links: session
// Forecasts of render time compared with the actual values.
#include <catch2/catch.hpp>
#include <cstdio>

#include "session/renderer.h"
#include "stats/forecast.h"
#include "support/device.h"

namespace forecast_tests {

using namespace lucerna;

namespace {

struct Case {
  const char* scene;
  uint32_t width, height;
  const char* target;
};

/// Forecast over actual value at the first ledger entry with a forecast after a tenth of the rays: low,
/// middle, high.
stats::Band forecast(const Case& c, const char* seed) {
  session::Renderer r(test::renderer_options(false));
  r.set_size(c.width, c.height);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + c.scene + "/" + c.scene + ".gltf");
  r.settings().set("sampling.mode", "adaptive");
  r.settings().set("sampling.target_error", c.target);
  r.settings().set("seed", seed);
  r.apply_settings();
  while (r.step()) {
  }
  r.finish_ledger();
  const auto& entries = r.progress().ledger().entries();
  const double total = double(entries.back().rays);
  CHECK(entries.back().total_rays->middle == Approx(total).epsilon(1e-9));  // finished work needs no forecast
  for (const stats::Entry& e : entries) {
    if (double(e.rays) < 0.1 * total || !e.total_rays) continue;
    const stats::Band& b = *e.total_rays;
    std::printf(
        "%-8s %ux%u to %s, seed %s: %.2f M rays in all; after %.0f %% (%.0f samples per pixel) the forecast "
        "is %.2f of that, band %.2f to %.2f\n",
        c.scene, c.width, c.height, c.target, seed, 1e-6 * total, 100 * double(e.rays) / total, e.samples,
        b.middle / total, b.low / total, b.high / total);
    return {b.low / total, b.middle / total, b.high / total};
  }
  return {};
}

}  // namespace

TEST_CASE("a tenth of an adaptive render predicts the total") {
  // Default minimum and maximum of samples; the targets need two to ten times the minimum.
  for (const Case& c :
       {Case{"cornell", 64, 64, "0.07"}, Case{"studio", 96, 54, "0.03"}, Case{"atrium", 64, 36, "0.13"}}) {
    CAPTURE(c.scene, c.target);
    const stats::Band ratio = forecast(c, "3");
    CHECK(ratio.middle > 0.6);
    CHECK(ratio.middle < 1.6);
    CHECK(ratio.low < 1);
    CHECK(ratio.high > 1);
    CHECK(ratio.high < 8 * ratio.low);
  }
}

TEST_CASE("in uniform sampling the forecast band contains the actual value in eight cases of ten") {
  // Rooms, metal, a studio's environment: the error decreases by a different law in each. Each ledger entry
  // is predicted from those before it, in samples, which equals time on an otherwise idle machine.
  size_t reported = 0, held = 0;
  session::Renderer r(test::renderer_options(false));
  r.set_size(48, 32);
  for (const char* scene : {"cornell", "studio", "hall", "atrium"}) {
    r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + scene + "/" + scene + ".gltf");
    r.settings().set("samples", "256");
    r.settings().set("seed", "5");
    r.apply_settings();
    while (r.step()) {
    }
    r.finish_ledger();
    stats::Ledger whole, so_far;
    for (stats::Entry e : r.progress().ledger().entries())
      e.wall_s = e.samples, e.prepared_s = 0, whole.add(e);
    const double target = whole.entries().back().error[0] * 1.02;
    const auto truth = stats::seconds_to(whole, target);
    REQUIRE(truth);
    size_t of_scene = 0, within = 0;
    for (const stats::Entry& e : whole.entries()) {
      so_far.add(e);
      if (e.error[0] <= target) break;
      const auto band = stats::seconds_to(so_far, target);
      CHECK(band.has_value() == (e.samples >= stats::Outlook::k_least_samples));
      if (!band) continue;
      ++of_scene, within += band->low <= truth->middle && truth->middle <= band->high;
      if (e.samples < 20 || (e.samples > 60 && e.samples < 75))
        std::printf("%-8s with %.0f samples per pixel: %.2f of the truth, %.2f to %.2f\n", scene, e.samples,
                    band->middle / truth->middle, band->low / truth->middle, band->high / truth->middle);
    }
    std::printf("%-8s %zu of %zu held the truth\n", scene, within, of_scene);
    CHECK(of_scene >= 5);
    reported += of_scene, held += within;
  }
  CHECK(10 * held >= 8 * reported);
}

}  // namespace forecast_tests
