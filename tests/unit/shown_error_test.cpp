// links: film
// The error of the displayed picture: expected errors of tiles, corrected by measurements of samples.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "film/shown_error.h"

namespace shown_error_tests {

using namespace lucerna;
using film::ShownError;
using film::ShownJudge;
using shared::PreviewTile;

namespace {

constexpr uint32_t k_across = 40, k_down = 30;

/// Tiles with an expected error of 0.1 each, a true error of factor(x, y) times that, and a smaller error of
/// the tile's mean by the square root of 2. Samples measure that mean with a standard deviation of `noise`.
template <class Factor>
std::vector<PreviewTile> tiles(const Factor& factor, float noise, std::mt19937& random) {
  std::vector<PreviewTile> all;
  std::normal_distribution<float> normal;
  for (uint32_t y = 0; y < k_down; ++y)
    for (uint32_t x = 0; x < k_across; ++x) {
      const float mean = factor(x, y) * 0.1f / std::sqrt(2.0f) + noise * normal(random);
      all.push_back({0.1f, mean * mean - noise * noise, noise * noise});
    }
  return all;
}

}  // namespace

TEST_CASE("without measurements a picture has its expected errors; without tiles it has none") {
  std::mt19937 random(1);
  ShownJudge judge;
  const ShownError e =
      judge.judge(tiles([](uint32_t, uint32_t) { return 3.0f; }, 0.1f, random), k_across, false);
  CHECK(e.worst_tenth < 1.2 * e.median);
  CHECK(e.median > 0.07);
  CHECK(e.median < 0.12);
  CHECK(judge.judge({}, 0, false).median == 0);
  CHECK(judge.ratio() > 0.5);
  CHECK(judge.ratio() <= 1);
}

TEST_CASE("measurements with more noise than signal correct the whole picture's error") {
  std::mt19937 random(2);
  ShownJudge judge;
  ShownError e;
  for (int k = 0; k < 3; ++k)
    e = judge.judge(tiles([](uint32_t, uint32_t) { return 2.0f; }, 0.1f, random), k_across, true);
  CHECK(std::sqrt(judge.ratio()) == Approx(2).epsilon(0.1));
  const double expected = 2 * 0.1 * 1.15;
  CHECK(e.median == Approx(expected).epsilon(0.2));
  CHECK(e.worst_tenth < 1.6 * expected);
}

TEST_CASE("a region with a larger error is found, and the rest keeps its small error") {
  std::mt19937 random(3);
  ShownJudge judge;
  const auto factor = [](uint32_t x, uint32_t) { return x < 8 ? 5.0f : 0.7f; };
  ShownError e;
  for (int k = 0; k < 4; ++k) e = judge.judge(tiles(factor, 0.15f, random), k_across, true);
  CHECK(e.median < 0.14);
  CHECK(e.worst_tenth > 0.7 * 5 * 0.1);
  CHECK(e.worst_tenth < 1.5 * 5 * 0.1);
}

TEST_CASE("the next picture does not inherit measurements of tiles") {
  std::mt19937 random(4);
  ShownJudge judge;
  judge.judge(tiles([](uint32_t x, uint32_t) { return x < 8 ? 5.0f : 1.0f; }, 0.1f, random), k_across, true);
  judge.restart();
  const ShownError e =
      judge.judge(tiles([](uint32_t, uint32_t) { return 1.0f; }, 0.1f, random), k_across, false);
  CHECK(e.worst_tenth < 1.2 * e.median);
}

TEST_CASE("tiles without a measurement, and squares below 0, give a finite error") {
  ShownJudge judge;
  std::vector<PreviewTile> all(k_across * k_down, {0.1f, 0, -1});
  CHECK(judge.judge(all, k_across, true).median > 0);
  for (PreviewTile& t : all) t.square = -1, t.noise = 1;
  const ShownError e = judge.judge(all, k_across, true);
  CHECK(e.median > 0);
  CHECK(e.median < 0.124);
  CHECK(std::isfinite(e.worst_tenth));
}

}  // namespace shown_error_tests
