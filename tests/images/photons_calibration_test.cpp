// links: session
// Calibration of the error estimate of photon pictures: pictures of many seeds, each with its own passes, are
// compared with a long reference. The 90 % interval of a tile, noise and blur together, must contain the
// reference in at least 85 of 100 tiles.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "support/calibration.h"

namespace photons_calibration_tests {

using namespace lucerna;

namespace {

using test::Shot, test::shot_of;

struct Case {
  const char* scene;
  uint32_t width, height;
  test::Settings of_photons, of_reference;  // settings that differ
  uint32_t rounds, shots;
};

struct Figures {
  size_t tested = 0, by_noise = 0, by_sum = 0, heavy = 0;
  double estimated_noise = 0, estimated_bias = 0, estimated = 0, truth = 0;
};

void count(Figures& f, const Shot& shot, const Shot& reference) {
  const double mean = reference.error.luminance[0], own = std::pow(reference.error.rms[0], 2);
  double squares = 0;
  for (size_t i = 0; i < shot.luminance.size(); ++i)
    squares += std::pow(double{shot.luminance[i]} - double{reference.luminance[i]}, 2);
  f.truth += std::sqrt(std::max(0.0, squares / double(shot.luminance.size()) - own)) / mean;
  f.estimated += shot.error.relative_sum();
  f.estimated_noise += shot.error.relative(0), f.estimated_bias += shot.error.relative_interpolation();
  for (size_t t = 0; t < shot.tiles.size(); ++t) {
    film::TileError a = shot.tiles[t];
    const film::TileError& r = reference.tiles[t];
    // Tiles without light of this component have no estimate.
    if (r.luminance < 1e-3 * mean) continue;
    if (a.heavy_tailed) {
      ++f.heavy;
      continue;
    }
    a = test::with_noise_of(a, r);
    const double off = std::abs(a.luminance - r.luminance);
    ++f.tested;
    f.by_sum += off <= a.half_width_90();
    a.lookups.interpolation = 0;
    f.by_noise += off <= a.half_width_90();
  }
}

}  // namespace

TEST_CASE("the estimated error of a picture of photons is its true error") {
  // LUCERNA_CALIBRATION selects all scenes or one by name, which takes minutes. Default: the fastest one.
  // LUCERNA_CALIBRATION_RADIUS replaces all radii by one.
  const char* const wanted = std::getenv("LUCERNA_CALIBRATION");
  const char* const at = std::getenv("LUCERNA_CALIBRATION_RADIUS");
  const std::string only = wanted ? wanted : "cornell";
  const std::vector<std::string> radii =
      at ? std::vector<std::string>{at} : std::vector<std::string>{"1.5", "3", "6"};
  // The reference of diffuse light is path traced, which is fast. Caustics of a small lamp are slow by paths,
  // so photons of many passes with a small radius are the reference of those with a large one.
  const test::Settings caustic{{"components.caustic", "photons"}, {"photons.efficiency", "false"}};
  const test::Settings diffuse{{"components.secondary", "photons"},
                               {"components.tertiary", "photons"},
                               {"photons.efficiency", "false"}};
  const test::Settings fine{{"components.caustic", "photons"}, {"photons.efficiency", "false"},
                            {"photons.radius", "0.4"},         {"photons.floor", "0.25"},
                            {"photons.per_round", "200000"},   {"samples", "384"}};
  for (const Case& c :
       {Case{"cornell",
             48,
             48,
             diffuse,
             {{"components.secondary", "path"}, {"components.tertiary", "path"}, {"samples", "2048"}},
             16,
             4},
        Case{"glass", 64, 64, caustic, {{"components.caustic", "path"}, {"samples", "16384"}}, 16, 4},
        Case{"ring", 80, 45, caustic, fine, 16, 4}}) {
    if (only != "all" && only != c.scene) continue;
    session::Renderer renderer(test::renderer_options(false));
    renderer.set_size(c.width, c.height);
    renderer.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + c.scene + "/" + c.scene + ".gltf");
    // Components without photons would hide the photons' error under their noise.
    test::Settings settings{{"sampling.tile", "8"},
                            {"sampling.mode", "uniform"},
                            {"components.primary", "off"},
                            {"components.secondary", "off"},
                            {"components.tertiary", "off"},
                            {"components.caustic", "off"},
                            {"seed", "4096"}};
    test::Settings reference_settings = settings;
    for (const auto& [key, value] : c.of_reference) reference_settings[key] = value;
    test::set(renderer, reference_settings);
    const Shot reference = shot_of(renderer);
    for (const std::string& radius : radii) {
      for (const auto& [key, value] : c.of_photons) settings[key] = value;
      settings["samples"] = std::to_string(c.rounds);
      settings["photons.radius"] = radius, settings["photons.floor"] = "0.5";
      settings["photons.per_round"] = "0";
      Figures f;
      for (uint32_t s = 0; s < c.shots; ++s) {
        settings["seed"] = std::to_string(s + 1);
        test::set(renderer, settings);
        count(f, shot_of(renderer), reference);
      }
      const double share = 100 / double(std::max<size_t>(1, f.tested)), n = c.shots;
      std::printf(
          "%-8s radius %-3s covered: noise %.1f %%, with bias %.1f %% of %zu tiles (%zu heavy-tailed); rms "
          "estimated "
          "%.4f (noise %.4f, bias %.4f), true %.4f\n",
          c.scene, radius.c_str(), share * double(f.by_noise), share * double(f.by_sum), f.tested, f.heavy,
          f.estimated / n, f.estimated_noise / n, f.estimated_bias / n, f.truth / n);
      std::fflush(stdout);
      INFO(c.scene << " radius " << radius);
      // 85 %, minus two standard errors for this number of independent tiles.
      const double tiles = double(f.tested), chance = 2 * std::sqrt(0.9 * 0.1 * tiles);
      CHECK(double(f.by_sum) > 0.85 * tiles - chance);
      CHECK(f.by_noise < f.by_sum);
      CHECK(f.estimated > 0.8 * f.truth);
      CHECK(f.estimated < 1.6 * f.truth);
    }
  }
}

}  // namespace photons_calibration_tests
