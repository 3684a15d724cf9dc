#pragma once
// Goodness of fit and its significance, for the tests of samplers. Everything is deterministic: draws have
// fixed seeds, so a test that passes once always passes on the same device.
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace lucerna::test {

/// Probability that all tests of one executable together report a false difference, over random seeds. Each
/// of n tests gets its part of k_alpha by Sidak's rule, see significant_below().
inline constexpr double k_alpha = 1e-4;

/// The level for each of `tests` independent tests such that all of them together have the level `alpha`.
inline double significant_below(size_t tests, double alpha = k_alpha) {
  return -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

/// Regularized upper incomplete gamma function Q(a, x), a > 0, x >= 0; relative error about 1e-12. The series
/// of P where it converges fast, otherwise Legendre's continued fraction by Lentz's method.
inline double gamma_q(double a, double x) {
  if (x <= 0) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > sum * 1e-17; n += 1) sum += term *= x / n;
    return 1 - front * sum;
  }
  constexpr double k_tiny = 1e-300;
  double b = x + 1 - a, c = 1 / k_tiny, d = 1 / b, h = d;
  for (double i = 1; i < 1e6; i += 1) {
    const double numerator = -i * (i - a);
    b += 2;
    d = numerator * d + b;
    if (std::abs(d) < k_tiny) d = k_tiny;
    d = 1 / d;
    c = b + numerator / c;
    if (std::abs(c) < k_tiny) c = k_tiny;
    h *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return front * h;
}

/// Probability that a chi-squared variable of `freedom` degrees exceeds `statistic`.
inline double chi_square_tail(double statistic, double freedom) {
  return gamma_q(0.5 * freedom, 0.5 * statistic);
}

/// Two-sided probability of a standard normal variable beyond |z|.
inline double normal_tail(double z) { return std::erfc(std::abs(z) * 0.70710678118654752); }

struct ChiSquare {
  double statistic = 0;
  size_t freedom = 0;
  double p = 1;  ///< probability of a statistic this large
};

/// Pearson's test of observed counts against expected ones (with the same sum up to rounding). Neighbouring
/// cells are merged until each expects at least `least`; the remainder joins the last one.
inline ChiSquare chi_square(const std::vector<double>& observed, const std::vector<double>& expected,
                            double least = 5) {
  std::vector<double> o, e;
  double sum_o = 0, sum_e = 0;
  for (size_t i = 0; i < observed.size(); ++i) {
    sum_o += observed[i];
    sum_e += std::max(expected[i], 0.0);
    if (sum_e < least) continue;
    o.push_back(sum_o), e.push_back(sum_e);
    sum_o = sum_e = 0;
  }
  if (e.empty()) return {};
  o.back() += sum_o, e.back() += sum_e;
  ChiSquare result;
  for (size_t i = 0; i < e.size(); ++i) result.statistic += (o[i] - e[i]) * (o[i] - e[i]) / e[i];
  result.freedom = e.size() - 1;
  if (result.freedom > 0) result.p = chi_square_tail(result.statistic, static_cast<double>(result.freedom));
  return result;
}

/// Mean of draws and the standard error of that mean.
struct Mean {
  double sum = 0, squares = 0, count = 0;
  void add(double x) { sum += x, squares += x * x, count += 1; }
  double value() const { return sum / count; }
  double error() const { return std::sqrt(std::max(0.0, squares / count - value() * value()) / (count - 1)); }
};

/// Probability of a mean this far from `expected`. `slack`: tolerance for errors of `expected` and rounding.
inline double mean_tail(const Mean& mean, double expected, double slack) {
  const double off = std::max(0.0, std::abs(mean.value() - expected) - slack);
  return off == 0 ? 1 : mean.error() == 0 ? 0 : normal_tail(off / mean.error());
}

/// Collects the probabilities of many tests and evaluates them together.
class Jury {
 public:
  void add(std::string what, double p) { tests_.emplace_back(std::move(what), p); }
  size_t size() const { return tests_.size(); }
  /// "" if no probability is below the common level, otherwise those that are.
  std::string verdict(double alpha = k_alpha) const {
    const double limit = significant_below(tests_.size(), alpha);
    std::string text;
    for (const auto& [what, p] : tests_)
      if (!(p >= limit))
        text += what + ": chance " + std::to_string(std::log10(std::max(p, 1e-300))) + " (log10)\n";
    return text;
  }

 private:
  std::vector<std::pair<std::string, double>> tests_;
};

}  // namespace lucerna::test
