#pragma once
// Evaluation of measurements: time to an error, performance index, spread over repeats and noise of ratios.
// Pure functions.
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace lucerna::bench {

/// A point of a render's progress: error after that many seconds, both above 0. Curves are sorted by seconds.
struct Point {
  double seconds = 0, error = 0;
};

enum class ReachKind {
  measured,      ///< the curve passes through the error
  at_once,       ///< below the error from the first point: the time is an upper bound
  extrapolated,  ///< not reached: by error^2 * t = constant, from the last factor of four of the time
  unknown  ///< no curve; or not reached by a curve that begins later than that, because its beginning is the
           ///< preparation of records, not sampling
};

struct Reach {
  ReachKind kind = ReachKind::unknown;
  double seconds = 0;
};

/// Value at x of the line through two points (xa, ya), (xb, yb) of a log-log plot, all above 0; ya if xa ==
/// xb.
double log_line(double xa, double ya, double xb, double yb, double x);

/// Time after which the error stays below `target`: the curve's last crossing, interpolated in logarithms.
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

/// Exponent of the fall of error^2 with t over the last factor of 16 of the time, by least squares of the
/// logarithms: -1 for plain Monte Carlo, which extrapolation assumes. None for fewer than three points or a
/// curve that begins later than that.
std::optional<double> power_of_time(std::span<const Point> curve);

/// Efficiency: 1 / (mean squared error * seconds), independent of time for plain Monte Carlo. None if either
/// is not above 0.
std::optional<double> performance_index(double mean_squared_error, double seconds);

/// Statistics over repeats.
struct Spread {
  double median = 0, low = 0, high = 0;
  size_t count = 0;
};
/// All 0 without values.
Spread spread(std::vector<double> values);

/// Ratio up to which two medians of `repeats` measurements may differ by noise: nine in ten ratios of two
/// equal settings are between 1/x and x. Each group contains the repeats of one setting, all above 0; groups
/// of one have no information. From their pooled standard deviation s of the logarithms and Student's t with
/// the pooled degrees of freedom: x = exp(t s sqrt(2 c)), c the variance of the median of that many normal
/// values (0.449 for three). None if no group has two values.
std::optional<double> noise_ratio(std::span<const std::vector<double>> groups, size_t repeats);

/// Spread of the curves over a common time grid, evenly spaced in log time from where all have begun to where
/// half of them have ended, at each time over the remaining ones; empty if there is no such time.
struct Band {
  double seconds = 0;
  Spread error;
};
std::vector<Band> common_curve(std::span<const std::vector<Point>> curves, size_t steps);

}  // namespace lucerna::bench
