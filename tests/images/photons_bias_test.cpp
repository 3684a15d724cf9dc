// links: session
// The blur estimate of photons: compared with the closed form for cosine-shaped light; zero for even light,
// up to borders, and zero without photons; and its propagation to all reported errors.
#include <catch2/catch.hpp>
#include <cmath>

#include "film/error.h"
#include "solvers/photons/radius.h"
#include "support/render.h"
#include "support/rooms.h"

namespace photons_bias_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_size = 64;      // pixels along a side of the picture
constexpr double k_pixel = 0.02;     // width of a pixel in metres
constexpr uint32_t k_periods = 3;    // periods of the cosine across the picture
constexpr float k_middle = 0.5f;     // of the mirror's colour
constexpr float k_amplitude = 0.4f;  // amplitude of the cosine

/// A sun along +x that a mirror of 2 x 2 m at 45 degrees reflects straight down onto a floor, seen by an
/// orthographic camera below the mirror. The mirror's colour is k_middle; `wavy` adds a cosine along x, which
/// the floor's irradiance follows. `half`: half of the floor's side.
scene::Scene turned_sun(bool wavy, float half = 1) {
  scene::Scene s;
  s.name = "turned sun";
  s.materials = {test::diffuse({0.8f, 0.5f, 0.2f}), {}};
  s.materials[1].metallic = 1, s.materials[1].roughness = 0, s.materials[1].double_sided = true;
  s.materials[1].base_color = vec4(vec3(wavy ? 1 : k_middle), 1);
  if (wavy) {
    scene::Image image;
    image.name = "waves", image.width = 1024, image.height = 1;
    for (uint32_t i = 0; i < image.width; ++i) {
      const double x = 2 * (i + 0.5) / image.width - 1;
      const auto value =
          float(k_middle + k_amplitude * std::cos(2 * double(k_pi) * k_periods * x / (k_size * k_pixel)));
      image.floats.insert(image.floats.end(), {value, value, value, 1});
    }
    s.images = {image};
    s.textures = {{.image = 0, .wrap_u = scene::Wrap::clamp}};
    s.materials[1].base_color_texture.texture = 0;
  }
  test::add_quad(s, {-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}, 0);
  test::add_quad(s, {-1, 3, -1}, {2, -2, 0}, {0, 0, 2}, 1);
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = {3, 4, 5}}};
  s.lights[0].direction = {1, 0, 0};
  s.cameras = {test::looking_down({0, 0.9f, 0}, 0.8f)};
  s.cameras[0].orthographic = true;
  s.cameras[0].xmag = s.cameras[0].ymag = float(k_size * k_pixel / 2);
  s.environment.given = true;
  return s;
}

struct Reported {
  film::Image image;
  film::ImageError error;
  std::vector<film::TileError> tiles;
  std::array<std::vector<float>, 2> bias;  // of the film's halves
  bool bias_known = false, errors_known = false;
  double ledger_bias = 0;
};
Reported render(const scene::Scene& scene, uint32_t samples, const test::Settings& more) {
  session::Renderer r(test::renderer_options(samples <= test::k_validated_samples));
  r.set_size(k_size, k_size);
  r.set_scene(std::make_shared<scene::Scene>(scene));
  test::Settings settings{{"components.caustic", "photons"},
                          {"photons.efficiency", "false"},
                          {"photons.per_round", "200000"},
                          {"samples", std::to_string(samples)}};
  for (const auto& [key, value] : more) settings[key] = value;
  test::set(r, settings);
  Reported reported;
  reported.image = test::finish(r);
  reported.error = r.image_error();
  reported.tiles = r.progress().tile_errors();
  reported.bias = r.film().read_lookup_bias();
  reported.bias_known = r.film().lookup_bias_known(),
  reported.errors_known = r.progress().lookup_errors_known();
  r.finish_ledger();
  reported.ledger_bias = r.progress().ledger().entries().back().of_mean.interpolation;
  CHECK(r.device().validation_messages() == 0);
  return reported;
}

struct Amount {
  double value = 0, noise = 0;  // standard error, from the two halves
};
/// The sum over pixels of weight(x, y) times the picture's value or its estimated bias; in luminance.
template <class Weight>
Amount picture_sum(const Reported& t, Weight&& weight) {
  double all = 0, odd = 0;
  for (uint32_t i = 0; i < k_size * k_size; ++i) {
    const double w = weight(i % k_size, i / k_size);
    all += w * double(luminance(t.image.components[3][i]));
    odd += w * double(luminance(t.image.odd_half[3][i]));
  }
  return {all, std::abs(all - odd)};
}
template <class Weight>
Amount bias_sum(const Reported& t, Weight&& weight) {
  double even = 0, odd = 0;
  for (uint32_t i = 0; i < k_size * k_size; ++i) {
    const double w = weight(i % k_size, i / k_size);
    even += w * double(t.bias[0][i]), odd += w * double(t.bias[1][i]);
  }
  return {(even + odd) / 2, std::abs(even - odd) / 2};
}

/// The factor by which kernels attenuate a cosine with q radians per radius: Fourier transforms of
/// Epanechnikov's and of the flat kernel.
double epanechnikov(double q) { return 8 * std::cyl_bessel_j(2, q) / (q * q); }
double flat(double q) { return 2 * std::cyl_bessel_j(1, q) / q; }

}  // namespace

TEST_CASE("for cosine-shaped light the blur estimate equals the closed form, and nearly the truth") {
  const double k = 2 * double(k_pi) * k_periods / (k_size * k_pixel);
  const auto one = [](uint32_t, uint32_t) { return 1.0 / (k_size * k_size); };
  const auto wave = [&](uint32_t x, uint32_t) {
    return 2 * std::cos(k * k_pixel * (x + 0.5 - k_size / 2.0)) / (k_size * k_size);
  };
  // Schlick's Fresnel for a metal: c + (1 - c) (1 - cos 45 deg)^5; and the average over a pixel's width.
  const double graze = std::pow(1 - std::sqrt(0.5), 5);
  const double contrast = (1 - graze) * double(k_amplitude) / (graze + (1 - graze) * double(k_middle)) *
                          std::sin(k * k_pixel / 2) / (k * k_pixel / 2);
  struct Case {
    const char *radius, *alpha;
    uint32_t rounds;
    double most_short;  // of the bias: unreported, because the light is not a parabola
  };
  for (const Case& c : {Case{"5", "1", 12, 0.1}, Case{"3", "1", 48, 0.04}, Case{"7", "0.6667", 12, 0.1}}) {
    const Reported t =
        render(turned_sun(true), c.rounds,
               {{"photons.radius", c.radius}, {"photons.alpha", c.alpha}, {"photons.floor", "0"}});
    double kept = 0, reported = 0;  // averaged over passes
    for (uint32_t i = 0; i < c.rounds; ++i) {
      const double q = k * k_pixel * std::atof(c.radius) * photons::radius_ratio(i, std::atof(c.alpha));
      kept += epanechnikov(q) / c.rounds, reported += 2 * (flat(q) - epanechnikov(q)) / c.rounds;
    }
    const Amount mean = picture_sum(t, one), picture = picture_sum(t, wave), bias = bias_sum(t, wave),
                 even = bias_sum(t, one);
    const double truth = (kept - 1) * contrast * mean.value;
    INFO("radius " << c.radius << ": picture " << picture.value / mean.value << " +- "
                   << picture.noise / mean.value << " (" << kept * contrast << "), bias estimated "
                   << bias.value / mean.value << " +- " << bias.noise / mean.value << " ("
                   << reported * contrast << "), true " << truth / mean.value);
    // 4 standard errors, each from two halves, which can coincide by chance: plus half a hundredth.
    CHECK(std::abs(picture.value - kept * contrast * mean.value) < 4 * picture.noise + 0.005 * mean.value);
    CHECK(std::abs(bias.value - reported * contrast * mean.value) < 4 * bias.noise + 0.03 * std::abs(truth));
    CHECK(bias.value < 0);
    CHECK(std::abs(bias.value) > (1 - c.most_short - 0.03) * std::abs(truth) - 4 * bias.noise);
    CHECK(std::abs(bias.value) < 1.03 * std::abs(truth) + 4 * bias.noise);
    CHECK(bias.noise < 0.05 * std::abs(truth));  // otherwise these checks prove nothing
    // Blur moves light but keeps its sum.
    CHECK(std::abs(even.value) < 4 * even.noise + 0.002 * mean.value);
    // The picture's figure is the quadratic mean of its pixels: that of a cosine.
    CHECK(t.error.interpolation_rms ==
          Approx(std::abs(reported) * contrast * mean.value / std::sqrt(2.0)).epsilon(0.1));
    CHECK(t.ledger_bias == Approx(t.error.relative_interpolation()));
    CHECK(t.error.relative_sum() == Approx(t.error.relative(0) + t.error.relative_interpolation()));
    CHECK(t.errors_known);
  }
}

TEST_CASE("even light has no blur estimate, up to the border of its surface") {
  // The floor ends within the picture, 16 pixels from its middle.
  const Reported t =
      render(turned_sun(false, 16 * float(k_pixel)), 32,
             {{"photons.radius", "4"}, {"photons.alpha", "1"}, {"photons.per_round", "400000"}});
  const auto within = [](uint32_t x, uint32_t y, int least, int most) {
    const int u = std::min({int(x) - 16, 47 - int(x), int(y) - 16, 47 - int(y)});
    return u >= least && u < most ? 1.0 : 0.0;
  };
  struct Zone {
    const char* name;
    int least, most;  // pixels from the border
  };
  for (const Zone& z :
       {Zone{"all", 0, 16}, Zone{"middle", 5, 16}, Zone{"rim", 0, 1}, Zone{"near the rim", 1, 4}}) {
    const auto weight = [&](uint32_t x, uint32_t y) { return within(x, y, z.least, z.most); };
    const Amount light = picture_sum(t, weight), bias = bias_sum(t, weight);
    INFO(z.name << ": " << bias.value / light.value << " +- " << bias.noise / light.value);
    CHECK(light.value > 0);
    CHECK(std::abs(bias.value) < 4 * bias.noise + 0.004 * light.value);
    CHECK(bias.noise < 0.01 * light.value);
  }
  // The estimate is noise, like the picture's: the mean over all pixels is much smaller, because the halves
  // are uncorrelated.
  CHECK(t.error.interpolation_rms < 0.4 * t.error.rms[0]);
  CHECK(t.error.rms[0] > 0);
}

TEST_CASE("without photons no blur is reported") {
  // No surface focuses light.
  scene::Scene plain = turned_sun(false);
  plain.materials[1] = test::diffuse(vec3(0.5f));
  const Reported none = render(plain, 4, {});
  CHECK_FALSE(none.bias_known);
  CHECK(none.error.interpolation_rms == 0);
  CHECK(none.error.relative_sum() == none.error.relative(0));
  // Path tracing only.
  const Reported paths = render(turned_sun(true), 4, {{"components.caustic", "path"}});
  CHECK_FALSE(paths.bias_known);
  CHECK(paths.error.interpolation_rms == 0);
  // No light at all.
  scene::Scene dark = turned_sun(true);
  dark.lights.clear();
  const Reported unlit = render(dark, 4, {});
  CHECK(unlit.error.interpolation_rms == 0);
  for (const auto& half : unlit.bias)
    for (const float value : half) REQUIRE(value == 0);
}

TEST_CASE("the estimate does not depend on work items or interruptions, and restarts with the picture") {
  session::Renderer one(test::renderer_options()), other(test::renderer_options());
  const auto make = [](session::Renderer& r, const char* batch) {
    r.settings().set("path.batch", batch);
    r.set_size(40, 32);
    r.set_scene(std::make_shared<scene::Scene>(turned_sun(true)));
    test::set(r, {{"components.caustic", "photons"},
                  {"photons.efficiency", "false"},
                  {"photons.radius", "4"},
                  {"samples", "5"}});
  };
  make(one, "131072"), make(other, "1024");
  const film::Image image = test::finish(one);
  int calls = 0, refused = 0;
  while (!other.done())
    if (!other.step([&] { return ++calls % 23 == 0; })) REQUIRE(++refused < 10000);
  CHECK(refused > 0);
  CHECK(test::identical(image, other.image()));
  CHECK(one.film().read_lookup_bias() == other.film().read_lookup_bias());
  const double before = one.image_error().interpolation_rms;
  CHECK(before > 0);
  one.restart();
  CHECK_FALSE(one.film().lookup_bias_known());
  test::finish(one);
  CHECK(one.image_error().interpolation_rms == before);
  CHECK(one.device().validation_messages() == 0);
}

TEST_CASE("errors of records and photons in one picture are both reported") {
  session::Renderer r(test::renderer_options());
  r.set_size(40, 32);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/glass/glass.gltf");
  test::set(r, {{"components.secondary", "cache"},
                {"components.tertiary", "cache"},
                {"components.caustic", "photons"},
                {"photons.efficiency", "false"},
                {"photons.radius", "4"},
                {"samples", "8"}});
  test::finish(r);
  const film::ImageError both = r.image_error();
  CHECK(r.film().lookup_errors_complete());
  CHECK(r.film().lookup_bias_known());
  CHECK(r.progress().lookup_errors_known());
  CHECK(both.lookup_noise_rms > 0);
  test::set(r, {{"components.caustic", "off"}});
  test::finish(r);
  const film::ImageError records = r.image_error();
  CHECK_FALSE(r.film().lookup_bias_known());
  CHECK(r.film().lookup_errors_complete());
  CHECK(records.interpolation_rms < 0.9 * both.interpolation_rms);
  // Photons only: no error of records, and the estimate is complete.
  test::set(r, {{"components.secondary", "off"},
                {"components.tertiary", "off"},
                {"components.caustic", "photons"},
                {"photons.efficiency", "false"}});
  test::finish(r);
  const film::ImageError photons = r.image_error();
  CHECK_FALSE(r.film().lookup_errors_complete());
  CHECK(r.progress().lookup_errors_known());
  CHECK(photons.lookup_noise_rms == 0);
  CHECK(photons.interpolation_rms > 0);
  CHECK(std::hypot(records.interpolation_rms, photons.interpolation_rms) ==
        Approx(both.interpolation_rms).epsilon(0.15));
  for (const film::TileError& t : r.progress().tile_errors()) CHECK(t.lookups.noise == 0);
}

TEST_CASE("a target that blur prevents is not reported as reached, and costs few samples") {
  const auto tiles_of = [](const char* radius) {
    session::Renderer r(test::renderer_options());
    r.set_size(k_size, 32);
    r.set_scene(std::make_shared<scene::Scene>(turned_sun(true)));
    test::set(r, {{"components.caustic", "photons"},
                  {"photons.efficiency", "false"},
                  {"photons.per_round", "300000"},
                  {"photons.radius", radius},
                  {"photons.alpha", "1"},
                  {"sampling.mode", "adaptive"},
                  {"sampling.target_error", "0.1"},
                  {"sampling.min_samples", "8"},
                  {"sampling.max_samples", "1024"},
                  {"sampling.tile", "8"}});
    test::finish(r);
    size_t limited = 0, most = 0;
    for (const schedule::Tile& t : r.sampling().adaptive()->tiles()) {
      limited += t.limited(0.1f), most = std::max<size_t>(most, t.samples);
      if (t.limited(0.1f)) CHECK(t.sum() > 0.1f);
      if (t.state == schedule::TileState::done) CHECK(t.sum() < 0.101f);
    }
    CHECK(most < 1024);
    return limited;
  };
  // The blur error is a third of the mean for 8 pixels; for one pixel it is 3 % where the wave is darkest.
  CHECK(tiles_of("8") > 16);
  CHECK(tiles_of("1") == 0);
}

}  // namespace photons_bias_tests
