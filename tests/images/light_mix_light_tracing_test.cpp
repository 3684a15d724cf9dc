// links: session
// Per-group light of light tracing (relight.enabled=compact): the unmixed picture equals, bit for bit, the
// one without groups; a mix equals light traced from lamps of that strength.
#include <catch2/catch.hpp>

#include "images/light_mix_support.h"

namespace light_mix_light_tracing_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

/// Caustic light alone, so no other light hides the groups.
Settings traced(Settings more = {}) {
  const Settings all{{"components.primary", "off"},  {"components.secondary", "off"},
                     {"components.tertiary", "off"}, {"components.caustic", "light"},
                     {"relight.enabled", "compact"}, {"path.batch", "8192"}};
  more.insert(all.begin(), all.end());
  return more;
}

/// Without a sun, which would be a separate light in per-group light.
scene::Scene even_room() {
  scene::Scene s = block_room(true);
  scene::Material metal;
  metal.metallic = 1, metal.roughness = 0.4f;
  s.materials.push_back(metal);
  add_ball(s, {1, 0.5f, 0.7f}, 0.5f, uint32_t(s.materials.size() - 1), 12);
  return s;
}

}  // namespace

TEST_CASE("splats with light groups give the picture of splats without") {
  const scene::Scene s = even_room();
  Bench separate(s, traced(), 4), whole(s, traced({{"relight.enabled", "off"}}), 4);
  const film::Image a = separate.image(), b = whole.image();
  CHECK(separate.r.relight().separate);
  CHECK(separate.r.film().is_compact());
  CHECK(mean(a.components[3]) > 0);
  CHECK(identical(a, b));
  CHECK(separate.r.device().validation_messages() == 0);
}

TEST_CASE("a mix of splats equals light traced from lamps of that strength, statistically") {
  const scene::Scene s = room();
  Settings other;
  other["seed"] = "2", other["relight.enabled"] = "off";
  Bench b(s, traced(), 64);
  b.image();
  const uint64_t rays = b.r.stats().rays;
  for (const char* text : {"lamp: solo color=0.1,1,0.2 factor=10000", "spot: mute; block: mute",
                           "sky: color=1,0.2,0.1; sun: mute; lamp: kelvin=9000 ev=1.3"}) {
    INFO(text);
    b.mix(text);
    Bench rendered(scene::mixed_scene(s, groups_of_room(), scene::parse_mix(text)), traced(other), 64);
    CHECK(worst_z(b.r.image(), rendered.image()) < 5.5);
  }
  CHECK(b.r.stats().rays == rays);
}

}  // namespace light_mix_light_tracing_tests
