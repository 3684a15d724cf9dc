#pragma once
// What measurements say: time to an error, the performance index, spread over repeats and the noise of
// ratios. Pure functions.
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace lucerna::bench {

/// A render in progress: its error after that many seconds, both above 0. Curves are sorted by seconds.
struct Point {
  double seconds = 0, error = 0;
};

enum class ReachKind {
  measured,      ///< the curve passes through the error
  at_once,       ///< under it from the first point on: the time is an upper bound
  extrapolated,  ///< not reached: by error^2 * t = constant, from the last factor of four of the time
  unknown  ///< no curve; or not reached, by one that begins later than that: preparing records is no part
           ///< of how sampling goes on
};

struct Reach {
  ReachKind kind = ReachKind::unknown;
  double seconds = 0;
};

/// Value at x of the line through two points (xa, ya), (xb, yb) of a log-log plot, all above 0; ya if xa ==
/// xb.
double log_line(double xa, double ya, double xb, double yb, double x);

/// When the error is `target` for good: the curve's last passage through it, interpolated in the logarithms.
Reach time_to(std::span<const Point> curve, double target);

/// Error after that many seconds, interpolated in logarithms; nullopt outside the curve.
std::optional<double> error_at(std::span<const Point> curve, double seconds);

/// Error after that many seconds; beyond the curve's end extrapolated by error^2 * t = constant as in
/// time_to(), if valid; nullopt before its beginning.
struct ErrorAfter {
  ReachKind kind = ReachKind::unknown;  ///< measured or extrapolated
  double error = 0;
};
ErrorAfter error_after(std::span<const Point> curve, double seconds);

/// The power of t that error^2 falls with over the last factor of 16 of the time, by least squares of the
/// logarithms: -1 for plain Monte Carlo, on which extrapolation rests. Nothing for fewer than three points,
/// nor for a curve that begins later than that.
std::optional<double> power_of_time(std::span<const Point> curve);

/// Efficiency: 1 / (mean squared error * seconds), which for plain Monte Carlo does not depend on the time.
/// Nothing when either is not above 0.
std::optional<double> performance_index(double mean_squared_error, double seconds);

/// Over repeats.
struct Spread {
  double median = 0, low = 0, high = 0;
  size_t count = 0;
};
/// All 0 for no values.
Spread spread(std::vector<double> values);

/// The ratio below which two medians of `repeats` measurements differ by noise alone: nine in ten ratios of
/// two equal settings lie between 1/x and x. Each group holds the repeats of one setting, all above 0;
/// groups of one say nothing. From their pooled standard deviation s of the logarithms and Student's t with
/// the pooled degrees of freedom: x = exp(t s sqrt(2 c)), c the variance of the median of that many normal
/// values (0.449 for three). Nothing when no group has two values.
std::optional<double> noise_ratio(std::span<const std::vector<double>> groups, size_t repeats);

/// Spread of the curves over a common time grid, evenly spaced in log time from where all have begun to where
/// half of them have ended, at each time over the remaining ones; empty if there is no such time.
struct Band {
  double seconds = 0;
  Spread error;
};
std::vector<Band> common_curve(std::span<const std::vector<Point>> curves, size_t steps);

}  // namespace lucerna::bench
