// links: base
// Tests of the chi-squared test that the tests of all samplers use.
#include <catch2/catch.hpp>
#include <random>

#include "kernels/statistics_support.h"

namespace sampler_statistics_tests {

using namespace lucerna::test;

TEST_CASE("the incomplete gamma function has its closed forms") {
  // Two degrees of freedom: an exponential; one: a squared normal; an even number: a Poisson sum.
  for (const double x : {1e-6, 0.1, 1.0, 5.0, 30.0, 200.0}) {
    CHECK(chi_square_tail(x, 2) == Approx(std::exp(-x / 2)).epsilon(1e-12));
    CHECK(chi_square_tail(x, 1) == Approx(std::erfc(std::sqrt(x / 2))).epsilon(1e-11));
    for (const int half : {2, 7, 40}) {
      double term = std::exp(-x / 2), sum = term;
      for (int i = 1; i < half; ++i) sum += term *= x / 2 / i;
      CHECK(chi_square_tail(x, 2 * half) == Approx(sum).epsilon(1e-11));
    }
  }
  CHECK(chi_square_tail(0, 3) == 1);
}

TEST_CASE("quantiles as printed in tables") {
  CHECK(chi_square_tail(3.841459, 1) == Approx(0.05).epsilon(1e-6));
  CHECK(chi_square_tail(18.307038, 10) == Approx(0.05).epsilon(1e-6));
  CHECK(chi_square_tail(135.806723, 100) == Approx(0.01).epsilon(1e-6));
  CHECK(chi_square_tail(29.588298, 10) == Approx(0.001).epsilon(1e-6));
  CHECK(normal_tail(1.959964) == Approx(0.05).epsilon(1e-6));
  CHECK(normal_tail(-3.890592) == Approx(1e-4).epsilon(1e-5));
}

TEST_CASE("many tests share one significance level") {
  CHECK(significant_below(1) == Approx(k_alpha));
  CHECK(significant_below(1000) == Approx(k_alpha / 1000).epsilon(1e-3));
  CHECK(std::pow(1 - significant_below(300, 0.3), 300) == Approx(0.7));
}

TEST_CASE("cells with a low expectation are merged without losing draws") {
  const ChiSquare all = chi_square({10, 1, 1, 8, 0, 2}, {10, 2, 2, 6, 1, 1});
  // {10} {2 + 2 + 6} with the last two added: 10 against 10, 12 against 12.
  CHECK(all.freedom == 1);
  CHECK(all.statistic == Approx(0));
  // A draw where none is possible counts in the merged cell.
  CHECK(chi_square({10, 1000, 10}, {10, 0, 10}).p < 1e-100);
  CHECK(chi_square({3}, {3}).p == 1);
}

TEST_CASE("correct samplers have uniform p-values, and a wrong one is detected") {
  std::mt19937_64 random(5);
  constexpr int k_cells = 50, k_draws = 20000, k_rounds = 400;
  std::vector<double> weights(k_cells), expected(k_cells);
  double total = 0;
  for (int i = 0; i < k_cells; ++i) total += weights[i] = 1.0 / (1 + i * i);
  std::discrete_distribution<int> right(weights.begin(), weights.end());
  weights[3] *= 1.1;
  std::discrete_distribution<int> wrong(weights.begin(), weights.end());
  weights[3] /= 1.1;
  for (int i = 0; i < k_cells; ++i) expected[i] = k_draws * weights[i] / total;
  std::vector<double> deciles(10, 0);
  for (int round = 0; round < k_rounds; ++round) {
    std::vector<double> counts(k_cells, 0);
    for (int i = 0; i < k_draws; ++i) counts[right(random)] += 1;
    deciles[std::min(9, static_cast<int>(10 * chi_square(counts, expected).p))] += 1;
  }
  CHECK(chi_square(deciles, std::vector<double>(10, k_rounds / 10.0)).p > 1e-3);
  // One cell in the tail a tenth too likely: ten times the draws reveal it.
  std::vector<double> counts(k_cells, 0);
  for (int i = 0; i < 10 * k_draws; ++i) counts[wrong(random)] += 1;
  for (double& e : expected) e *= 10;
  CHECK(chi_square(counts, expected).p < 1e-6);
}

TEST_CASE("a mean and its error") {
  Mean mean;
  for (const double x : {1.0, 2.0, 3.0, 6.0}) mean.add(x);
  CHECK(mean.value() == Approx(3));
  CHECK(mean.error() == Approx(std::sqrt(3.5 / 3)));
}

}  // namespace sampler_statistics_tests
