// links: pilot
// Findings of a pilot: energy and variance of pictures with known noise.
#include <catch2/catch.hpp>
#include <random>

#include "pilot/findings.h"

namespace pilot_findings_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_side = 64;

film::Image picture() {
  film::Image image;
  image.width = image.height = k_side;
  for (const size_t c : k_components) {
    image.components[c].assign(k_side * k_side, vec3(0));
    image.odd_half[c] = image.components[c];
  }
  return image;
}

/// Light of mean `light`, each sample with this relative standard deviation.
void add_noise(film::Image& image, size_t component, float light, float deviation, uint32_t samples,
               uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, light * deviation / std::sqrt(float(samples) / 2));
  for (size_t i = 0; i < image.components[component].size(); ++i) {
    const float odd = light + normal(random), even = light + normal(random);
    image.odd_half[component][i] = vec3(odd);
    image.components[component][i] = vec3(0.5f * (odd + even));
  }
}

}  // namespace

TEST_CASE("variance of one sample, relative to all light, and shares of the light") {
  film::Image image = picture();
  add_noise(image, 0, 3, 0.1f, 4, 1);
  add_noise(image, 2, 1, 0.5f, 4, 2);
  const solvers::Findings f = pilot::evaluate(image, 4);
  CHECK(f.components[0].energy == Approx(0.75).epsilon(0.02));
  CHECK(f.components[2].energy == Approx(0.25).epsilon(0.02));
  CHECK(f.components[1].energy == 0);
  // Around a pixel there is 4, and a twentieth of that.
  const double around = 4 * 1.05;
  CHECK(f.components[0].variance == Approx(0.09 / (around * around)).epsilon(0.1));
  CHECK(f.components[2].variance == Approx(0.25 / (around * around)).epsilon(0.1));
  CHECK(f.components[3].variance == 0);
}

TEST_CASE("the estimate does not depend on the number of samples") {
  film::Image few = picture(), many = picture();
  add_noise(few, 1, 1, 1, 4, 3);
  add_noise(many, 1, 1, 1, 64, 4);
  CHECK(pilot::evaluate(few, 4).components[1].variance ==
        Approx(pilot::evaluate(many, 64).components[1].variance).epsilon(0.15));
}

TEST_CASE("darkness hides noise, a firefly counts with a bounded amount, and black pictures are quiet") {
  film::Image image = picture();
  add_noise(image, 0, 1, 0, 4, 5);
  // A dark quarter with much relative noise.
  film::Image dark = picture();
  add_noise(dark, 0, 1e-4f, 1, 4, 6);
  for (uint32_t y = 0; y < k_side / 2; ++y)
    for (uint32_t x = 0; x < k_side / 2; ++x) {
      image.components[0][y * k_side + x] = dark.components[0][y * k_side + x];
      image.odd_half[0][y * k_side + x] = dark.odd_half[0][y * k_side + x];
    }
  CHECK(pilot::evaluate(image, 4).components[0].variance < 1e-4);
  image.odd_half[0].back() = vec3(1e8f);
  CHECK(pilot::evaluate(image, 4).components[0].variance <=
        pilot::k_most_variance / (k_side * k_side) + 1e-4);
  const solvers::Findings black = pilot::evaluate(picture(), 4);
  CHECK(black.components[0].variance == 0);
  CHECK(black.components[0].energy == 0);
}

}  // namespace pilot_findings_tests
