// links: session
// Compact per-group light (relight.enabled=compact), compared with per-group light by component and with a
// new render: unmixed it equals, bit for bit, the picture without groups; under any mix light and noise are
// within 0.02 % of the exact values; the result does not depend on earlier mixes, and no ray is traced.
#include <catch2/catch.hpp>

#include "film/io/image_file.h"
#include "images/light_mix_support.h"
#include "support/folder.h"

namespace light_mix_compact_tests {

using namespace lucerna;
using namespace lucerna::test;
using Catch::Matchers::Contains;

namespace {

const Settings k_compact = {{"relight.enabled", "compact"}};

Settings compact(Settings more) {
  more.insert(k_compact.begin(), k_compact.end());
  return more;
}

const char* const k_mixes[] = {
    "sky: mute",
    "lamp: solo",
    "block: solo",
    "lamp: factor=10000",
    "lamp: solo factor=10000",
    "sky: solo factor=0.0001",
    "lamp: factor=0.0001; sun: factor=0.0001",
    "lamp: mute; sun: mute; sky: mute",
    "sky: color=1,0.2,0.1; sun: kelvin=2500; lamp: kelvin=9000 ev=1.3; block: color=0.3,0.1,1"};

/// The largest difference between two pictures of all components, relative to the pixel's brightest channel.
double worst_share(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double scale = std::max({double{b[i].x}, double{b[i].y}, double{b[i].z}, 1e-20});
      worst = std::max(worst, std::abs(double{a[i][k]} - double{b[i][k]}) / scale);
    }
  return worst;
}

}  // namespace

TEST_CASE("unmixed compact light equals the picture without groups bit for bit, noise included") {
  const scene::Scene even = block_room(true);  // no sun, which would be a separate light
  Bench separate(even, k_compact), together(even, {{"relight.enabled", "off"}});
  const film::Image a = separate.image(), b = together.image();
  CHECK(separate.r.relight().separate);
  CHECK(separate.r.film().is_compact());
  CHECK(separate.r.film().groups() > 1);
  CHECK(identical(a, b));
  CHECK(separate.r.image_error().rms == together.r.image_error().rms);
  CHECK(separate.r.stats().rays == together.r.stats().rays);
  CHECK(separate.r.device().validation_messages() == 0);
  // With a sun: other samples of the same light.
  Bench with_sun(room(), k_compact), without(room(), {{"relight.enabled", "off"}});
  const film::Image c = with_sun.image();
  CHECK(worst_z(c, without.image()) < 5.5);
}

TEST_CASE("a mix of compact light equals that of light by component within 0.02 %, and so does its noise") {
  constexpr double k_share = 2e-4;
  Bench exact(room(), {}, 64), compact(room(), k_compact, 64);
  exact.image(), compact.image();
  CHECK_FALSE(exact.r.film().is_compact());
  CHECK(compact.r.film().is_compact());
  double most = 0;
  for (const char* text : k_mixes) {
    INFO(text);
    exact.mix(text), compact.mix(text);
    const film::Image a = compact.r.image(), b = exact.r.image();
    const double off = worst_share(all_components(a, false), all_components(b, false)),
                 odd_off = worst_share(all_components(a, true), all_components(b, true));
    CHECK(off < k_share);
    CHECK(odd_off < k_share);
    most = std::max(most, off);
    // The reported noise and brightness of the picture.
    const film::ImageError reported = compact.r.image_error(), right = exact.r.image_error();
    CHECK(reported.rms[0] == Approx(right.rms[0]).epsilon(1e-3));
    CHECK(reported.luminance[0] == Approx(right.luminance[0]).epsilon(k_share));
    // Components are estimates; their sum never exceeds the picture, because they are shares of it.
    double sum = 0;
    for (size_t c = 1; c < reported.luminance.size(); ++c) sum += reported.luminance[c];
    CHECK(sum == Approx(reported.luminance[0]).epsilon(1e-4));
  }
  CHECK(most > 0);  // otherwise no light was compact
}

TEST_CASE("a mix of compact light equals a new render, statistically") {
  const scene::Scene s = room();
  Bench b(s, compact({{"seed", "1"}}), 64);
  b.image();
  for (const char* text : {"sky: mute", "lamp: solo factor=10000", k_mixes[8]}) {
    INFO(text);
    b.mix(text);
    const scene::LightMix mix = scene::parse_mix(text);
    Bench rendered(scene::mixed_scene(s, groups_of_room(), mix), {{"seed", "2"}, {"relight.enabled", "off"}},
                   64);
    CHECK(worst_z(as_one_component(b.r.image()), as_one_component(rendered.image())) < 5.5);
  }
}

TEST_CASE("a mix of compact light traces no ray and does not depend on earlier mixes") {
  Bench b(room(), k_compact);
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
  Bench early(room(), compact({{"relight.mix", "lamp: ev=2; sky: mute"}}));
  CHECK(identical(early.image(), mixed));
  Bench between(room(), compact({{"path.batch", "2048"}}));  // and in other batches
  for (int i = 0; i < 3; ++i) between.r.step();
  between.mix("lamp: ev=2; sky: mute");
  CHECK(identical(between.image(), mixed));
  // Without any light the picture is black.
  b.mix("sky: mute; sun: mute; lamp: mute; spot: mute; block: mute");
  for (const auto& component : b.r.image().components)
    CHECK(std::all_of(component.begin(), component.end(), [](const vec3& v) { return v == vec3(0); }));
}

TEST_CASE("the picture shown immediately after a mix equals the one developed later") {
  session::RendererOptions options = renderer_options(true);
  options.interactive = true;
  session::Renderer r(options);
  r.set_size(48, 32);
  // auto: the window stores compact per-group light.
  r.set_scene(std::make_shared<scene::Scene>(room()), {},
              {{"samples", "16", ""}, {"path.max_depth", "8", ""}});
  while (r.step()) {
  }
  REQUIRE(r.film().is_compact());
  REQUIRE(r.film().quick());
  r.settings().set("relight.mix", "lamp: ev=1 color=1,0.4,0.2; sun: mute");
  const std::vector<uint8_t> before = r.output().shown_picture(false);
  r.apply_settings();
  const std::vector<uint8_t> at_once = r.output().shown_picture(false);
  r.mix().settle();
  const std::vector<uint8_t> settled = r.output().shown_picture(false);
  REQUIRE(at_once.size() == settled.size());
  CHECK(at_once != before);
  int worst = 0;
  for (size_t i = 0; i < settled.size(); ++i)
    worst = std::max(worst, std::abs(int{at_once[i]} - int{settled[i]}));
  CHECK(worst <= 1);
  CHECK(r.stats().dropped == 0);
}

TEST_CASE("sun and environment are separate groups in compact light") {
  scene::Scene s = room();
  s.lights.clear();  // no other lights
  s.materials[1].emission = vec3(0);
  const scene::LightGroups groups = scene::group_lights(s);
  Bench b(s, compact({{"seed", "1"}}), 64);
  const film::Image whole = as_one_component(b.image());
  REQUIRE(b.r.film().is_compact());
  film::Image solo[2];
  for (const int k : {0, 1}) {
    const char* text = k == 0 ? "sky: solo" : "sun: solo";
    INFO(text);
    b.mix(text);
    solo[k] = as_one_component(b.r.image());
    const scene::Scene alone = scene::mixed_scene(s, groups, scene::parse_mix(text));
    Bench rendered(alone, {{"seed", "2"}, {"relight.enabled", "off"}}, 64);
    CHECK(worst_z(solo[k], as_one_component(rendered.image())) < 5.5);
  }
  CHECK(worst_z(solo[0], solo[1]) > 20);  // otherwise a mix-up would not show
  film::Image both = solo[0];
  for (size_t i = 0; i < both.samples.size(); ++i) both.components[0][i] += solo[1].components[0][i];
  CHECK(worst_share(both.components[0], whole.components[0]) < 2e-4);
}

TEST_CASE("preview samples of compact light are mixed like the picture") {
  const scene::Scene s = room();
  const std::vector<vec3> weights = scene::mix_weights(
      scene::parse_mix("lamp: ev=1 color=1,0.4,0.2; sun: mute; sky: ev=-3"), groups_of_room());
  const film::Image a = trace(s, s, weights, 4, film::GroupStorage::compact, true),
                    b = trace(s, s, weights, 4, film::GroupStorage::by_component, true);
  CHECK(worst_share(all_components(a, false), all_components(b, false)) < 1e-5);
  const film::Image neutral =
      trace(s, s, std::vector<vec3>(5, vec3(1)), 4, film::GroupStorage::compact, true);
  CHECK(worst_share(all_components(a, false), all_components(neutral, false)) > 0.1);
}

TEST_CASE("layers by group sum to the picture within 0.2 %") {
  const Folder folder;
  Bench b(room(), compact({{"relight.layers", "true"},
                           {"relight.mix", "lamp: ev=1.3 color=1,0.8,0.3; sun: ev=-2; sky: mute"}}));
  b.image();
  b.r.output().save(folder / "a.exr");
  const film::FilmImage file = film::read_exr(folder / "a.exr");
  for (int k = 0; k < 3; ++k) {
    const char channel = "RGB"[k];
    const std::vector<float>& picture = *file.find(std::string(1, channel));
    std::vector<double> sum(picture.size());
    for (const char* group : {"sky", "sun", "lamp", "spot", "block"}) {
      const std::vector<float>* layer = file.find(fmt::format("light.{}.{}", group, channel));
      REQUIRE(layer);
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += double{(*layer)[i]};
    }
    double worst = 0;
    for (size_t i = 0; i < sum.size(); ++i)
      worst = std::max(worst, std::abs(sum[i] - double{picture[i]}) / std::max(1e-3, double{picture[i]}));
    CHECK(worst < 0.002);
    CHECK(worst > 0);
  }
}

TEST_CASE("per-group light takes 16 bytes per pixel and group, 128 for eight") {
  CHECK(film::sum_bytes(8, film::GroupStorage::compact) - film::sum_bytes(1) == 128);
  CHECK(film::sum_bytes(1, film::GroupStorage::compact) == film::sum_bytes(1));
}

TEST_CASE("the window stores compact light by default, batch renders store none; each can be changed") {
  for (const bool interactive : {false, true}) {
    session::RendererOptions options = renderer_options(true);
    options.interactive = interactive;
    session::Renderer r(options);
    r.set_size(16, 16);
    r.set_scene(std::make_shared<scene::Scene>(room()), {}, {{"samples", "2", ""}});
    CHECK(r.film().is_compact() == interactive);
    CHECK(r.relight().separate == interactive);
    finish(r);
    for (const char* how : {"on", "compact", "off", "auto"}) {
      INFO(how);
      const uint64_t restarts = r.restarts();
      const bool separate = r.relight().separate, compact = r.film().is_compact();
      set(r, {{"relight.enabled", how}});
      const bool wants = how == std::string("on") || how == std::string("compact") ||
                         (how == std::string("auto") && interactive);
      CHECK(r.relight().separate == wants);
      CHECK((r.film().groups() > 1) == wants);
      CHECK(r.film().is_compact() == (wants && how != std::string("on")));
      if (separate != wants || compact != r.film().is_compact()) CHECK(r.restarts() > restarts);
      CHECK(finish(r).samples[0] == 2);
    }
    CHECK(r.device().validation_messages() == 0);
  }
}

}  // namespace light_mix_compact_tests
