// links: pilot
// What an effect contributes, from pictures with and without it.
#include <catch2/catch.hpp>
#include <random>

#include "film/film.h"
#include "pilot/difference.h"

namespace pilot_difference_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_side = 64, k_samples = 8;

/// One component: luminance `light(x)` of column x, each sample with this standard deviation.
template <class Light>
film::Image picture(const Light& light, float deviation, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, deviation / std::sqrt(float(k_samples) / 2));
  film::Image image;
  image.width = image.height = k_side;
  for (const size_t c : k_components) {
    image.components[c].assign(k_side * k_side, vec3(0));
    image.odd_half[c] = image.components[c];
  }
  for (size_t i = 0; i < k_side * k_side; ++i) {
    const float mean = light(i % k_side), odd = mean + normal(random), even = mean + normal(random);
    image.odd_half[1][i] = vec3(odd);
    image.components[1][i] = vec3(0.5f * (odd + even));
  }
  return image;
}

}  // namespace

TEST_CASE("an effect with a quarter of the light and half of the variance") {
  const auto with = picture([](size_t) { return 4.0f; }, 1.0f, 1);
  const auto without = picture([](size_t) { return 3.0f; }, std::sqrt(0.5f), 2);
  const pilot::Difference d = pilot::difference(with, without, k_samples);
  // Standard errors of the means are 1 / sqrt(8 * 4096) each, about .0055.
  CHECK(d.light == Approx(0.25).margin(0.01));
  CHECK(d.seen == Approx(1 / (4 * 1.05)).margin(0.01));
  CHECK(d.noise == Approx(0.5).margin(0.05));
}

TEST_CASE("noise is not seen as a change") {
  const auto light = [](size_t) { return 1.0f; };
  const pilot::Difference d = pilot::difference(picture(light, 2.0f, 3), picture(light, 2.0f, 4), k_samples);
  // The noise of a block's difference is sqrt(2) 2 / sqrt(8 * 64), .125 of the light; the halves' product has
  // the mean 0 and, over 64 blocks, a standard deviation of twice its square over 8: .0039, and its root .06.
  CHECK(d.seen < 0.13);
  CHECK(std::abs(d.light) < 0.08);
  CHECK(std::abs(d.noise) < 0.1);
}

TEST_CASE("light that only moves is seen, and adds nothing") {
  const auto left = [](size_t x) { return x < k_side / 2 ? 1.5f : 0.5f; };
  const auto right = [](size_t x) { return x < k_side / 2 ? 0.5f : 1.5f; };
  const pilot::Difference d = pilot::difference(picture(left, 0, 1), picture(right, 0, 1), k_samples);
  CHECK(d.light == Approx(0).margin(1e-6));
  // 1 over 1.5 and over .5, each plus the floor.
  CHECK(d.seen > std::sqrt(0.5 / (1.6 * 1.6) + 0.5 / (0.6 * 0.6)));
  CHECK(d.seen < std::sqrt(0.5 / (1.5 * 1.5) + 0.5 / (0.5 * 0.5)));
}

TEST_CASE("black pictures differ in nothing") {
  const auto dark = [](size_t) { return 0.0f; };
  const pilot::Difference d = pilot::difference(picture(dark, 0, 1), picture(dark, 0, 1), k_samples);
  CHECK(d.light == 0);
  CHECK(d.seen == 0);
  CHECK(d.noise == 0);
}

}  // namespace pilot_difference_tests
