// links: scene_io
// Light groups: from extras, from name patterns, by kind as default; and the maximum number.
#include "scene/light_groups.h"

#include <set>

#include "scene/light_mix.h"
#include "support/rooms.h"
#include "unit/scene_support.h"

namespace scene_light_groups_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;
using scene::LightGroups;
using scene::Scene;

namespace {

std::string group_of_lamp(const LightGroups& g, size_t lamp) { return g.groups[g.lamps[lamp]].name; }

Scene lamps(const std::vector<std::string>& names) {
  Scene s;
  for (const std::string& name : names) s.lights.push_back({.name = name});
  return s;
}

void add_sky(Scene& s, bool sun) {
  scene::Image sky;
  sky.width = 32, sky.height = 16;
  for (int i = 0; i < 32 * 16; ++i) sky.floats.insert(sky.floats.end(), {1, 1, 1, 1});
  if (sun)
    for (size_t k = 0; k < 3; ++k) sky.floats[4 * (5 * 32 + 7) + k] = 100;
  s.images.push_back(sky);
  s.environment.image = scene::Id(s.images.size() - 1);
}

}  // namespace

TEST_CASE("a name's kind is the part before its final number") {
  CHECK(scene::kind_of_light("Spot.001") == "Spot");
  CHECK(scene::kind_of_light("Spot 2") == "Spot");
  CHECK(scene::kind_of_light("ceiling_lamp_12.003") == "ceiling_lamp");
  CHECK(scene::kind_of_light("Spot") == "Spot");
  CHECK(scene::kind_of_light("40") == "40");
  CHECK(scene::kind_of_light("").empty());
}

TEST_CASE("names that differ in one character are different groups") {
  std::set<std::string> names;
  for (const char* name : {"a;b", "a:b", "a=b", "a|b", "a_b", "a\tb", "a\nb", "a b"}) {
    const std::string group = scene::group_name(name);
    CHECK(group.find_first_of(";:=|\t\n") == std::string::npos);
    CHECK(scene::group_name(group) == group);
    CHECK(names.insert(group).second);
    // A mix accepts both names.
    CHECK(scene::parse_mix(group + ": ev=1").count(group) == 1);
  }
  CHECK(scene::group_lights(lamps({"key:a", "key=a", "key:a.001"})).groups.size() == 2);
}

TEST_CASE("long group names are cut between characters and stay different") {
  const std::string long_name(63, 'x');
  CHECK(scene::group_name(long_name) == long_name);
  const std::string a = scene::group_name(long_name + "\u00e4\u00f6"),
                    b = scene::group_name(long_name + "\u00e4\u00fc");
  CHECK(a.size() <= 64);
  CHECK(a != b);
  CHECK(scene::group_name(a) == a);
  for (int length = 50; length < 70; ++length) {
    std::string name(static_cast<size_t>(length), 'x');
    for (int i = 0; i < 10; ++i) name += "\u00e4";
    CHECK_NOTHROW(json(scene::group_name(name)).dump());
  }
  const std::string lamp = "Luminaire - Downlight - Recessed - LED - 150 mm - 3000 K - 12 W - ";
  const LightGroups g =
      scene::group_lights(lamps({lamp + "hall.001", lamp + "stairs.001", lamp + "hall.002"}));
  CHECK(g.groups.size() == 2);
  CHECK(g.lamps == std::vector<uint8_t>{0, 1, 0});
}

TEST_CASE("patterns") {
  using scene::matches_pattern;
  CHECK(matches_pattern("*", ""));
  CHECK(matches_pattern("*lamp*", "a lamp here"));
  CHECK(matches_pattern("l?mp", "lamp"));
  CHECK(matches_pattern("l?mp*", "l\u00e4mpchen"));
  CHECK_FALSE(matches_pattern("l??mp", "l\u00e4mp"));
  CHECK(matches_pattern("a*b*c", "axxbyybzzc"));
  CHECK_FALSE(matches_pattern("a*b*c", "axxbyybzz"));
  CHECK_FALSE(matches_pattern("lamp", "lamps"));
  CHECK_FALSE(matches_pattern("l?mp", "lmp"));
  CHECK_FALSE(matches_pattern("", "x"));
}

TEST_CASE("by default lights are grouped by kind, with separate sky and sun") {
  Scene s = lamps({"Spot.001", "Spot.002", "desk", "", "sun"});
  s.materials = {diffuse(vec3(1)), diffuse(vec3(0), vec3(3)), diffuse(vec3(0), vec3(4))};
  s.materials[1].name = "panel", s.materials[2].name = "desk";
  add_quad(s, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  add_quad(s, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1);
  add_quad(s, {0, 0, 2}, {1, 0, 0}, {0, 1, 0}, 2);
  add_sky(s, true);
  const LightGroups g = scene::group_lights(s);
  std::vector<std::string> names;
  for (const auto& group : g.groups) names.push_back(group.name);
  CHECK(names == std::vector<std::string>{"sky", "sun", "Spot", "desk", "lamp", "panel"});
  CHECK(g.lamps == std::vector<uint8_t>{2, 2, 3, 4, 1});  // a lamp named sun belongs to the sun
  CHECK(g.surfaces[0].empty());
  CHECK(g.surfaces[1] == std::vector<uint8_t>{5});
  CHECK(g.surfaces[2] == std::vector<uint8_t>{3});
  CHECK(g.has_sun);
  CHECK(g.groups[1].sun);
  CHECK(g.groups[1].lamps == 1);
  CHECK(g.groups[2].lamps == 2);
  CHECK(g.groups[3].surfaces == 1);
  CHECK(g.messages.empty());

  // A uniform environment has no sun.
  s.images.clear(), add_sky(s, false);
  CHECK_FALSE(scene::group_lights(s).has_sun);
  CHECK_FALSE(scene::has_sun(s));
  // A black environment is no light.
  s.environment.scale = 0;
  CHECK(scene::group_lights(s).groups[0].name == "Spot");
}

TEST_CASE("rules override extras, and a node's extras override a material's") {
  Scene s = lamps({"a", "b"});
  s.lights[1].group = "evening";
  s.materials = {diffuse(vec3(0), vec3(3))};
  s.materials[0].name = "glow", s.materials[0].group = "shelf";
  for (int i = 0; i < 3; ++i) add_quad(s, {0, 0, float(i)}, {1, 0, 0}, {0, 1, 0}, 0);
  s.instances[1].group = "evening";
  s.instances[2].name = "north window";
  const auto names = [&](const std::string& rules) {
    const LightGroups g = scene::group_lights(s, scene::parse_group_rules(rules));
    std::vector<std::string> all{group_of_lamp(g, 0), group_of_lamp(g, 1)};
    for (const auto& of : g.surfaces) all.push_back(g.groups[of[0]].name);
    return all;
  };
  using Names = std::vector<std::string>;
  CHECK(names("") == Names{"a", "evening", "shelf", "evening", "shelf"});
  CHECK(names("b = b2 ; *window=windows;") == Names{"a", "b2", "shelf", "evening", "windows"});
  // The last matching rule wins.
  CHECK(names("*=all; glow=glow; north*=north") == Names{"all", "all", "glow", "glow", "north"});
  CHECK_THROWS_WITH(scene::parse_group_rules("a=b; lamps"),
                    Contains("relight.groups") && Contains("'lamps'"));
  CHECK_THROWS_WITH(scene::parse_group_rules("=b"), Contains("PATTERN=GROUP"));
}

TEST_CASE("a seventeenth group is merged with the sixteenth, with a message") {
  std::vector<std::string> names;
  for (char c = 'a'; c < 'a' + 16; ++c) names.emplace_back(1, c);
  Scene s = lamps(names);
  LightGroups g = scene::group_lights(s);
  REQUIRE(g.groups.size() == 16);
  CHECK(g.groups.back().name == "p");
  CHECK(g.messages.empty());
  names.insert(names.end(), {"q", "r", "q"});
  s = lamps(names);
  g = scene::group_lights(s);
  REQUIRE(g.groups.size() == 16);
  CHECK(g.groups.back().name == scene::k_other_lights);
  CHECK(g.groups.back().lamps == 4);
  for (size_t i = 15; i < names.size(); ++i) CHECK(g.lamps[i] == 15);
  REQUIRE(g.messages.size() == 1);
  CHECK_THAT(g.messages[0], Contains("18 light groups") && Contains("'p', 'q', 'r'"));
  CHECK(g.find("a") == 0);
  CHECK(g.find("q") == 16);
}

TEST_CASE("extras of a file's nodes, lamps and materials are read and described") {
  Asset asset;
  asset.triangle({{"name", "shelf"}, {"extras", {{"light_group", "evening"}}}});
  asset.doc["extensionsUsed"] = {"KHR_lights_punctual"};
  asset.doc["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"name", "one"}, {"extras", {{"light_group", "cold: blue"}}}}};
  for (const json& extras : {json{{"light_group", "evening"}}, json{{"light_group", 3}}, json{{"other", 1}}})
    asset.doc["scenes"][0]["nodes"].push_back(
        asset.add("nodes", {{"extras", extras}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}));
  Scene scene = asset.load();
  REQUIRE(scene.lights.size() == 3);
  CHECK(scene.lights[0].group == "evening");
  CHECK(scene.lights[1].group == "3");
  CHECK(scene.lights[2].group == scene::group_name("cold: blue"));
  CHECK_THAT(scene.lights[2].group, Catch::StartsWith("cold_ blue~"));
  CHECK(scene.instances[0].group == "evening");
  const json described = json::parse(scene::describe(scene).dump());
  CHECK(described["light_groups"][0] == json{{"name", "evening"}, {"lamps", 1}, {"surfaces", 0}});
  CHECK_THAT(scene::describe_text(scene), Contains("light groups 3\n  evening: 1 lamp\n"));

  asset.doc["nodes"][1]["extras"]["light_group"] = json::array();
  CHECK_THROWS_WITH(asset.load(),
                    Contains("nodes[1].extras.light_group") && Contains("name of a light group"));
}

}  // namespace scene_light_groups_tests
