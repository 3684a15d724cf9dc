// links: session
// Previews of light computed by photons, before photons exist: preview samples path trace it, and do not
// influence the pilot.
#include <catch2/catch.hpp>

#include "solvers/photons/solver.h"
#include "support/render.h"
#include "support/rooms.h"

namespace photons_drafts_tests {

using namespace lucerna;
using test::Settings;

namespace {

/// A room whose lamps light the ceiling only, so everything else is lit by the ceiling.
scene::Scene lit_from_above() {
  scene::Scene s = test::block_room();
  s.lights[0].kind = scene::LightKind::spot;
  s.lights[0].direction = {0, 1, 0};
  s.lights[0].outer_cone = 0.9f, s.lights[0].inner_cone = 0.7f;
  s.lights[0].intensity = vec3(20);
  // A second lamp, so the pilot distributes paths by the lamps' contributions.
  s.lights.push_back(s.lights[0]);
  s.lights[1].position = {-1.2f, 1.8f, -1.2f}, s.lights[1].intensity = vec3(4, 8, 4);
  return s;
}

struct Bed {
  session::Renderer r;
  Bed(const Settings& how, bool window) : r(options(window)) {
    r.set_size(48, 48);
    r.set_scene(std::make_shared<scene::Scene>(lit_from_above()));
    Settings all{{"components.caustic", "off"}, {"samples", "4"}, {"photons.efficiency", "false"}};
    for (const auto& [key, value] : how) all[key] = value;
    test::set(r, all);
  }
  static session::RendererOptions options(bool window) {
    session::RendererOptions o = test::renderer_options(false);
    o.interactive = window;
    return o;
  }
  double shown() {
    const std::vector<uint8_t> rgba = r.output().shown_picture(r.samples() == 0);
    double sum = 0;
    for (size_t i = 0; i < rgba.size(); i += 4) sum += rgba[i] + rgba[i + 1] + rgba[i + 2];
    return sum / (255.0 * 3 / 4 * double(rgba.size()));
  }
};

const Settings k_all{{"components.secondary", "photons"}, {"components.tertiary", "photons"}};
const Settings k_gather{{"components.tertiary", "photons"}};
const Settings k_records{{"components.secondary", "cache"}, {"components.tertiary", "photons"}};

}  // namespace

TEST_CASE("before photons exist preview samples show the same light") {
  for (const Settings& how : {k_all, k_gather, k_records}) {
    Bed bed(how, true);
    for (int i = 0; i < 8; ++i) bed.r.previews().draw();
    const auto& solver = dynamic_cast<photons::PhotonSolver&>(*bed.r.solver("photons"));
    REQUIRE(solver.map().figures().photons == 0);
    const double early = bed.shown();
    test::finish(bed.r);
    const double finally = bed.shown();
    INFO(how.size() << ": early " << early << ", finally " << finally);
    CHECK(finally > 0.05);
    // A few samples of a small picture, each encoded: bright outliers count for less.
    CHECK(early == Approx(finally).epsilon(0.15));
  }
}

TEST_CASE("the picture does not depend on preview samples, bit for bit") {
  for (const Settings& how : {k_all, k_gather, k_records}) {
    Bed batch(how, false), window(how, true);
    const film::Image right = test::finish(batch.r);
    // Before any photons a few preview samples between any two steps, also while the pilot records.
    for (int i = 0; !window.r.done() && i < 100000; ++i) {
      for (int k = 0; k < (window.r.samples() == 0 ? 6 : 0); ++k) window.r.previews().draw();
      window.r.step();
    }
    CHECK(test::identical(right, window.r.image()));
  }
}

}  // namespace photons_drafts_tests
