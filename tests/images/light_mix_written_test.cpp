// links: session
// A light mix written into the lights, and removed from them again: the light is the same, so no traced light
// is lost.
#include <catch2/catch.hpp>

#include "images/cache_support.h"
#include "scene/light_mix.h"
#include "support/rooms.h"

namespace light_mix_written_tests {

using namespace lucerna;
using test::Settings;

namespace {

struct Bed : test::CacheRenderer {
  explicit Bed(const Settings& more = {}) : CacheRenderer(test::block_room(true), 24) {
    set({{"relight.enabled", "on"}, {"samples", "4"}});
    if (!more.empty()) set(more);
  }
  std::string mix() const {
    REQUIRE(r.relight().groups->groups.size() == 2);
    scene::LightMix mix;
    for (const scene::LightGroup& group : r.relight().groups->groups)
      if (group.sky)
        mix[group.name].ev = -1.3f;
      else
        mix[group.name] = {.ev = 1.7f, .color = {1, 0.5f, 0.3f}};
    return scene::mix_text(mix);
  }
  /// The lights with the current mix applied, or as built.
  session::LightsEdit edit(bool written, const std::string& mix) const {
    const scene::Scene made = test::block_room(true);
    session::LightsEdit e{.lights = {{0, made.lights[0]}},
                          .materials = {},
                          .environment_scale = made.environment.scale,
                          .mix = mix};
    if (!written) return e;
    for (size_t g = 0; g < r.relight().weights.size(); ++g)
      if (r.relight().groups->groups[g].sky)
        *e.environment_scale *= r.relight().weights[g].x;
      else
        e.lights[0].second.intensity *= r.relight().weights[g];
    return e;
  }
};

bool same(const film::Image& a, const film::Image& b) {
  bool same = a.samples == b.samples;
  for (const int c : k_components) same = same && a.components[c] == b.components[c];
  return same;
}

/// The largest relative difference of two pictures' means.
double apart(const film::Image& a, const film::Image& b) {
  double most = 0;
  for (int c = 0; c < 3; ++c) {
    const double x = test::mean(a.components[c]), y = test::mean(b.components[c]);
    most = std::max(most, std::abs(x - y) / std::max(y, 1e-6));
  }
  return most;
}

}  // namespace

TEST_CASE("writing a mix into the lights keeps the picture, and so does undoing it") {
  Bed bed, plain;
  const std::string mix = bed.mix();
  bed.set({{"relight.mix", mix}}), plain.set({{"relight.mix", mix}});
  const film::Image before = bed.finish();
  const uint64_t restarts = bed.r.restarts(), paths = bed.r.stats().paths;
  const auto unchanged = [&](const film::Image& expected) {
    CHECK(bed.r.restarts() == restarts);
    CHECK(same(bed.r.image(), expected));
  };
  bed.r.set_lights(bed.edit(true, ""));
  unchanged(before);
  CHECK(bed.r.stats().paths == paths);
  CHECK(bed.r.settings().text("relight.mix").empty());
  CHECK(bed.r.scene()->lights[0].intensity.x == Approx(5 * std::exp2(1.7)));
  // Other settings, and more samples: the same ones that the mix would have got.
  bed.set({{"film.ev", "1"}});
  unchanged(before);
  bed.set({{"samples", "8"}}), plain.set({{"samples", "8"}});
  unchanged(before);
  const film::Image more = plain.finish();
  bed.finish();
  unchanged(more);
  // Undo, and redo.
  bed.r.set_lights(bed.edit(false, mix));
  unchanged(more);
  CHECK(bed.r.scene()->lights[0].intensity == vec3(5));
  bed.r.set_lights(bed.edit(true, ""));
  unchanged(more);
  // A mix on top of the written one.
  scene::LightMix twice;
  for (const scene::LightGroup& group : bed.r.relight().groups->groups) twice[group.name].ev = 1;
  bed.set({{"relight.mix", scene::mix_text(twice)}});
  CHECK(bed.r.restarts() == restarts);
  for (int c = 0; c < 3; ++c)
    CHECK(test::mean(bed.r.image().components[c]) ==
          Approx(2 * test::mean(more.components[c])).epsilon(1e-4));
}

TEST_CASE("after another edit, camera or size the written lights are traced") {
  Bed bed;
  bed.set({{"relight.mix", bed.mix()}});
  bed.finish();
  const session::LightsEdit written = bed.edit(true, "");
  bed.r.set_lights(written);
  Bed fresh;
  fresh.r.set_lights(written);  // no mix before: a different light
  CHECK(fresh.r.samples() == 0);
  for (Bed* b : {&bed, &fresh}) {
    b->r.choose_camera("above");
    b->set({{"samples", "64"}});
  }
  CHECK(apart(bed.finish(), fresh.finish()) < 0.05);
  for (Bed* b : {&bed, &fresh}) b->r.set_size(20, 16);
  CHECK(apart(bed.finish(), fresh.finish()) < 0.05);
  for (Bed* b : {&bed, &fresh}) b->set({{"components.tertiary", "off"}});
  CHECK(apart(bed.finish(), fresh.finish()) < 0.05);
  // A light edit: as in a scene that was built that way.
  for (Bed* b : {&bed, &fresh}) {
    scene::Light lamp = b->r.scene()->lights[0];
    lamp.position.x = -1;
    b->r.set_light(0, lamp);
  }
  CHECK(same(bed.finish(), fresh.finish()));
}

TEST_CASE("without tracked groups, or with other light, the lights are edited and the picture restarts") {
  Bed bed(Settings{{"relight.enabled", "off"}});
  bed.finish();
  session::LightsEdit e{
      .lights = {{0, bed.r.scene()->lights[0]}}, .materials = {}, .environment_scale = {}, .mix = ""};
  e.lights[0].second.intensity *= 2.0f;
  bed.r.set_lights(e);
  CHECK(bed.r.samples() == 0);
  Bed other;
  other.finish();
  e.mix = other.mix();
  other.r.set_lights(e);
  CHECK(other.r.samples() == 0);
  CHECK(other.r.settings().text("relight.mix") == e.mix);
  // An impossible edit changes nothing.
  const session::LightsEdit wrong{.lights = {{7, {}}}, .materials = {}, .environment_scale = {}, .mix = ""};
  CHECK_THROWS_WITH(other.r.set_lights(wrong), "light: there is no light 7");
  e.mix = "nonsense";
  CHECK_THROWS_AS(other.r.set_lights(e), Error);
  CHECK(other.r.settings().text("relight.mix") != "nonsense");
}

}  // namespace light_mix_written_tests
