// links: session
// Compares the error as seen that the two halves of a picture estimate with the difference of pictures of
// independent seeds.
#include <catch2/catch.hpp>
#include <cmath>

#include "film/error.h"
#include "support/render.h"

namespace seen_error_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_size = 48, k_seeds = 12;

/// Luminance by layer: the sum, then the components.
using Layers = std::array<std::vector<double>, 5>;

struct Shots {
  std::vector<Layers> pictures;
  std::vector<film::ImageError> errors;
  film::SeenRange range;
};

Shots shoot(const char* scene, const test::Settings& settings) {
  session::Renderer r(test::renderer_options(false));
  r.set_size(k_size, k_size);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + scene + "/" + scene + ".gltf");
  test::set(r, settings);
  Shots shots;
  for (uint32_t seed = 1; seed <= k_seeds; ++seed) {
    test::set(r, {{"seed", std::to_string(seed)}});
    const film::Image image = test::finish(r);
    shots.errors.push_back(r.image_error());
    Layers& layers = shots.pictures.emplace_back();
    for (size_t i = 0; i < image.samples.size(); ++i) {
      double sum = 0;
      for (size_t c = 0; c < 4; ++c) {
        layers[c + 1].push_back(double(luminance(image.components[c][i])));
        sum += layers[c + 1].back();
      }
      layers[0].push_back(sum);
    }
  }
  shots.range =
      film::seen_range(r.settings().real("film.ev"), uint32_t(r.settings().choice("film.tone_curve")));
  return shots;
}

/// Mean of the layers over the seeds.
Layers mean_of(const std::vector<Layers>& pictures) {
  Layers mean;
  for (size_t k = 0; k < 5; ++k) {
    mean[k].resize(pictures[0][k].size());
    for (const Layers& p : pictures)
      for (size_t i = 0; i < mean[k].size(); ++i) mean[k][i] += p[k][i] / double(pictures.size());
  }
  return mean;
}

}  // namespace

TEST_CASE("the estimated error as seen is the squared difference of independent seeds") {
  struct Case {
    const char *scene, *ev;
    bool clipped;  ///< the lamp is white: only the sum of the layers is known
  };
  for (const Case& c :
       {Case{"cornell", "-4", false}, Case{"cornell", "1", true}, Case{"atrium", "0", false}}) {
    const Shots shots =
        shoot(c.scene, {{"samples", "64"}, {"film.ev", c.ev}, {"film.tone_curve", "neutral"}});
    const Layers mean = mean_of(shots.pictures);
    const auto white = double(shots.range.white);
    const auto shown = [&](double y) { return std::min(y, white); };
    // The variance of every layer over the scale of the mean picture.
    std::array<double, 5> found{}, spread{};
    double brightest = 0;
    for (size_t i = 0; i < mean[0].size(); ++i) {
      const int x = int(i % k_size), y = int(i / k_size), last = int(k_size) - 1;
      double local = 0, count = 0;
      for (int v = std::max(0, y - 2); v <= std::min(last, y + 2); ++v)
        for (int u = std::max(0, x - 2); u <= std::min(last, x + 2); ++u)
          local += shown(mean[0][size_t(v) * k_size + size_t(u)]), ++count;
      local /= count;
      const double scale =
          std::max({local, shown(mean[0][i]) / double{shared::k_seen_most}, double(shots.range.floor)});
      brightest = std::max(brightest, mean[0][i] / white);
      for (size_t k = 0; k < 5; ++k) {
        double squares = 0;
        for (const Layers& p : shots.pictures)
          squares += std::pow((shown(p[k][i]) - shown(mean[k][i])) / scale, 2);
        const double variance = squares / (k_seeds - 1);
        found[k] += variance / double(mean[0].size());
        // The variance of n values has n - 1 degrees of freedom.
        spread[k] += 2 * variance * variance / (k_seeds + 1);
      }
    }
    CHECK((brightest > 1) == c.clipped);
    for (size_t k = 0; k < (c.clipped ? 1 : 5); ++k) {
      double estimated = 0, own_spread = 0;
      for (const film::ImageError& e : shots.errors) {
        const double square = std::pow(e.seen_rms[k], 2);
        estimated += square / k_seeds;
        own_spread += 2 * square * square / std::max(e.seen_degrees, 1.0) / (k_seeds * k_seeds);
      }
      const double sigma = std::sqrt(own_spread + spread[k] / std::pow(double(mean[0].size()), 2));
      std::printf("%-8s EV %s, layer %zu: estimated %.5f, found %.5f, sigma %.5f\n", c.scene, c.ev, k,
                  estimated, found[k], sigma);
      if (found[k] == 0) {
        CHECK(estimated == 0);
        continue;
      }
      INFO(c.scene << ", EV " << c.ev << ", layer " << k);
      // 3.3 sigma (p = 0.001), plus 3 % for the scale, which is that of the noisy picture; 10 % where the
      // pixels at a lamp's edge are clipped in only one half.
      CHECK(std::abs(estimated - found[k]) < 3.3 * sigma + (c.clipped ? 0.1 : 0.03) * found[k]);
    }
  }
}

}  // namespace seen_error_tests
