// links: session
// After a tenth of an adaptive render, the forecast of its total rays is right within 25 %.
#include <catch2/catch.hpp>
#include <cstdio>

#include "session/renderer.h"

using namespace lucerna;

namespace {

struct Case {
  const char* scene;
  uint32_t width, height;
  const char* target;
};

/// Forecast over truth at the first line of the ledger after a tenth of the rays: low, middle, high.
stats::Band forecast(const Case& c, const char* seed) {
  session::Renderer r({.device = "cpu", .validation = false, .shaders = {}, .defines = {}});
  r.set_size(c.width, c.height);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + c.scene + "/" + c.scene + ".gltf");
  r.settings().set("sampling.mode", "adaptive");
  r.settings().set("sampling.target_error", c.target);
  r.settings().set("seed", seed);
  r.apply_settings();
  while (r.step()) {
  }
  r.finish_ledger();
  const auto& entries = r.ledger().entries();
  const double total = double(entries.back().rays);
  CHECK(entries.back().total_rays->middle == Approx(total).epsilon(1e-9));  // what is done needs no forecast
  for (const stats::Entry& e : entries) {
    if (double(e.rays) < 0.1 * total) continue;
    const stats::Band& b = *e.total_rays;
    std::printf(
        "%-8s %ux%u to %s, seed %s: %.2f M rays in all; after %.0f %% (%.0f samples a pixel) the forecast "
        "is %.2f of that, band %.2f to %.2f\n",
        c.scene, c.width, c.height, c.target, seed, 1e-6 * total, 100 * double(e.rays) / total, e.samples,
        b.middle / total, b.low / total, b.high / total);
    return {b.low / total, b.middle / total, b.high / total};
  }
  return {};
}

}  // namespace

TEST_CASE("a tenth of a render foretells the whole within 25 %") {
  // At the default minimum and maximum of samples; the targets ask for two to ten times the minimum.
  for (const Case& c : {Case{"cornell", 96, 96, "0.08"}, Case{"cornell", 64, 64, "0.05"},
                        Case{"studio", 160, 90, "0.03"}, Case{"atrium", 96, 54, "0.15"}}) {
    CAPTURE(c.scene, c.target);
    const stats::Band ratio = forecast(c, "3");
    CHECK(ratio.middle > 0.75);
    CHECK(ratio.middle < 1.25);
    CHECK(ratio.low < ratio.middle);
    CHECK(ratio.high > ratio.middle);
  }
}
