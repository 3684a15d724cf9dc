// links: photons
// The choice of solver for secondary and tertiary light from a pilot's small pictures.
#include <catch2/catch.hpp>

#include "solvers/photons/trials.h"

namespace photons_trials_tests {

using namespace lucerna;
using photons::judge, photons::Trial;

namespace {

constexpr uint32_t k_side = 16, k_secondary = 1, k_tertiary = 2;
constexpr uint32_t k_both = 1u << k_secondary | 1u << k_tertiary;

/// A picture whose samples of each component are mean - spread and mean + spread.
Trial trial(double cost, float mean, float secondary, float tertiary, uint32_t judged = k_both) {
  Trial t;
  t.judged = judged, t.cost = cost;
  t.image.width = t.image.height = k_side;
  for (const size_t c : k_components) {
    const float spread = c == k_secondary ? secondary : c == k_tertiary ? tertiary : 100.0f;
    t.image.components[c].assign(k_side * k_side, vec3(mean));
    t.image.odd_half[c].assign(k_side * k_side, vec3(mean + spread));
  }
  return t;
}

}  // namespace

TEST_CASE("variance times cost decides, for the judged components", "[photons_trials]") {
  // Variance of a sample: half of the squared difference, 2 spread^2.
  std::vector<Trial> trials{trial(2, 1, 0.3f, 0.4f), trial(4, 1, 0.1f, 0.2f), trial(1, 1, 0.3f, 0.2f)};
  CHECK(judge(trials) == 2);
  CHECK(trials[0].product == 1);
  CHECK(trials[1].product == Approx(0.05 * 4 / (0.25 * 2)));
  CHECK(trials[2].product == Approx(0.13 * 1 / (0.25 * 2)));
  // Without tertiary light the third trial has no less noise than the first.
  for (Trial& t : trials) t.judged = 1u << k_secondary;
  CHECK(judge(trials) == 1);
  CHECK(trials[1].product == Approx(0.01 * 4 / (0.09 * 2)));
  CHECK(trials[2].product == Approx(0.5));
}

TEST_CASE("the requested solver stays unless another has less than half of its variance times cost",
          "[photons_trials]") {
  std::vector<Trial> trials{trial(1, 1, 0.1f, 0), trial(0.51, 1, 0.1f, 0)};
  CHECK(judge(trials) == 0);
  trials[1].cost = 0.49;
  CHECK(judge(trials) == 1);
  // The picture has more photons per pass than the pilot.
  trials[0].variance_factor[k_secondary] = 0.5;
  CHECK(judge(trials) == 0);
  CHECK(trials[1].product == Approx(0.98));
}

TEST_CASE("a bright outlier does not hide its own noise", "[photons_trials]") {
  // A block whose light comes from one sample in the first trial and from every sample in the second.
  std::vector<Trial> trials{trial(1, 1, 0, 0), trial(1, 1, 0.4f, 0)};
  for (Trial& t : trials) t.judged = 1u << k_secondary;
  for (uint32_t y = 0; y < 8; ++y)
    for (uint32_t x = 0; x < 8; ++x) {
      const bool one = x == 0 && y == 0;
      trials[0].image.components[k_secondary][y * k_side + x] = vec3(one ? 640.0f : 0.0f);
      trials[0].image.odd_half[k_secondary][y * k_side + x] = vec3(one ? 1280.0f : 0.0f);
    }
  CHECK(judge(trials) == 1);
  CHECK(trials[1].product < 1e-3);
}

TEST_CASE("without any light found nothing is delegated", "[photons_trials]") {
  std::vector<Trial> trials{trial(2, 0, 0, 0), trial(1, 0, 0, 0)};
  CHECK(judge(trials) == 0);
  CHECK(trials[1].product == 0);
  // Zero variance is no reason either: a trial that found no light is not better than one that did.
  trials[0] = trial(2, 1, 0.5f, 0);
  CHECK(judge(trials) == 0);
}

TEST_CASE("a trial that missed light has the variance of light that is too rare for it", "[photons_trials]") {
  // Photons have found no light, and show no variance.
  std::vector<Trial> trials{trial(2, 0, 0, 0), trial(4, 1, 0.1f, 0)};
  for (Trial& t : trials) t.judged = 1u << k_secondary;
  CHECK(judge(trials) == 1);
  // 64 pixels of two samples each found no light: the variance is 128 times the square of the certain light,
  // 1 - 3 * 0.1. Relative to the trial that found light; for paths 2 * 0.1^2.
  CHECK(trials[1].product == Approx(0.02 * 4 / (128 * 0.49 * 2)));
  // Pixels that read the same photons count as one.
  trials[0].pixels_in_common = 64;
  judge(trials);
  CHECK(trials[1].product == Approx(0.02 * 4 / (2 * 0.49 * 2)));
  // In one block of four, and the reverse.
  std::vector<Trial> dark{trial(1, 1, 0.1f, 0), trial(1, 1, 0.1f, 0)};
  for (Trial& t : dark) t.judged = 1u << k_secondary;
  for (auto* layer : {&dark[0].image.components[k_secondary], &dark[0].image.odd_half[k_secondary]})
    for (uint32_t y = 0; y < 8; ++y)
      for (uint32_t x = 0; x < 8; ++x) (*layer)[y * k_side + x] = vec3(0);
  CHECK(judge(dark) == 1);
  std::swap(dark[0], dark[1]);
  CHECK(judge(dark) == 0);
  CHECK(dark[1].product > 10);
  // More than half of the light is no miss.
  std::vector<Trial> half{trial(1, 0.6f, 0.1f, 0), trial(1, 1, 0.1f, 0)};
  for (Trial& t : half) t.judged = 1u << k_secondary;
  CHECK(judge(half) == 0);
  CHECK(half[1].product == Approx(1));
}

}  // namespace photons_trials_tests
