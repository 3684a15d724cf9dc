// links: session
// Per-group light of photons (relight.enabled=compact): the unmixed picture equals, bit for bit, the one
// without groups; a mix equals photons from lamps of that strength, within noise; the same for records whose
// rays end in photons.
#include <catch2/catch.hpp>

#include "base/log.h"
#include "images/light_mix_support.h"

namespace light_mix_photons_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

Settings photons(Settings more = {}) {
  const Settings all{{"components.secondary", "photons"}, {"components.tertiary", "photons"},
                     {"components.caustic", "photons"},   {"photons.efficiency", "false"},
                     {"relight.enabled", "compact"},      {"path.batch", "8192"}};
  more.insert(all.begin(), all.end());
  return more;
}

}  // namespace

TEST_CASE("photons with light groups give the picture of photons without") {
  const scene::Scene even = block_room(true);  // no sun, which would be a separate light
  Bench separate(even, photons(), 4), whole(even, photons({{"relight.enabled", "off"}}), 4);
  const film::Image a = separate.image(), b = whole.image();
  CHECK(separate.r.relight().separate);
  CHECK(separate.r.film().is_compact());
  CHECK(identical(a, b));
  CHECK(separate.r.image_error().interpolation_rms == whole.r.image_error().interpolation_rms);
  CHECK(separate.r.device().validation_messages() == 0);
}

TEST_CASE("a mix of photons' light equals photons from lamps of that strength, statistically") {
  const scene::Scene s = room();
  // One radius, so samples are alike and the halves give the noise.
  const Settings how{{"photons.radius", "6"}, {"photons.floor", "6"}};
  Settings other = how;
  other["seed"] = "2", other["relight.enabled"] = "off";
  Bench b(s, photons(how), 32);
  b.image();
  const uint64_t rays = b.r.stats().rays;
  for (const char* text : {"lamp: solo color=0.1,1,0.2 factor=10000",
                           "sky: color=1,0.2,0.1; sun: mute; lamp: kelvin=9000 ev=1.3"}) {
    INFO(text);
    b.mix(text);
    Bench rendered(scene::mixed_scene(s, groups_of_room(), scene::parse_mix(text)), photons(other), 32);
    // Radii are in pixels, so both blur alike. 24 blocks, 2 pictures: 5 errors with about 64 degrees of
    // freedom occur by chance in one of 5000 such tests; light of a wrong group is off by tens.
    CHECK(worst_z(as_one_component(b.r.image()), as_one_component(rendered.image())) < 5);
  }
  CHECK(b.r.stats().rays == rays);
}

TEST_CASE("a request for layers of untracked groups is reported") {
  const auto warnings = [](const Settings& how) {
    Bench b(room(), photons(how), 1);
    b.image();
    std::string text;
    const int token = log::add_listener([&](log::Level, const std::string& line) { text += line + "\n"; });
    const film::FilmImage image = b.r.output().film_image();
    log::remove_listener(token);
    bool found = false;
    for (const auto& [name, values] : image.channels) found |= name.starts_with("light.");
    CHECK(found == text.empty());
    return text;
  };
  CHECK(warnings({{"relight.layers", "true"}}).empty());
  CHECK_THAT(warnings({{"relight.layers", "true"}, {"relight.enabled", "on"}}),
             Catch::Contains("relight.layers: the EXR has no layers of light groups: ") &&
                 Catch::Contains("relight.enabled=compact"));
  CHECK_THAT(warnings({{"relight.layers", "true"}, {"relight.enabled", "off"}}),
             Catch::Contains("relight.enabled is off"));
}

TEST_CASE("records whose rays end in photons keep their groups") {
  const scene::Scene s = room();
  const Settings how{{"components.secondary", "cache"}, {"cache.metric", "split-sphere"}, {"samples", "32"}};
  Bench b(s, photons(how), 32), traced(s, {{"relight.enabled", "compact"}}, 256);
  b.image(), traced.image();
  for (const char* text : {"", "sky: mute", "lamp: solo", "block: solo"}) {
    INFO(text);
    b.mix(text), traced.mix(text);
    double sum = 0, all = 0;
    const film::Image p = as_one_component(b.r.image()), q = as_one_component(traced.r.image());
    for (size_t i = 0; i < p.samples.size(); ++i)
      sum += luminance(p.components[0][i]), all += luminance(q.components[0][i]);
    CHECK(sum / all == Approx(1).margin(0.03));
  }
}

}  // namespace light_mix_photons_tests
