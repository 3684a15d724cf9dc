// links: session
// Per-group light and mixes of it, compared with a new render: bit for bit where weights are powers of two or
// zero, otherwise statistically. No ray is traced, a muted group is gone and nothing else, and layers sum to
// the picture.
#include <catch2/catch.hpp>

#include "base/blackbody.h"
#include "film/io/image_file.h"
#include "images/light_mix_support.h"
#include "session/accuracy.h"
#include "support/folder.h"

namespace light_mix_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;

TEST_CASE("a mix by powers of two and zero equals the picture of such lights bit for bit") {
  const scene::Scene s = room();
  const scene::LightGroups& groups = groups_of_room();
  REQUIRE(groups.groups.size() == 5);
  const std::vector<vec3> as_they_are(5, vec3(1));
  const char* mixes[] = {"sky: mute",
                         "sun: mute; lamp: ev=3",
                         "lamp: mute; block: ev=-4",
                         "spot: solo",
                         "block: solo ev=13; sky: ev=2",
                         "sky: ev=-13; sun: ev=13; lamp: color=1,0.5,0; spot: color=0,4,0.125; block: ev=1"};
  const film::Image neutral = trace(s, s, as_they_are);
  for (const char* text : mixes) {
    INFO(text);
    const scene::LightMix mix = scene::parse_mix(text);
    const scene::Scene shining = scene::mixed_scene(s, groups, mix);
    const film::Image rendered = trace(s, shining, as_they_are),
                      mixed = trace(s, s, scene::mix_weights(mix, groups));
    CHECK(identical(mixed, rendered));
    CHECK_FALSE(identical(mixed, neutral));
  }
}

TEST_CASE("the sum of the groups equals the picture made without groups") {
  const scene::Scene s = room();
  Bench separate(s), together(s, {{"relight.enabled", "off"}});
  const film::Image a = separate.image();
  CHECK(separate.r.relight().separate);
  CHECK_FALSE(together.r.relight().separate);
  CHECK(separate.r.film().groups() == 5);
  CHECK(together.r.film().groups() == 1);
  // The environment's sun is a separate light in per-group light: other samples, the same light.
  CHECK(worst_z(a, together.image()) < 5.5);
  // Without a sun the samples are the same; only the rounding of sums differs.
  scene::Scene even = block_room(true);
  Bench apart_too(even), together_too(even, {{"relight.enabled", "off"}});
  const film::Image b = apart_too.image();
  CHECK(difference(b, together_too.image()) < 1e-6);
  CHECK(apart_too.r.stats().rays == together_too.r.stats().rays);
}

TEST_CASE("a directly visible sun of the environment belongs to its own group") {
  scene::Scene s = room();
  // From above the room, towards the sun's texel.
  const float theta = 3.5f / 16 * k_pi, phi = (9.5f / 32 - 0.5f) * 2 * k_pi;
  const vec3 towards(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  const vec3 right = glm::normalize(glm::cross(towards, vec3(0, 1, 0))), up = glm::cross(right, towards);
  s.cameras[0].to_world = mat4(vec4(right, 0), vec4(up, 0), vec4(-towards, 0), vec4(0, 10, 0, 1));
  Bench separate(s), together(s, {{"relight.enabled", "off"}});
  const film::Image a = separate.image();
  CHECK(difference(a, together.image()) < 1e-6);
  const double all = mean(a.components[0]);
  separate.mix("sun: solo");
  CHECK(mean(separate.r.image().components[0]) > 0.5 * all);
  separate.mix("sun: mute");
  CHECK(mean(separate.r.image().components[0]) < 0.5 * all);
}

TEST_CASE("a single light group costs nothing and changes no bit") {
  const scene::Scene s = room();
  Bench off(s, {{"relight.enabled", "off"}}), one(s, {{"relight.groups", "*=all"}});
  CHECK(one.r.relight().groups->groups.size() == 1);
  CHECK(one.r.relight().separate);
  const film::Image image = one.image();
  CHECK(identical(off.image(), image));
  CHECK(one.r.film().groups() == 1);
}

TEST_CASE("light of one group is mixed without a ray, for every solver") {
  scene::Scene s = room();
  const char* const text = "all: ev=1 color=1,0.5,0.25";
  for (const Settings& how :
       {Settings{}, Settings{{"components.secondary", "cache"}, {"components.tertiary", "cache"}},
        Settings{{"components.caustic", "light"}},
        Settings{{"components.secondary", "photons"}, {"photons.efficiency", "false"}}}) {
    Settings all = how;
    all["relight.groups"] = "*=all";
    Bench b(s, all, 4);
    const film::Image before = b.image();
    const double noise = b.r.image_error().relative(0);
    const uint64_t rays = b.r.stats().rays, restarts = b.r.restarts();
    b.mix(text);
    const film::Image after = b.r.image();
    size_t off = 0;
    for (const int c : k_components)
      for (size_t i = 0; i < before.samples.size(); ++i)
        off += after.components[c][i] != vec3(2, 1, 0.5f) * before.components[c][i] ||
               after.odd_half[c][i] != vec3(2, 1, 0.5f) * before.odd_half[c][i];
    CHECK(off == 0);
    CHECK(b.r.image_error().luminance[0] > 0);
    CHECK(b.r.stats().rays == rays);
    CHECK(b.r.restarts() == restarts);
    b.mix("all: ev=3");
    CHECK(b.r.image_error().relative(0) == Approx(noise).epsilon(1e-4));
    // Also if the mix exists from the first sample on.
    all["relight.mix"] = text;
    CHECK(identical(Bench(s, all, 4).image(), after));
    b.mix("all: mute");
    for (const auto& component : b.r.image().components)
      CHECK(std::all_of(component.begin(), component.end(), [](const vec3& v) { return v == vec3(0); }));
  }
}

TEST_CASE("the reported error of a finished picture is that of the displayed mix") {
  Bench b(room());
  session::AccuracyKeeper keeper;
  b.image();
  b.r.finish_ledger();
  const auto reported = [&] {
    keeper.follow(b.r, 1);
    return keeper.publish(b.r, true)->error()[0];
  };
  double last = reported();
  CHECK(last > 0);
  for (const char* text : {"sky: solo", "lamp: solo", "block: solo", ""}) {
    b.mix(text);
    INFO(text);
    CHECK(reported() == Approx(b.r.image_error().seen(0)));
    CHECK(reported() != last);
    last = reported();
  }
}

TEST_CASE("a mix traces no ray, restarts nothing, and does not depend on earlier mixes") {
  Bench b(room());
  const film::Image neutral = b.image();
  const uint64_t rays = b.r.stats().rays, restarts = b.r.restarts();
  b.mix("lamp: ev=2; sky: mute");
  const film::Image mixed = b.r.image();
  CHECK_FALSE(identical(mixed, neutral));
  for (const char* text : {"lamp: ev=-7.3 color=0.1,0.7,0.3", "block: solo", "spot: mute; sun: ev=5"})
    b.mix(text);
  b.mix("lamp: ev=2; sky: mute");
  CHECK(identical(b.r.image(), mixed));
  b.mix("");
  CHECK(identical(b.r.image(), neutral));
  CHECK(b.r.stats().rays == rays);
  CHECK(b.r.restarts() == restarts);
  CHECK(b.r.done());
  CHECK(b.r.device().validation_messages() == 0);
  // The same if the mix existed from the first sample on, or was set in between.
  Bench early(room(), {{"relight.mix", "lamp: ev=2; sky: mute"}});
  CHECK(identical(early.image(), mixed));
  Bench between(room());
  for (int i = 0; i < 3; ++i) between.r.step();
  between.mix("lamp: ev=2; sky: mute");
  CHECK(identical(between.image(), mixed));
}

TEST_CASE("muting removes the group's light and nothing else") {
  Bench b(room());
  const film::Image all = b.image();
  std::vector<ByComponent<std::vector<vec3>>> groups;
  for (uint32_t g = 0; g < b.r.film().groups(); ++g) groups.push_back(b.r.film().read_group(g));
  for (size_t muted = 0; muted < groups.size(); ++muted) {
    b.mix(b.r.relight().groups->groups[muted].name + ": mute");
    const film::Image rest = b.r.image();
    double off = 0, of_group = 0;
    for (const size_t c : k_components)
      for (size_t i = 0; i < all.samples.size(); ++i) {
        const vec3 expected = all.components[c][i] - groups[muted][c][i];
        const vec3 d = rest.components[c][i] - expected;
        off = std::max(off, double(glm::length(d)) / (1e-3 + double(glm::length(all.components[c][i]))));
        of_group += luminance(groups[muted][c][i]);
      }
    INFO(b.r.relight().groups->groups[muted].name);
    CHECK(off < 1e-6);
    CHECK(of_group > 0);
  }
}

TEST_CASE("a mix equals a new render: switches, strengths from 10^-4 to 10^4, colours, environment and sun") {
  // Lights ten thousand times as strong as others leave these too few samples, with selection by power, for a
  // noise estimate: such a mix is compared with a scene without the others.
  const scene::Scene s = room();
  Bench b(s, {{"seed", "1"}}, 64);
  b.image();
  const char* mixes[] = {
      "sky: mute",
      "sun: mute",
      "lamp: solo",
      "block: solo",
      "lamp: solo factor=10000",
      "sky: solo factor=10000",
      "lamp: factor=0.0001; sun: factor=0.0001",
      "sky: color=1,0.2,0.1; sun: kelvin=2500; lamp: kelvin=9000 ev=1.3; block: color=0.3,0.1,1"};
  for (const char* text : mixes) {
    INFO(text);
    b.mix(text);
    const scene::LightMix mix = scene::parse_mix(text);
    Bench rendered(scene::mixed_scene(s, groups_of_room(), mix), {{"seed", "2"}, {"relight.enabled", "off"}},
                   64);
    const film::Image mixed = b.r.image(), other = rendered.image();
    CHECK(worst_z(mixed, other) < 5.5);
    for (const int c : k_components)
      CHECK((mean(mixed.components[c]) > 0) == (mean(other.components[c]) > 0));
  }
}

TEST_CASE("noise is reported for the mixed picture, and adaptive sampling continues if a mix raises it") {
  Bench b(room(), {}, 32);
  b.image();
  for (const char* text : {"lamp: solo", "block: ev=4; sky: mute", ""}) {
    INFO(text);
    b.mix(text);
    const film::ImageError reported = b.r.image_error();
    // Computed here from the halves of the displayed picture.
    const film::Image image = b.r.image();
    double variance = 0, sum = 0;
    for (size_t i = 0; i < image.samples.size(); ++i) {
      double all = 0, odd = 0;
      for (const int c : k_components)
        all += luminance(image.components[c][i]), odd += luminance(image.odd_half[c][i]);
      variance += (all - odd) * (all - odd), sum += all;
    }
    const double n = double(image.samples.size());
    CHECK(reported.luminance[0] == Approx(sum / n).epsilon(1e-4));
    CHECK(reported.rms[0] == Approx(std::sqrt(variance / n)).epsilon(1e-3));
    CHECK(b.r.progress().ledger().entries().back().error[0] == Approx(reported.seen(0)).epsilon(1e-6));
    CHECK(b.r.progress().ledger().entries().size() ==
          (*text || b.r.progress().ledger().entries().size() == 1 ? 1u : 0u));
  }

  // Under the lamp alone the target is reached; the emissive block, which only metal paths hit, needs more.
  Bench adaptive(room(), {{"sampling.mode", "adaptive"},
                          {"sampling.min_samples", "8"},
                          {"sampling.max_samples", "256"},
                          {"sampling.target_error", "0.3"},
                          {"relight.mix", "lamp: solo"}});
  adaptive.image();
  REQUIRE(adaptive.r.done());
  const uint64_t before = adaptive.r.stats().paths;
  adaptive.mix("sun: solo ev=3");
  CHECK_FALSE(adaptive.r.done());
  adaptive.image();
  CHECK(adaptive.r.done());
  CHECK(adaptive.r.stats().paths > before);
}

TEST_CASE("without per-group light a mix edits the lights: bit for bit the picture of such lights") {
  const scene::Scene s = room();
  const std::string text =
      "lamp: ev=1.5 color=1,0.5,0.2; spot: mute; sky: color=0.5,1,1; sun: ev=-1; block: ev=2";
  const scene::Scene shining = scene::mixed_scene(s, groups_of_room(), scene::parse_mix(text));
  for (const Settings& settings :
       {Settings{{"relight.enabled", "off"}},
        Settings{{"components.tertiary", "cache"}, {"cache.rays", "64"}, {"relight.enabled", "on"}}}) {
    Bench mixed(s, settings, 2), made(shining, settings, 2);
    if (settings.size() > 1)
      CHECK_THAT(mixed.r.relight().why_not, Contains("irradiance cache", Catch::CaseSensitive::No));
    mixed.r.step();
    const uint64_t restarts = mixed.r.restarts();
    mixed.mix(text);
    CHECK(mixed.r.restarts() == restarts + 1);
    CHECK(mixed.r.scene()->lights[1].intensity == s.lights[1].intensity);  // the scene itself is unchanged
    const film::Image image = mixed.image();
    if (settings.size() == 1) CHECK(identical(image, made.image()));
    CHECK(worst_z(image, made.image()) < 5.5);
    // Scene edits apply below the mix.
    scene::Light lamp = s.lights[0];
    lamp.intensity *= 2;
    mixed.r.set_light(0, lamp);
    CHECK(mixed.r.scene()->lights[0].intensity == lamp.intensity);
    mixed.mix("");
    CHECK(mixed.r.scene()->lights[1].intensity == s.lights[1].intensity);
  }
}

TEST_CASE("layers by group and component sum to the picture within 0.2 %") {
  const Folder folder;
  Bench b(room(), {{"relight.layers", "true"},
                   {"relight.mix", "lamp: ev=1.3 color=1,0.8,0.3; sun: ev=-2; sky: mute"}});
  b.image();
  b.r.output().save(folder / "a.exr");
  const film::FilmImage file = film::read_exr(folder / "a.exr");
  CHECK_FALSE(file.find("light.sky.primary.R") == nullptr);
  for (int k = 0; k < 3; ++k) {
    const char channel = "RGB"[k];
    const std::vector<float>& picture = *file.find(std::string(1, channel));
    std::vector<double> sum(picture.size());
    size_t layers = 0;
    for (const auto& [name, values] : file.channels)
      if (name.starts_with("light.") && name.back() == channel) {
        ++layers;
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += double{values[i]};
      }
    CHECK(layers > 12);
    double worst = 0;
    for (size_t i = 0; i < sum.size(); ++i)
      worst = std::max(worst, std::abs(sum[i] - double{picture[i]}) / std::max(1e-3, double{picture[i]}));
    CHECK(worst < 0.002);
    CHECK(worst > 0);  // 16-bit floats
  }
}

TEST_CASE("an invalid mix is refused, and the previous one stays") {
  Bench b(room(), {{"relight.mix", "lamp: ev=1"}});
  const film::Image before = b.image();
  for (const char* text :
       {"lamp: ev=x", "lamp", "lamp: kelvin=0", "lamp: ev=99", "lamp: color=1,2", "lamp: loud"}) {
    INFO(text);
    b.r.settings().set("relight.mix", text);
    CHECK_THROWS_WITH(b.r.apply_settings(), Contains("relight.mix"));
    CHECK(b.r.settings().text("relight.mix") == "lamp: ev=1");
    CHECK(identical(b.r.image(), before));
  }
  // A group that no longer exists changes nothing, and is reported.
  b.mix("lamp: ev=1; chandelier: ev=5 solo");
  CHECK(identical(b.r.image(), before));
  REQUIRE(b.r.relight().messages.size() == 1);
  CHECK_THAT(b.r.relight().messages[0], Contains("'chandelier'") && Contains("sky, sun, lamp, spot, block"));
  // Other groups restart the picture.
  const uint64_t restarts = b.r.restarts();
  set(b.r, {{"relight.groups", "lamp=night; spot=night; sun=day; sky=day"}});
  CHECK(b.r.restarts() > restarts);
  CHECK(b.r.film().groups() == 3);
  CHECK(b.image().samples[0] == 16);
}

}  // namespace light_mix_tests
