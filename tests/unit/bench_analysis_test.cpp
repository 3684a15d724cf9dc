// links: bench
// The figures of the bench, computed from synthetic measurements with known answers.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "bench/analysis.h"

namespace bench_analysis_tests {

using namespace lucerna::bench;

namespace {

/// error = c t^-exponent at doubling times.
std::vector<Point> curve(double c, double exponent, double from, double to) {
  std::vector<Point> points;
  for (double t = from; t <= to * 1.001; t *= 2) points.push_back({t, c * std::pow(t, -exponent)});
  return points;
}

}  // namespace

TEST_CASE("Time to an error is interpolated with the curve's own power law") {
  for (const double exponent : {0.5, 0.8, 1.0}) {
    const auto c = curve(0.3, exponent, 0.1, 100);
    const Reach r = time_to(c, 0.0777);
    CHECK(r.kind == ReachKind::measured);
    CHECK(r.seconds == Approx(std::pow(0.3 / 0.0777, 1 / exponent)));
  }
}

TEST_CASE("Time to an error that was not reached is extrapolated with error^2 t = constant") {
  const auto c = curve(0.3, 0.5, 0.1, 8);
  const Reach r = time_to(c, 0.01);
  CHECK(r.kind == ReachKind::extrapolated);
  CHECK(r.seconds == Approx(900));
  // Noisy: the mean over the last points, never before the end of the curve.
  const std::vector<Point> noisy = {{1, 0.30}, {2, 0.18}, {4, 0.19}, {8, 0.10}};
  CHECK(time_to(noisy, 0.0999).seconds >= 8);
  // A cache that is built for 20 s: its samples are measured only from then on, too late for the power of
  // their decrease.
  CHECK(time_to(curve(0.3, 0.5, 2, 8), 0.01).kind == ReachKind::extrapolated);
  const std::vector<Point> built = {{20, 0.10}, {21, 0.07}, {24, 0.04}};
  CHECK(time_to(built, 0.05).kind == ReachKind::measured);
  CHECK(time_to(built, 0.01).kind == ReachKind::unknown);
  CHECK(error_after(built, 22).kind == ReachKind::measured);
  CHECK(error_after(built, 100).kind == ReachKind::unknown);
}

TEST_CASE("Time to an error: bounds, an error that rises again, no data") {
  const std::vector<Point> c = {{1, 0.4}, {2, 0.1}, {4, 0.3}, {8, 0.05}};
  // 0.2 is reached at 1..2, but permanently only after 4.
  const Reach r = time_to(c, 0.2);
  CHECK(r.kind == ReachKind::measured);
  CHECK(r.seconds > 4);
  CHECK(r.seconds < 8);
  CHECK(time_to(c, 0.5).kind == ReachKind::at_once);
  CHECK(time_to(c, 0.5).seconds == 1);
  CHECK(time_to({}, 0.1).kind == ReachKind::unknown);
  CHECK(time_to(c, 0).kind == ReachKind::unknown);
}

TEST_CASE("The error after a longer time is extrapolated with error^2 t = constant") {
  const auto c = curve(0.3, 0.5, 1, 64);
  CHECK(error_after(c, 10).kind == ReachKind::measured);
  CHECK(error_after(c, 10).error == Approx(0.3 / std::sqrt(10)));
  CHECK(error_after(c, 6400).kind == ReachKind::extrapolated);
  CHECK(error_after(c, 6400).error == Approx(0.3 / 80));
  CHECK(error_after(c, 0.5).kind == ReachKind::unknown);
  CHECK(error_after({}, 1).kind == ReachKind::unknown);
}

TEST_CASE("The exponent of time with which error^2 falls") {
  for (const double exponent : {0.25, 0.5, 0.6})
    CHECK(*power_of_time(curve(0.3, exponent, 1, 64)) == Approx(-2 * exponent));
  // Points before the last factor of 16 are ignored.
  std::vector<Point> late = curve(0.3, 0.5, 4, 64);
  late.insert(late.begin(), {3.9, 7});
  CHECK(*power_of_time(late) == Approx(-1));
  CHECK_FALSE(power_of_time(curve(0.3, 0.5, 1, 2)));
  CHECK(power_of_time(curve(0.3, 0.5, 4, 64)));
  CHECK_FALSE(power_of_time(curve(0.3, 0.5, 5, 64)));
  CHECK_FALSE(power_of_time({}));
}

TEST_CASE("Error at a time") {
  const auto c = curve(0.3, 0.5, 1, 64);
  CHECK(*error_at(c, 10) == Approx(0.3 / std::sqrt(10)));
  CHECK(*error_at(c, 1) == Approx(0.3));
  CHECK(*error_at(c, 64) == Approx(0.3 / 8));
  CHECK_FALSE(error_at(c, 0.9));
  CHECK_FALSE(error_at(c, 65));
  CHECK_FALSE(error_at({}, 1));
}

TEST_CASE("The performance index does not depend on the time of plain Monte Carlo") {
  const auto c = curve(0.3, 0.5, 1, 64);
  const double first = *performance_index(c[0].error * c[0].error, c[0].seconds);
  for (const Point& p : c) CHECK(*performance_index(p.error * p.error, p.seconds) == Approx(first));
  CHECK(*performance_index(0.04, 5) == Approx(5));
  CHECK_FALSE(performance_index(0, 5));
  CHECK_FALSE(performance_index(0.1, 0));
}

TEST_CASE("Median and range") {
  const Spread odd = spread({3, 1, 2}), even = spread({4, 1, 2, 3});
  CHECK(odd.median == 2);
  CHECK(odd.low == 1);
  CHECK(odd.high == 3);
  CHECK(even.median == 2.5);
  CHECK(even.count == 4);
  CHECK(spread({}).count == 0);
}

TEST_CASE("Nine in ten ratios of equal settings are within the noise ratio") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 0.2);
  int within = 0, known = 0;
  constexpr int k_trials = 4000;
  for (int trial = 0; trial < k_trials; ++trial) {
    std::vector<std::vector<double>> groups(3);
    for (auto& g : groups)
      for (int k = 0; k < 3; ++k) g.push_back(std::exp(normal(random)));
    const auto x = noise_ratio(groups, 3);
    known += x.has_value();
    const double ratio = spread(groups[1]).median / spread(groups[0]).median;
    within += x && ratio < *x && ratio > 1 / *x;
  }
  CHECK(known == k_trials);
  // 0.9 with a standard deviation of 0.005.
  CHECK(double(within) / k_trials == Approx(0.9).margin(0.02));
  CHECK_FALSE(noise_ratio(std::vector<std::vector<double>>{{1.0}, {2.0}}, 1));
}

TEST_CASE("Curves of repeats are resampled at common times") {
  const std::vector<std::vector<Point>> curves = {curve(0.2, 0.5, 1, 64), curve(0.3, 0.5, 1.5, 96),
                                                  curve(0.4, 0.5, 0.5, 32)};
  const auto bands = common_curve(curves, 10);
  REQUIRE(bands.size() == 10);
  CHECK(bands.front().seconds == 1.5);
  CHECK(bands.back().seconds == 64);
  for (const Band& b : bands) {
    // The third curve ends at 32 s.
    CHECK(b.error.count == (b.seconds <= 32 ? 3 : 2));
    if (b.seconds <= 32) CHECK(b.error.median == Approx(0.3 / std::sqrt(b.seconds)));
    CHECK(b.error.low == Approx(0.2 / std::sqrt(b.seconds)));
    CHECK(b.error.high == Approx((b.seconds <= 32 ? 0.4 : 0.3) / std::sqrt(b.seconds)));
  }
  CHECK(common_curve({{curve(1, 1, 1, 2), curve(1, 1, 1, 2), curve(1, 1, 4, 8)}}, 10).empty());
  CHECK(common_curve({}, 10).empty());
}

}  // namespace bench_analysis_tests
