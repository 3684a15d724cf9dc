// links: session
// The measured part of each effect in a picture's light; durations are only checked for sanity.
#include <catch2/catch.hpp>

#include "session/effect_measurement.h"
#include "support/render.h"
#include "support/rooms.h"

namespace effect_costs_tests {

using namespace lucerna;

namespace {

session::EffectCosts measure(session::Renderer& r) {
  session::EffectMeasurement m(r, test::renderer_options());
  double progress = 0;
  while (!m.done()) {
    REQUIRE(m.step({}));
    REQUIRE(m.progress() >= progress);
    progress = m.progress();
  }
  return m.take();
}

const session::EffectCost& cost(const session::EffectCosts& costs, const std::string& key) {
  for (const session::EffectCost& c : costs.effects)
    if (c.key == key) return c;
  FAIL("'" << key << "' was not measured");
  throw;
}

bool measured(const session::EffectCosts& costs, const std::string& key) {
  return std::any_of(costs.effects.begin(), costs.effects.end(),
                     [&](const session::EffectCost& c) { return c.key == key; });
}

}  // namespace

TEST_CASE("parts of lights and of components sum to the whole picture; absent effects are not measured") {
  session::Renderer r(test::renderer_options());
  r.set_size(32, 24);
  r.set_scene(std::make_shared<scene::Scene>(test::room_under_moon()));
  const film::Image before = test::finish(r);
  const session::EffectCosts costs = measure(r);
  CHECK(costs.width == 32);
  CHECK(costs.sample_ms > 0);
  const double lights = cost(costs, "point").part.light + cost(costs, "directional").part.light +
                        cost(costs, "environment").part.light;
  CHECK(lights == Approx(1).margin(0.03));
  const double components = cost(costs, "primary").part.light + cost(costs, "secondary").part.light +
                            cost(costs, "tertiary").part.light;
  CHECK(components == Approx(1).margin(0.03));
  CHECK(cost(costs, "primary").part.seen > 0.3);
  for (const char* absent : {"spot", "normal_map", "caustic", "iridescence"})
    CHECK_FALSE(measured(costs, absent));
  for (size_t i = 1; i < costs.effects.size(); ++i) CHECK(costs.effects[i - 1].ms >= costs.effects[i].ms);
  // The picture itself is left alone.
  CHECK(test::identical(before.components[1], r.image().components[1]));
  CHECK(r.settings().text("effects.off").empty());
  // Parts are functions of scene, view and seed; effects that are off are not measured.
  r.settings().set("effects.off", "directional");
  r.apply_settings();
  const session::EffectCosts less = measure(r), again = measure(r);
  CHECK_FALSE(measured(less, "directional"));
  for (const session::EffectCost& c : less.effects) {
    CHECK(c.part.light == cost(again, c.key).part.light);
    CHECK(c.part.noise == cost(again, c.key).part.noise);
  }
}

TEST_CASE("a cancelled part of a measurement is repeated") {
  session::Renderer r(test::renderer_options());
  r.set_size(16, 16);
  r.set_scene(std::make_shared<scene::Scene>(test::room_under_moon()));
  session::EffectMeasurement m(r, test::renderer_options());
  bool cancels = false, cancelled = false;
  for (int steps = 0; !m.done() && steps < 10000; ++steps) {
    cancels = !cancels;
    cancelled = !m.step([&] { return cancels; }) || cancelled;
  }
  REQUIRE(m.done());
  CHECK(cancelled);
  const session::EffectCosts all = m.take(), whole = measure(r);
  for (const session::EffectCost& c : all.effects) CHECK(c.part.light == cost(whole, c.key).part.light);
}

}  // namespace effect_costs_tests
