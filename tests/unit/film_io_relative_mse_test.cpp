// links: film_io
#include "film/io/relative_mse.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace film_io_relative_mse_tests {

using namespace lucerna;
using film::ReferencePair;
using film::RelativeMse;

namespace {

std::vector<vec3> flat(size_t pixels, const vec3& colour) { return std::vector<vec3>(pixels, colour); }

/// `colour` with normal noise of that standard deviation, independent in each channel.
std::vector<vec3> noisy(size_t pixels, float colour, float deviation, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(colour, deviation);
  std::vector<vec3> values(pixels);
  for (vec3& v : values)
    for (int k = 0; k < 3; ++k) v[k] = normal(random);
  return values;
}

}  // namespace

TEST_CASE("With references without noise it is the relative mean squared error") {
  const vec3 r(1, 0, 2), t(1.5f, 0.1f, 2);
  const ReferencePair references{16, flat(256, r), flat(256, r)};
  const RelativeMse e = film::relative_mse(flat(256, t), references);
  CHECK(e.all == Approx((0.25 / 1.01 + 0.01 / 0.01 + 0) / 3));
  CHECK(e.trimmed == Approx(e.all));
  CHECK(film::relative_mse_noise(references) == 0);
  CHECK(film::relative_mse(flat(256, r), references).all == 0);
  CHECK(film::relative_mse(flat(256, t), references, {.epsilon = 1}).all ==
        Approx((0.25 / 2 + 0.01 / 1 + 0) / 3));
}

TEST_CASE("The references' noise does not change it, nor its trimmed mean") {
  // 256 x 256 pixels with a noise of 30 % in either reference: three colours per pixel give (.09 / 1.01)^2 /
  // 3 as the variance of a product, so the mean's standard error is .0002. Bound: five of them.
  constexpr uint32_t k_size = 256, k_pixels = k_size * k_size;
  const double sigma = 0.09 / 1.01 / std::sqrt(3) / k_size;
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const ReferencePair references{k_size, noisy(k_pixels, 1, 0.3f, 10 * seed),
                                   noisy(k_pixels, 1, 0.3f, 10 * seed + 1)};
    CHECK(std::abs(film::relative_mse(flat(k_pixels, vec3(1)), references).trimmed) < 5 * sigma);
    CHECK(film::relative_mse(flat(k_pixels, vec3(1.1f)), references).trimmed ==
          Approx(0.01 / 1.01).epsilon(0.02).margin(5 * (sigma + 0.2 * 0.3 / std::sqrt(6.0) / k_size)));
    // The predicted error of that figure; colours count as one there, which is conservative.
    CHECK(film::relative_mse_noise(references) > 0.7 * sigma);
    CHECK(film::relative_mse_noise(references) < 2 * sigma);
    // A trimmed share of half the picture would show a selection by the pixels' own products.
    CHECK(std::abs(film::relative_mse(flat(k_pixels, vec3(1)), references, {.trimmed_share = 0.5}).trimmed) <
          5 * sigma * std::sqrt(2));
  }
}

TEST_CASE("A spot of bad pixels is trimmed by its neighbours, a single one is not") {
  constexpr uint32_t k_width = 50, k_pixels = 50 * 40;
  const ReferencePair references{k_width, flat(k_pixels, vec3(1)), flat(k_pixels, vec3(1))};
  std::vector<vec3> picture = flat(k_pixels, vec3(1));
  // Two of 2000 pixels are trimmed: the two in the middle of a spot of 3 x 4.
  for (uint32_t y = 10; y < 13; ++y)
    for (uint32_t x = 20; x < 24; ++x) picture[y * k_width + x] = vec3(2);
  const RelativeMse spot = film::relative_mse(picture, references);
  CHECK(spot.all == Approx(12 / 1.01 / k_pixels));
  CHECK(spot.trimmed == Approx(10 / 1.01 / (k_pixels - 2)));
  picture = flat(k_pixels, vec3(1));
  picture[7 * k_width + 49] = vec3(2);
  CHECK(film::relative_mse(picture, references).trimmed == Approx(1 / 1.01 / (k_pixels - 2)));
}

TEST_CASE("Small and empty pictures") {
  const ReferencePair one{1, flat(1, vec3(1)), flat(1, vec3(1))};
  CHECK(film::relative_mse(flat(1, vec3(2)), one).all == Approx(1 / 1.01));
  CHECK(film::relative_mse(flat(1, vec3(2)), one).trimmed == 0);  // the only pixel is trimmed
  CHECK(film::relative_mse(flat(1, vec3(2)), one, {.trimmed_share = 0}).trimmed == Approx(1 / 1.01));
  const ReferencePair column{1, flat(3, vec3(1)), flat(3, vec3(1))};
  CHECK(film::relative_mse(flat(3, vec3(2)), column, {.trimmed_share = 0}).trimmed == Approx(1 / 1.01));
  CHECK(film::relative_mse({}, {}).all == 0);
  CHECK(film::relative_mse({}, {}).trimmed == 0);
  CHECK(film::relative_mse_noise({}) == 0);
}

TEST_CASE("Error as seen is relative to the surrounding light plus a share of the median") {
  // Left half 1, right half 4, far from the border between them; the median is of both: 2.5.
  constexpr uint32_t k_width = 40, k_pixels = 40 * 20;
  std::vector<vec3> r(k_pixels), t(k_pixels);
  for (uint32_t p = 0; p < k_pixels; ++p) r[p] = t[p] = vec3(p % k_width < k_width / 2 ? 1.0f : 4.0f);
  const ReferencePair references{k_width, r, r};
  CHECK(film::seen_mse(t, references).all == 0);
  t[5 * k_width + 5] = vec3(1.5f), t[5 * k_width + 30] = vec3(4, 6, 4);
  const double dark = 1 + 0.05 * 2.5, bright = 4 + 0.05 * 2.5;
  const auto sum = 0.25 / (dark * dark) + 4 / (bright * bright) / 3;
  CHECK(film::seen_mse(t, references).all == Approx(sum / k_pixels));
  const std::vector<float> difference = film::seen_difference(t, references);
  CHECK(difference[5 * k_width + 5] == Approx(0.5 / dark));
  CHECK(difference[5 * k_width + 30] == Approx(2 * 0.7152 / bright));
  CHECK(difference[0] == 0);
  // One of 800 pixels is trimmed: the worst by itself.
  CHECK(film::seen_mse(t, references).trimmed == Approx(4 / (bright * bright) / 3 / (k_pixels - 1)));
  // At the border 5x5 pixels hold both: three columns of 1, two of 4.
  std::vector<vec3> edge = r;
  edge[5 * k_width + 19] = vec3(2);
  CHECK(film::seen_mse(edge, references, {.trimmed_share = 0}).all ==
        Approx(1 / std::pow((3 + 8) / 5.0 + 0.125, 2) / k_pixels));
  // Exposure changes nothing.
  for (auto* picture : {&r, &t})
    for (vec3& v : *picture) v *= 8.0f;
  CHECK(film::seen_mse(t, {k_width, r, r}).all == Approx(sum / k_pixels));
}

TEST_CASE("The references' noise does not change the error as seen, nor its trimmed mean") {
  constexpr uint32_t k_size = 256, k_pixels = k_size * k_size;
  const double sigma = 0.09 / (1.05 * 1.05) / std::sqrt(3) / k_size;
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const ReferencePair references{k_size, noisy(k_pixels, 1, 0.3f, 10 * seed),
                                   noisy(k_pixels, 1, 0.3f, 10 * seed + 1)};
    CHECK(std::abs(film::seen_mse(flat(k_pixels, vec3(1)), references).all) < 5 * sigma);
    CHECK(
        film::seen_mse(flat(k_pixels, vec3(1.1f)), references).all ==
        Approx(0.01 / (1.05 * 1.05)).epsilon(0.02).margin(5 * (sigma + 0.2 * 0.3 / std::sqrt(6.0) / k_size)));
    CHECK(film::seen_mse_noise(references) > 0.7 * sigma);
    CHECK(film::seen_mse_noise(references) < 2 * sigma);
    // A trimmed share of half the picture would show a selection by the pixels' own products, or by both
    // references at once.
    CHECK(std::abs(film::seen_mse(flat(k_pixels, vec3(1)), references).trimmed) < 5 * sigma);
    CHECK(std::abs(film::seen_mse(flat(k_pixels, vec3(1)), references, {.trimmed_share = 0.5}).trimmed) <
          5 * sigma * std::sqrt(2));
  }
}

TEST_CASE("Dark, small and empty pictures have an error as seen") {
  // Light in a corner only: the median is 0, so the mean is used.
  std::vector<vec3> r = flat(100, vec3(0));
  r[0] = vec3(9);
  const ReferencePair references{10, r, r};
  std::vector<vec3> t = r;
  t[99] = vec3(1);
  // The corner counts nine times among the 5x5 pixels around it; all of it once in the mean of these means.
  double local = 0;
  for (const double times : {9., 6., 3., 6., 4., 2., 3., 2., 1.}) local += 9 * times / 25 / 100;
  CHECK(film::seen_mse(t, references).all == Approx(1 / std::pow(0.05 * local, 2) / 100));
  const ReferencePair black{10, flat(100, vec3(0)), flat(100, vec3(0))};
  CHECK(film::seen_mse(t, black).all == 0);
  CHECK(film::seen_difference(t, black)[99] == 0);
  const ReferencePair one{1, flat(1, vec3(1)), flat(1, vec3(1))};
  CHECK(film::seen_mse(flat(1, vec3(2)), one).all == Approx(1 / std::pow(1.05, 2)));
  CHECK(film::seen_mse(flat(1, vec3(2)), one).trimmed == 0);
  CHECK(film::seen_mse({}, {}).all == 0);
  CHECK(film::seen_mse_noise({}) == 0);
  CHECK(film::seen_difference({}, {}).empty());
}

}  // namespace film_io_relative_mse_tests
