#include "bench/photon_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucerna::bench {
namespace {

double root(double x) { return x > 0 ? std::sqrt(x) : 0; }

}  // namespace

std::optional<double> log_slope(std::span<const double> x, std::span<const double> y) {
  double n = 0, sx = 0, sy = 0;
  for (size_t i = 0; i < x.size(); ++i)
    if (x[i] > 0 && y[i] > 0) ++n, sx += std::log(x[i]), sy += std::log(y[i]);
  if (n < 2) return std::nullopt;
  double xx = 0, xy = 0;
  for (size_t i = 0; i < x.size(); ++i)
    if (x[i] > 0 && y[i] > 0) {
      const double dx = std::log(x[i]) - sx / n;
      xx += dx * dx, xy += dx * (std::log(y[i]) - sy / n);
    }
  if (!(xx > 1e-12)) return std::nullopt;
  return xy / xx;
}

double student_t95(size_t degrees) {
  if (degrees < 1) return std::numeric_limits<double>::infinity();
  const double z = 1.959964, v = double(degrees), z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z,
               z9 = z7 * z * z;
  return z + (z3 + z) / (4 * v) + (5 * z5 + 16 * z3 + 3 * z) / (96 * v * v) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * v * v * v) +
         (79 * z9 + 776 * z7 + 1482 * z5 - 1920 * z3 - 945 * z) / (92160 * v * v * v * v);
}

ErrorCurves error_curves(std::span<const SeedPictures> renders, std::span<const uint8_t> mask,
                         std::optional<size_t> without) {
  ErrorCurves curves;
  std::vector<const SeedPictures*> used;
  for (size_t s = 0; s < renders.size(); ++s)
    if (s != without) used.push_back(&renders[s]);
  const double n = double(used.size());
  const bool known = !renders[0].truth.empty();
  for (size_t k = 0; k < renders[0].after.size(); ++k) {
    double mean = 0, variance = 0, products = 0;
    for (size_t p = 0; p < mask.size(); ++p) {
      if (mask[p] == 0) continue;
      double sum = 0, squares = 0, off = 0, off2 = 0;
      for (const SeedPictures* s : used) {
        const double value = s->after[k][p], d = known ? value - double(s->truth[p]) : 0;
        mean += (known ? double(s->truth[p]) : value) / n;
        sum += value, squares += value * value, off += d, off2 += d * d;
      }
      variance += std::max(0.0, squares - sum * sum / n) / (n - 1);
      products += (off * off - off2) / (n * (n - 1));
    }
    const double count = double(std::count_if(mask.begin(), mask.end(), [](uint8_t m) { return m != 0; }));
    const double unit = mean > 0 ? std::sqrt(count) / mean : 0;  // 1 / (mean luminance * root of the pixels)
    curves.noise.push_back(root(variance) * unit);
    curves.bias.push_back(root(products) * unit);
    curves.error.push_back(known ? root(variance + products) * unit : 0);
  }
  return curves;
}

std::array<std::optional<Slope>, 3> error_slopes(std::span<const double> x,
                                                 std::span<const SeedPictures> renders,
                                                 std::span<const uint8_t> mask) {
  std::array<std::optional<Slope>, 3> slopes;
  const size_t n = renders.size();
  if (n < 3) return slopes;
  const ErrorCurves all = error_curves(renders, mask);
  std::vector<ErrorCurves> parts;
  for (size_t s = 0; s < n; ++s) parts.push_back(error_curves(renders, mask, s));
  constexpr std::array<std::vector<double> ErrorCurves::*, 3> k_curves = {
      &ErrorCurves::noise, &ErrorCurves::bias, &ErrorCurves::error};
  for (size_t c = 0; c < k_curves.size(); ++c) {
    const auto slope_of = [&](const ErrorCurves& e) -> std::optional<double> {
      const std::vector<double>& y = e.*k_curves[c];
      if (std::any_of(y.begin(), y.end(), [](double v) { return !(v > 0); })) return std::nullopt;
      return log_slope(x, y);
    };
    const std::optional<double> whole = slope_of(all);
    if (!whole) continue;
    double mean = 0, squares = 0;
    bool lost = false;
    for (const ErrorCurves& e : parts) {
      const std::optional<double> part = slope_of(e);
      lost = lost || !part;
      mean += part.value_or(0) / double(n), squares += part.value_or(0) * part.value_or(0);
    }
    if (lost) continue;
    const double deviation =
        root((double(n) - 1) / double(n) * (squares - double(n) * mean * mean)) * student_t95(n - 1);
    slopes[c] = Slope{*whole, *whole - deviation, *whole + deviation};
  }
  return slopes;
}

Slope median95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  // P(fewer than k + 1 of n values below the median), each with probability 1/2: at most 2.5 %.
  size_t k = 0;
  double term = std::pow(0.5, double(n)), below = term;
  while (below <= 0.025 && k + 1 < n - k - 1) {
    ++k;
    term *= double(n - k + 1) / double(k);
    below += term;
  }
  if (k > 0) --k;
  const double middle = n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
  return {middle, values[k], values[n - 1 - k]};
}

}  // namespace lucerna::bench
