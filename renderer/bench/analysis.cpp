#include "bench/analysis.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "film/error.h"

namespace lucerna::bench {
namespace {

/// Variance of the median of n values of a normal distribution of variance 1.
double median_variance(size_t n) {
  static constexpr double k_small[] = {0, 1, 0.5, 0.4487, 0.2982, 0.2868};
  return n < 6 ? k_small[n] : 1.5708 / double(n);
}

/// The part of a curve in the last `factor` of its time; none if it begins later.
std::span<const Point> last_factor(std::span<const Point> curve, double factor) {
  if (curve.empty() || curve.front().seconds > curve.back().seconds / factor) return {};
  const auto from = std::ranges::lower_bound(curve, curve.back().seconds / factor, {}, &Point::seconds);
  return {from, curve.end()};
}

/// Mean of error^2 * t, in logarithms, over the last factor of four of the time; none if the curve does not
/// cover it.
std::optional<double> log_constant(std::span<const Point> curve) {
  const auto last = last_factor(curve, 4);
  if (last.empty()) return std::nullopt;
  double sum = 0;
  for (const Point& p : last) sum += 2 * std::log(p.error) + std::log(p.seconds);
  return sum / double(last.size());
}

}  // namespace

double log_line(double xa, double ya, double xb, double yb, double x) {
  if (xa == xb) return ya;
  return std::exp(std::log(ya) + (std::log(yb) - std::log(ya)) * (std::log(x) - std::log(xa)) /
                                     (std::log(xb) - std::log(xa)));
}

Reach time_to(std::span<const Point> curve, double target) {
  if (curve.empty() || !(target > 0)) return {};
  size_t reached = curve.size();
  while (reached > 0 && curve[reached - 1].error <= target) --reached;
  if (reached == 0) return {ReachKind::at_once, curve[0].seconds};
  if (reached < curve.size()) {
    const Point &a = curve[reached - 1], &b = curve[reached];
    return {ReachKind::measured, log_line(a.error, a.seconds, b.error, b.seconds, target)};
  }
  const auto constant = log_constant(curve);
  if (!constant) return {};
  // Not before the end, where it has not been reached.
  return {ReachKind::extrapolated,
          std::max(curve.back().seconds, std::exp(*constant - 2 * std::log(target)))};
}

std::optional<double> error_at(std::span<const Point> curve, double seconds) {
  if (curve.empty() || seconds < curve.front().seconds || seconds > curve.back().seconds) return std::nullopt;
  size_t i = 1;
  while (i < curve.size() && curve[i].seconds < seconds) ++i;
  if (i == curve.size()) return curve.back().error;
  const Point &a = curve[i - 1], &b = curve[i];
  return log_line(a.seconds, a.error, b.seconds, b.error, seconds);
}

ErrorAfter error_after(std::span<const Point> curve, double seconds) {
  if (const auto error = error_at(curve, seconds)) return {ReachKind::measured, *error};
  const auto constant = log_constant(curve);
  if (!constant || seconds < curve.front().seconds) return {};
  return {ReachKind::extrapolated, std::exp((*constant - std::log(seconds)) / 2)};
}

std::optional<double> power_of_time(std::span<const Point> curve) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Point& p : last_factor(curve, 16)) {
    const double x = std::log(p.seconds), y = 2 * std::log(p.error);
    ++n, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 3 || !(spread > 0)) return std::nullopt;
  return (n * sxy - sx * sy) / spread;
}

std::optional<double> performance_index(double mean_squared_error, double seconds) {
  if (!(mean_squared_error > 0) || !(seconds > 0)) return std::nullopt;
  return 1 / (mean_squared_error * seconds);
}

Spread spread(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return {(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back(), n};
}

std::optional<double> noise_ratio(std::span<const std::vector<double>> groups, size_t repeats) {
  double squares = 0, degrees = 0;
  for (const std::vector<double>& group : groups) {
    if (group.size() < 2) continue;
    double mean = 0;
    for (const double x : group) mean += std::log(x) / double(group.size());
    for (const double x : group) squares += (std::log(x) - mean) * (std::log(x) - mean);
    degrees += double(group.size() - 1);
  }
  if (degrees == 0 || repeats == 0) return std::nullopt;
  return std::exp(film::student_90(degrees) * std::sqrt(squares / degrees * 2 * median_variance(repeats)));
}

std::vector<Band> common_curve(std::span<const std::vector<Point>> curves, size_t steps) {
  double from = 0;
  std::vector<double> ends;
  for (const auto& c : curves) {
    if (c.empty()) return {};
    from = std::max(from, c.front().seconds), ends.push_back(c.back().seconds);
  }
  if (ends.empty()) return {};
  std::sort(ends.begin(), ends.end());
  const double to = ends[ends.size() / 2];
  if (!(from > 0) || from >= to || steps < 2) return {};
  std::vector<Band> bands;
  for (size_t i = 0; i < steps; ++i) {
    // Exact ends, so that rounding does not put them outside a curve.
    const double t = i == 0           ? from
                     : i + 1 == steps ? to
                                      : from * std::pow(to / from, double(i) / double(steps - 1));
    std::vector<double> errors;
    for (const auto& c : curves)
      if (const auto e = error_at(c, t)) errors.push_back(*e);
    bands.push_back({t, spread(std::move(errors))});
  }
  return bands;
}

}  // namespace lucerna::bench
