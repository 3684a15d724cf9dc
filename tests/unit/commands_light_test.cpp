// links: commands
// Light edits by command: lamps, emissive materials, the environment, the light mix.
#include "base/blackbody.h"
#include "base/color.h"
#include "commands/text.h"
#include "unit/workspace_bench.h"

namespace commands_light_tests {

using namespace lucerna;
using namespace lucerna::commands;
using namespace lucerna::test;
using Catch::Contains;

TEST_CASE("materials are edited like lights, and keep properties that are not given") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  REQUIRE(before.materials.size() == b.work.open.scene->materials.size());
  b.run("material.set 1 color=0.1,0.2,0.3 roughness=0.25");
  b.run("material.set 1 metallic=1 emission=0,2,0");
  const scene::Material m = b.work.open.material(0);
  CHECK(vec3(m.base_color) == vec3(0.1f, 0.2f, 0.3f));
  CHECK(m.base_color.w == b.work.open.scene->materials[0].base_color.w);
  CHECK(m.roughness == 0.25f);
  CHECK(m.metallic == 1);
  CHECK(m.emission == vec3(0, 2, 0));
  REQUIRE(b.settled());
  CHECK(b.session.scene()->materials[0].roughness == 0.25f);
  b.run("undo"), b.run("undo");
  CHECK(b.work.open.document() == before);
  REQUIRE(b.settled());
  const std::string count = std::to_string(before.materials.size());
  CHECK_THAT(b.failure("material.set 99 metallic=1"),
             Contains("there is no material 99; the scene has " + count));
  CHECK_THAT(b.failure("material.set marmalade metallic=1"),
             Contains("the scene has no material 'marmalade'"));
  CHECK_THAT(b.failure("material.set 1 color=1,2,0"), Contains("color"));
}

TEST_CASE("a lamp's colour, power, cone, position and direction are edited") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  // A sun by its position in the sky: from the east and 30 degrees up.
  const vec3 noon = b.work.open.light(0).intensity;
  b.run("light.set Sun azimuth=90 elevation=30 kelvin=5000");
  const scene::Light sun = b.work.open.light(0);
  CHECK(glm::length(sun.direction - vec3(-std::cos(k_pi / 6), -0.5f, 0)) < 1e-6f);
  // A temperature keeps the illuminance.
  CHECK(luminance(sun.intensity) == Approx(luminance(noon)));
  CHECK(glm::length(tint_of(sun.intensity) - blackbody_color(5000)) < 1e-5f);
  b.run("light.set Sun azimuth=180");  // from the south; its elevation stays
  CHECK(glm::length(b.work.open.light(0).direction - vec3(0, -0.5f, -std::cos(k_pi / 6))) < 1e-6f);
  // A point lamp: 100 W in all directions.
  b.run("light.set 2 power=100 position=1,2,3");
  CHECK(b.work.open.light(1).intensity.x == Approx(100 / (4 * k_pi)));
  CHECK(b.work.open.light(1).intensity.y / b.work.open.light(1).intensity.x ==
        Approx(9.0 / 12));  // the colour stays
  CHECK(b.work.open.light(1).position == vec3(1, 2, 3));
  // A spot: the integral over its cone, by quadrature of the shader's formula.
  b.run("light.set 3 cone=40 inner_cone=20 power=10 direction=0,-2,0");
  const scene::Light spot = b.work.open.light(2);
  double sr = 0;
  const double inner = std::cos(20 * k_pi / 180), outer = std::cos(40 * k_pi / 180);
  for (int i = 0; i < 20000; ++i) {
    const double fade = std::clamp(((i + 0.5) / 20000 - outer) / (inner - outer), 0.0, 1.0);
    sr += 2 * double{k_pi} * fade * fade / 20000;
  }
  CHECK(spot.intensity.x * sr == Approx(10).epsilon(1e-4));
  CHECK(spot.direction == vec3(0, -1, 0));
  b.run("light.set 3 cone=10");  // reduces the inner cone too
  CHECK(b.work.open.light(2).inner_cone == b.work.open.light(2).outer_cone);
  b.run("light.set 3 inner_cone=15");
  CHECK(b.work.open.light(2).outer_cone * 180 / k_pi == Approx(15));
  REQUIRE(b.settled());
  CHECK(b.session.scene()->lights[1].position == vec3(1, 2, 3));
  for (int i = 0; i < 6; ++i) b.run("undo");
  CHECK(b.work.open.document() == before);
  REQUIRE(b.settled());

  for (const char* kelvin : {"0", "999", "-5", "nan", "inf", "1e9", "warm"})
    CHECK_THAT(b.failure(std::string("light.set 1 kelvin=") + kelvin),
               Contains(std::string("light.set: kelvin = '") + kelvin +
                        "': expected a number from 1000 to 40000 K"));
  CHECK_THAT(b.failure("light.set 1 elevation=91"), Contains("from -90 to 90 degrees"));
  CHECK_THAT(b.failure("light.set 1 power=3"), Contains("power: a sun shines from infinitely far"));
  CHECK_THAT(b.failure("light.set 1 position=0,0,0"), Contains("position: a sun is infinitely far"));
  CHECK_THAT(b.failure("light.set 2 azimuth=3"), Contains("azimuth: a point lamp shines in all directions"));
  CHECK_THAT(b.failure("light.set 2 cone=30"), Contains("cone: a point lamp has no cone"));
  CHECK_THAT(b.failure("light.set 3 cone=0"), Contains("from 0.01 to 90 degrees"));
  CHECK_THAT(b.failure("light.set 3 cone=10 inner_cone=20"), Contains("inner_cone: 20 degrees is more than"));
  CHECK_THAT(b.failure("light.set 3 direction=0,0,0"), Contains("direction: its length is 0"));
  CHECK_THAT(b.failure("light.set 3 direction=0,1,0 azimuth=3"),
             Contains("direction and azimuth exclude each other"));
  CHECK_THAT(b.failure("light.set 2 color=1,1,1 kelvin=3000"),
             Contains("color and kelvin exclude each other"));
  CHECK_THAT(b.failure("light.set 2 intensity=1 power=3"),
             Contains("intensity and power exclude each other"));
  CHECK_THAT(b.failure("light.set 2 position=0,nan,0"), Contains("position"));
  CHECK(b.work.open.document() == before);
}

TEST_CASE("strengths of lights are read and set in units, which change no light") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  const auto value = [&](const std::string& what) {
    std::vector<std::string> words;
    for (const Word& w : split(what)) words.push_back(w.text);
    return std::stod(b.work.values.read(b.work, b.work.values.take(words)));
  };
  for (const char* unit : {"lm", "lx distance=2", "watts", "nits", "cd"}) {
    b.run(std::string("light.unit ") + unit);
    CHECK(b.work.open.document() == before);
  }
  CHECK(b.work.history.undo_steps() == 0);
  CHECK(value("light.distance") == 2);
  // What is read and given again changes nothing.
  const auto text = [&](const std::string& what) {
    std::vector<std::string> words{"light", "3", what};
    return b.work.values.read(b.work, b.work.values.take(words));
  };
  for (const std::string unit : {"cd", "lm", "lx", "watts"}) {
    b.run("light.set 3 " + unit + "=" + text(unit));
    CHECK(b.work.open.document() == before);
  }
  b.run("light.set 2 lm=806 kelvin=2700");
  CHECK(value("light 2 lm") == Approx(806));
  CHECK(value("light 2 cd") == Approx(806 / (4 * k_pi)));
  CHECK(value("light 2 lx") == Approx(806 / (16 * k_pi)));
  CHECK(value("light 2 watts") == Approx(806 / 683.0));
  CHECK(glm::length(tint_of(b.work.open.light(1).intensity) - blackbody_color(2700)) < 1e-5f);
  b.run("light.set 2 lx=100 distance=0.5");
  CHECK(value("light 2 cd") == Approx(25));
  b.run("light.set 1 lx=5000");
  CHECK(value("light 1 lx") == Approx(5000));
  b.run("light.add rectangle width=2 height=0.5 nits=300 color=1,1,1 position=0,1,0 name=Panel");
  CHECK(value("light Panel cd") == Approx(300));
  CHECK(value("light Panel lm") == Approx(300 * k_pi));
  b.run("material.set 1 nits=1000");
  CHECK(value("material 1 nits") == Approx(1000));
  b.run("material.set 1 lm=50");
  CHECK(value("material 1 lm") == Approx(50));
  CHECK(value("material 1 watts") == Approx(50 / 683.0));
  for (int i = 0; i < 6; ++i) b.run("undo");
  CHECK(b.work.open.document() == before);

  CHECK_THAT(b.failure("light.set 1 lm=3"), Contains("lm: a sun shines from infinitely far: give lx"));
  CHECK_THAT(b.failure("light.set 1 lx=3 distance=2"), Contains("distance: a sun is as strong at any"));
  CHECK_THAT(b.failure("light.set 2 nits=3"), Contains("nits: a point lamp has no shape"));
  CHECK_THAT(b.failure("light.set 2 cd=3 lm=3"), Contains("cd and lm exclude each other"));
  CHECK_THAT(b.failure("light.set 2 power=3 lm=3"), Contains("power and lm exclude each other"));
  CHECK_THAT(b.failure("light.set 2 cd=3 distance=1"), Contains("distance: it counts for lx only"));
  CHECK_THAT(b.failure("light.set 2 cd=-3"), Contains("cd = '-3': expected a number"));
  CHECK_THAT(b.failure("light.set 2 lm=1e12"), Contains("makes the strongest channel more than"));
  CHECK_THAT(b.failure("light.set 2 lx=nan"), Contains("lx"));
  CHECK_THAT(b.failure("light.set 2 lx=1 distance=0"), Contains("distance"));
  CHECK_THAT(b.failure("light.unit candles"), Contains("expected one of cd, lm, lx, watts, nits"));
  CHECK_THAT(b.failure("material.set 1 lm=1 strength=1"), Contains("strength and lm exclude each other"));
  CHECK_THAT(b.failure("material.set Filament lm=1"), Contains("lm: no surface has this material"));
  CHECK_THAT(b.failure("get light 1 cd"), Contains("a sun has no cd"));
  CHECK_THAT(b.failure("get light 2 mood"), Contains("lm"));
  CHECK(b.work.open.document() == before);
}

TEST_CASE("a surface's emission is edited like a lamp, and switched off without losing its values") {
  WorkspaceBench b;
  b.open();
  const Document before = b.work.open.document();
  b.run("material.set Filament strength=80");
  CHECK(b.work.open.material(4).emission == vec3(80, 56, 24));
  b.run("material.set Filament kelvin=2700");
  const vec3 warm = b.work.open.material(4).emission;
  CHECK(luminance(warm) == Approx(luminance(vec3(80, 56, 24))));
  CHECK(glm::length(tint_of(warm) - blackbody_color(2700)) < 1e-5f);
  b.run("material.set Filament strength=80");
  b.run("material.set Filament emission_color=0,0.5,0.25");
  CHECK(b.work.open.material(4).emission == vec3(0, 80, 40));
  b.run("material.set Filament on=off");
  CHECK_FALSE(b.work.open.emits(4));
  CHECK(b.work.open.material(4).emission == vec3(0));
  CHECK(b.work.open.emission(4) == vec3(0, 80, 40));
  CHECK(b.work.open.edited_scene().materials[4].off_emission == vec3(0, 80, 40));
  REQUIRE(b.settled());
  CHECK(b.session.scene()->materials[4].emission == vec3(0));
  b.run("material.set Filament strength=8");  // while it is off
  CHECK(b.work.open.material(4).emission == vec3(0));
  b.run("material.set Filament on=on");
  CHECK(b.work.open.material(4).emission == vec3(0, 8, 4));
  CHECK(b.work.open.edited_scene().materials[4].off_emission == vec3(0));
  REQUIRE(b.settled());
  CHECK(b.session.scene()->materials[4].emission == vec3(0, 8, 4));
  for (int i = 0; i < 3; ++i) b.run("undo");
  CHECK(b.work.open.emission(4) == vec3(0, 80, 40));
  CHECK(b.work.open.emits(4));
  for (int i = 0; i < 4; ++i) b.run("undo");
  CHECK(b.work.open.document() == before);
  b.run("material.set 1 strength=2");  // it was dark: white
  CHECK(b.work.open.material(0).emission == vec3(2));
  CHECK_THAT(b.failure("material.set Filament kelvin=0"), Contains("expected a number from 1000 to 40000 K"));
  CHECK_THAT(b.failure("material.set Filament strength=-1"), Contains("strength"));
  CHECK_THAT(b.failure("material.set Filament emission=1,1,1 strength=2"),
             Contains("emission and strength exclude each other"));
  CHECK_THAT(b.failure("material.set Filament emission_color=0,0,0"), Contains("at least one channel"));
}

TEST_CASE("a dropped image lights the scene until undone, unless it cannot be read") {
  WorkspaceBench b;
  b.open();
  const auto folder = std::filesystem::temp_directory_path();
  const auto file = folder / ("lucerna-sky-" + std::to_string(getpid()) + ".exr");
  const auto broken = folder / ("lucerna-broken-" + std::to_string(getpid()) + ".hdr");
  std::ofstream(file) << "x";
  std::ofstream(broken) << "x";
  const scene::Environment own = b.work.open.scene->environment;
  b.run("environment.set scale=3 rotation=45");
  b.run("environment.load " + quote(file.string()));
  CHECK(b.work.open.environment_file() == file.string());
  CHECK(b.work.open.environment_scale() == 1);
  CHECK(b.work.open.environment_rotation() == 0);
  REQUIRE(b.settled());
  REQUIRE(b.until([&] { return b.work.open.scene->environment.file == file.string(); }));
  b.run("undo");
  CHECK(b.work.open.environment_scale() == 3);
  CHECK(b.work.open.environment_file().empty());
  REQUIRE(b.until([&] { return b.work.open.scene->environment.file == "sky/late_morning_2k.exr"; }));
  b.run("redo");
  REQUIRE(b.until([&] { return b.work.open.scene->environment.file == file.string(); }));
  b.run("environment.own");
  REQUIRE(b.until([&] { return b.work.open.scene->environment.file != file.string(); }));
  // Scale and rotation are the scene's, not those of the previous image.
  REQUIRE(b.settled());
  CHECK(b.work.open.environment_scale() == own.scale);
  CHECK(b.work.open.environment_rotation() == own.rotation);
  CHECK(b.work.open.scene->environment.scale == own.scale);
  CHECK(b.errors == 0);
  b.run("environment.load " + quote(broken.string()));
  REQUIRE(b.until([&] { return b.work.open.environment_file().empty(); }));
  CHECK(b.errors == 1);

  // A refused file leaves light, undo and script unchanged.
  b.run("environment.load " + quote(file.string()));
  b.run("environment.set scale=3 rotation=45");
  const std::string undone = b.work.history.undo_text();
  const auto script = b.work.history.script();
  b.run("environment.load " + quote(broken.string()));
  b.run("light.set 1 intensity=7");
  REQUIRE(b.until([&] { return b.errors == 2 && b.work.open.environment_file() == file.string(); }));
  REQUIRE(b.settled());
  CHECK(b.work.open.environment_scale() == 3);
  CHECK(b.work.open.environment_rotation() == 45);
  CHECK(b.work.history.script().size() == script.size() + 1);
  b.run("undo");
  CHECK(b.work.history.undo_text() == undone);
  CHECK(b.work.open.environment_file() == file.string());
  b.run("redo"), b.run("undo"), b.run("undo");
  REQUIRE(b.settled());
  CHECK(b.errors == 2);
  CHECK(b.work.open.scene->environment.file == file.string());
  b.run("environment.own");
  REQUIRE(b.until([&] { return b.work.open.scene->environment.file != file.string(); }));
  // Two loads in progress: the last readable one wins.
  b.run("environment.load " + quote(file.string())), b.run("environment.load " + quote(broken.string()));
  REQUIRE(b.until([&] { return b.errors == 3 && b.work.open.environment_file() == file.string(); }));
  b.run("environment.own"), b.run("environment.load " + quote(broken.string()));
  REQUIRE(b.until([&] { return b.errors == 4 && b.work.open.environment_file().empty(); }));
  CHECK_THAT(b.failure("environment.load /no/such/sky.hdr"), Contains("/no/such/sky.hdr: no such file"));
  std::filesystem::remove(file), std::filesystem::remove(broken);
}

TEST_CASE("a light mix is set, kept, blended, undone and written into the lights") {
  WorkspaceBench b;
  b.open();
  REQUIRE(b.work.open.light_groups().groups.size() == 4);
  const std::string reading = b.work.open.scene->lights[2].name;
  CHECK(b.work.open.light_groups().groups[3].name == reading);
  b.run("mix.set \"Brass lamp\" ev=1.5 kelvin=2700");
  CHECK(b.work.open.light_mix().at("Brass lamp").ev == 1.5f);
  CHECK(b.work.open.light_mix().at("Brass lamp").color == blackbody_color(2700));
  b.run("mix.set sky mute=true");
  b.run("mix.set \"Brass lamp\" color=1,0.5,0");
  CHECK(b.work.open.setting("relight.mix") == "Brass lamp: ev=1.5 color=1,0.5,0; sky: mute");
  b.run("mix.preset.save evening");
  b.run("mix.reset");
  CHECK(b.work.open.setting("relight.mix").empty());
  b.run("mix.set Sun factor=0");
  CHECK(b.work.open.light_mix().at("Sun").mute);
  b.run("mix.set Sun factor=4");
  CHECK(b.work.open.light_mix().at("Sun") == scene::GroupMix{.ev = 2});
  b.run("mix.preset.save morning");
  b.run("mix.preset.blend evening morning 0");
  CHECK(b.work.open.setting("relight.mix") == "Brass lamp: ev=1.5 color=1,0.5,0; sky: mute");
  b.run("mix.preset.blend evening morning 0.5");
  const std::vector<vec3> half = scene::mix_weights(b.work.open.light_mix(), b.work.open.light_groups());
  CHECK(half[0].x == Approx(0.5));  // the sky
  CHECK(half[1].x == Approx(2.5));
  REQUIRE(b.settled());
  CHECK(b.session.settings().text("relight.mix") == b.work.open.setting("relight.mix"));

  // The steps of a drag are one undo step.
  const std::string before = b.work.open.setting("relight.mix");
  for (const char* ev : {"1", "2", "3"}) b.run(std::string("mix.set Sun ev=") + ev, 7);
  CHECK(b.work.open.light_mix().at("Sun").ev == 3);
  b.run("undo");
  CHECK(b.work.open.setting("relight.mix") == before);

  // An invalid command is reported, and changes nothing.
  CHECK_THAT(b.failure("mix.set Moon ev=1"), Contains("'Moon'") && Contains("sky, Sun, Brass lamp"));
  CHECK_THAT(b.failure("mix.set sky kelvin=0"), Contains("kelvin"));
  CHECK_THAT(b.failure("mix.set sky ev=1 factor=2"), Contains("exclude"));
  CHECK_THAT(b.failure("mix.preset.load noon"), Contains("'noon'") && Contains("evening, morning"));
  CHECK(b.work.open.setting("relight.mix") == before);
  // Group rules use = and ; as separators, so the wildcard ? replaces them in names.
  b.run("mix.group \"a=b; c\" d");
  CHECK_THAT(b.work.open.setting("relight.groups"), Contains("a?b? c=d"));
  b.run("undo");
  b.run("mix.preset.delete morning");
  CHECK(b.work.open.mix_presets().size() == 1);
  // A preset of another scene: the groups that exist here are applied.
  b.run("set relight.presets \"other = Chandelier: mute; Sun: ev=-1\"");
  b.run("mix.preset.load other");
  CHECK(scene::mix_weights(b.work.open.light_mix(), b.work.open.light_groups())[1] == vec3(0.5f));

  // Into the lights: a muted lamp is switched off, an environment has no colour.
  b.run("set relight.mix \"Sun: ev=1 color=1,0.5,1; Brass lamp: mute; sky: color=1,0.5,0.5\"");
  const Document unmixed = b.work.open.document();
  b.run("mix.apply");
  CHECK(b.work.open.light(0).intensity == unmixed.lights[0].intensity * vec3(2, 1, 2));
  CHECK_FALSE(b.work.open.light(1).enabled);
  CHECK(b.work.open.light(1).intensity == unmixed.lights[1].intensity);
  CHECK(b.work.open.light(2).intensity == unmixed.lights[2].intensity);
  CHECK(b.work.open.environment_scale() == unmixed.environment_scale);
  CHECK(b.work.open.setting("relight.mix") == "sky: color=1,0.5,0.5");
  REQUIRE(b.settled());
  b.run("undo");
  CHECK(b.work.open.document() == unmixed);
  b.run("set relight.mix \"sky: ev=-2\"");
  b.run("mix.apply");
  CHECK(b.work.open.environment_scale() == 0.25f * unmixed.environment_scale);
  CHECK(b.work.open.setting("relight.mix").empty());

  b.run("mix.group *lamp* lamps");
  CHECK(b.work.open.light_groups().groups.size() == 3);
  CHECK(b.work.open.light_groups().groups[2].name == "lamps");
  CHECK(b.work.open.light_groups().groups[2].lamps == 2);
}

}  // namespace commands_light_tests
