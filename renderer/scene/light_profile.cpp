#include "scene/light_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/alias_table.h"

namespace lucerna::scene {
namespace {

/// Integrals of (1 - s) sin(theta) and s sin(theta) over theta from a to b, s: share of the way.
std::pair<double, double> shares(double a, double b) {
  const double whole = std::cos(a) - std::cos(b);
  const double first = (std::sin(b) - b * std::cos(b) - std::sin(a) + a * std::cos(a) - a * whole) / (b - a);
  return {whole - first, first};
}

}  // namespace

float LightProfile::along(const vec3& direction) const {
  const double polar = std::atan2(std::hypot(double{direction.x}, double{direction.y}), -double{direction.z});
  double around = std::atan2(double{direction.y}, double{direction.x}) / (2 * std::numbers::pi);
  around -= std::floor(around);
  const double row = std::clamp(polar / std::numbers::pi, 0.0, 1.0) * (rows - 1), column = around * columns;
  const auto r = std::min(uint32_t(row), rows - 2), c = uint32_t(column) % columns;
  const uint32_t next = (c + 1) % columns;
  const double x = column - std::floor(column), y = row - r;
  const auto at = [&](uint32_t i, uint32_t k) { return double{intensity[size_t{i} * columns + k]}; };
  return float(
      std::lerp(std::lerp(at(r, c), at(r, next), x), std::lerp(at(r + 1, c), at(r + 1, next), x), y));
}

std::vector<double> LightProfile::cells() const {
  std::vector<double> integrals;
  integrals.reserve(size_t{rows - 1} * columns);
  const double step = std::numbers::pi / (rows - 1), width = 2 * std::numbers::pi / columns;
  for (uint32_t r = 0; r + 1 < rows; ++r) {
    const auto [upper, lower] = shares(step * r, step * (r + 1));
    for (uint32_t c = 0; c < columns; ++c) {
      const uint32_t next = (c + 1) % columns;
      const auto pair = [&](uint32_t row) {
        return 0.5 * (double{intensity[size_t{row} * columns + c]} +
                      double{intensity[size_t{row} * columns + next]});
      };
      integrals.push_back(width * (upper * pair(r) + lower * pair(r + 1)));
    }
  }
  return integrals;
}

LightProfile sampled_profile(const std::function<double(double, double)>& candela, bool even) {
  LightProfile p;
  p.rows = k_profile_rows, p.columns = even ? 1 : k_profile_columns;
  std::vector<double> values;
  values.reserve(size_t{p.rows} * p.columns);
  for (uint32_t r = 0; r < p.rows; ++r)
    for (uint32_t c = 0; c < p.columns; ++c)
      values.push_back(candela(180.0 * r / (p.rows - 1), 360.0 * c / p.columns));
  // At the poles all columns are one direction.
  for (const size_t row : {size_t{0}, size_t{p.rows - 1}}) {
    double sum = 0;
    for (uint32_t c = 0; c < p.columns; ++c) sum += values[row * p.columns + c] / p.columns;
    std::fill_n(values.begin() + std::ptrdiff_t(row * p.columns), p.columns, sum);
  }
  p.peak = *std::max_element(values.begin(), values.end());
  for (const double v : values) p.intensity.push_back(p.peak > 0 ? float(v / p.peak) : 0.f);
  const std::vector<double> cells = p.cells();
  for (const double cell : cells) p.solid_angle += cell;
  p.alias = build_alias_table(cells);
  return p;
}

}  // namespace lucerna::scene
