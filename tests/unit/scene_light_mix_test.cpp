// links: scene
// Light mixes as text, as weights, interpolated, and written into a scene's lights.
#include "scene/light_mix.h"

#include <catch2/catch.hpp>

#include "base/blackbody.h"
#include "base/error.h"
#include "support/rooms.h"

namespace scene_light_mix_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
using namespace lucerna::scene;

namespace {
LightGroups groups(const std::vector<std::string>& names) {
  LightGroups g;
  for (const std::string& name : names) g.groups.push_back({.name = name});
  return g;
}
}  // namespace

TEST_CASE("a mix is read and written as text") {
  const LightMix mix =
      parse_mix(" desk lamps : ev=-1.5 color=1,0.5,0.25 ;sky: mute;;\tsun:solo factor=8; x: kelvin=2700");
  REQUIRE(mix.size() == 4);
  CHECK(mix.at("desk lamps") == GroupMix{.ev = -1.5f, .color = {1, 0.5f, 0.25f}});
  CHECK(mix.at("sky") == GroupMix{.mute = true});
  CHECK(mix.at("sun") == GroupMix{.ev = 3, .solo = true});
  CHECK(mix.at("x").color == blackbody_color(2700));
  CHECK(parse_mix(mix_text(mix)) == mix);
  CHECK(mix_text(parse_mix("a: ev=0; b:")).empty());
  CHECK(mix_text({}).empty());
  CHECK(parse_mix("").empty());
  // Bit for bit.
  const LightMix odd{{"a", {.ev = 0.1f, .color = {1.0f / 3, 1e-30f, 2}}}};
  CHECK(parse_mix(mix_text(odd)) == odd);
}

TEST_CASE("an invalid mix is reported with its invalid part") {
  const auto bad = [](const char* text, const char* what) {
    INFO(text);
    CHECK_THROWS_WITH(parse_mix(text), Contains("relight.mix") && Contains(what));
  };
  bad("sky", "'sky'");
  bad(": ev=1", "GROUP");
  bad("sky: ev=", "'' is no number");
  bad("sky: ev=1e", "no number");
  bad("sky: ev=nan", "no number");
  bad("sky: ev=31", "-30 to 30");
  bad("sky: factor=0", "expected");
  bad("sky: kelvin=0", "1000 to 40000");
  bad("sky: color=1,1", "color=R,G,B");
  bad("sky: color=1,-1,1", "expected 0 to");
  bad("sky: bright", "'bright'");
  CHECK_THROWS_WITH(parse_presets("morning: ev=1"), Contains("relight.presets") && Contains("NAME ="));
  CHECK_THROWS_WITH(parse_presets("a = sky: ev=x"), Contains("relight.presets"));
}

TEST_CASE("weights: strength times colour, mute and solo") {
  const LightGroups g = groups({"a", "b", "c"});
  const auto weights = [&](const char* text) { return mix_weights(parse_mix(text), g); };
  using W = std::vector<vec3>;
  CHECK(weights("") == W{vec3(1), vec3(1), vec3(1)});
  CHECK(weights("a: ev=-2 color=1,0.5,0; c: mute ev=3") == W{vec3(0.25f, 0.125f, 0), vec3(1), vec3(0)});
  CHECK(weights("b: solo ev=1") == W{vec3(0), vec3(2), vec3(0)});
  CHECK(weights("b: solo; c: solo mute") == W{vec3(0), vec3(1), vec3(0)});
  // The solo of a missing group mutes no other.
  CHECK(weights("gone: solo") == W{vec3(1), vec3(1), vec3(1)});
  CHECK(unknown_groups(parse_mix("gone: solo; a: mute"), g) == std::vector<std::string>{"gone"});
  CHECK(is_neutral(parse_mix("gone: mute; a: ev=0"), g));
  CHECK_FALSE(is_neutral(parse_mix("a: ev=0.001"), g));
}

TEST_CASE("between two mixes light is linear") {
  const LightGroups g = groups({"a", "b", "c"});
  const LightMix one = parse_mix("a: ev=2 color=1,0,0; b: mute"), two = parse_mix("b: solo ev=1");
  CHECK(blend(one, two, 0, g) == one);
  CHECK(blend(one, two, 1, g) == two);
  const std::vector<vec3> wa = mix_weights(one, g), wb = mix_weights(two, g),
                          between = mix_weights(blend(one, two, 0.25f, g), g);
  for (size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      CHECK(between[i][k] == Approx(0.75f * wa[i][k] + 0.25f * wb[i][k]).margin(1e-6));
  // A group that is muted in both is muted between them.
  CHECK(mix_weights(blend(parse_mix("a: mute"), parse_mix("a: mute; b: ev=1"), 0.5f, g), g)[0] == vec3(0));
}

TEST_CASE("presets are read and written as text") {
  const MixPresets presets =
      parse_presets("morning = sky: ev=1; lamps: mute | evening=lamps: ev=2 color=1,0.5,0.25|day =");
  REQUIRE(presets.size() == 3);
  CHECK(presets.at("morning").at("lamps").mute);
  CHECK(presets.at("evening").at("lamps").ev == 2);
  CHECK(presets.at("day").empty());
  CHECK(parse_presets(presets_text(presets)) == presets);
}

TEST_CASE("a mixed scene differs from the scene in its lights only") {
  Scene s = block_room(true);
  s.materials[1].name = "block", s.materials[1].emission = vec3(2);
  s.images[0].floats[0] = 1000;  // a sun
  const LightGroups g = group_lights(s);
  REQUIRE(g.groups.size() == 4);
  const Scene m = mixed_scene(s, g, parse_mix("lamp: ev=1; block: color=1,0,0; sky: mute; sun: ev=-1"));
  CHECK(m.lights[0].intensity == 2.0f * s.lights[0].intensity);
  CHECK(m.materials[1].emission == vec3(2, 0, 0));
  CHECK(m.materials[0].emission == vec3(0));
  const Image& sky = m.images[m.environment.image];
  CHECK(sky.floats[0] == 500);
  CHECK(sky.floats[4] == 0);
  CHECK(s.images[0].floats[4] > 0);
  // A uniform environment.
  s.environment.image = k_none, s.environment.radiance = vec3(3);
  CHECK(mixed_scene(s, group_lights(s), parse_mix("sky: color=1,0.5,0")).environment.radiance ==
        vec3(3, 1.5f, 0));

  // A material in two groups takes the first one's weight, with one message.
  add_quad(s, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1), add_quad(s, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1);
  s.instances[2].group = s.instances[3].group = "shelf";
  std::vector<std::string> messages;
  mixed_scene(s, group_lights(s), parse_mix("shelf: ev=1"), &messages);
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0], Contains("'block'") && Contains("'shelf'"));
  messages.clear();
  mixed_scene(s, group_lights(s), parse_mix("shelf: ev=1; block: ev=1"), &messages);
  CHECK(messages.empty());
}

}  // namespace scene_light_mix_tests
