#include "chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lucerna::ui {
namespace {

constexpr double k_least_target = 0.0001, k_most_target = 10;  // range of sampling.target_error

/// 1-2-5 of every decade from lo to hi; `steps` 1: powers of ten only, 9: all whole multiples.
std::vector<double> decades(double lo, double hi, int steps) {
  std::vector<double> values;
  for (int e = static_cast<int>(std::floor(std::log10(lo))); std::pow(10.0, e) <= hi * (1 + 1e-9); ++e)
    for (int m = 1; m < 10; ++m) {
      if (steps == 1 && m > 1) break;
      if (steps == 3 && m != 1 && m != 2 && m != 5) continue;
      const double v = m * std::pow(10.0, e);
      if (v >= lo * (1 - 1e-9) && v <= hi * (1 + 1e-9)) values.push_back(v);
    }
  return values;
}

/// Times as on clocks, from fine (0) to coarse (2).
std::vector<double> times(double lo, double hi, int level) {
  std::vector<double> values = decades(lo, std::min(hi, level == 2 ? 1.0 : 10.0), level == 0 ? 3 : 1);
  static const std::vector<double> all[3] = {
      {20, 60, 120, 300, 600, 1200, 3600, 7200, 18000, 36000, 86400, 172800, 432000, 864000},
      {60, 600, 3600, 36000, 86400, 864000},
      {60, 3600, 86400, 864000}};
  for (const double v : all[level])
    if (v >= lo * (1 - 1e-9) && v <= hi * (1 + 1e-9)) values.push_back(v);
  return values;
}

bool fits(const LogAxis& axis, const std::vector<double>& values, float room) {
  for (size_t i = 1; i < values.size(); ++i)
    if (std::abs(axis.at(values[i]) - axis.at(values[i - 1])) < room) return false;
  return true;
}

}  // namespace

float LogAxis::at(double value) const {
  const double t = value > 0 ? std::log(value / lo) / std::log(hi / lo) : -1;
  return static_cast<float>(from + std::clamp(t, -1.0, 2.0) * (to - from));
}

double LogAxis::value(float place) const {
  return lo * std::pow(hi / lo, static_cast<double>((place - from) / (to - from)));
}

std::vector<Tick> ticks(const LogAxis& axis, Unit unit, float room) {
  const auto set = [&](int level) {
    if (unit == Unit::seconds) return times(axis.lo, axis.hi, std::clamp(level - 1, 0, 2));
    return decades(axis.lo, axis.hi, level == 0 ? 9 : level == 1 ? 3 : 1);
  };
  int level = 1;
  while (level < 3 && !fits(axis, set(level), room)) ++level;
  std::vector<double> labelled = set(level);
  for (size_t skip = 2; !fits(axis, labelled, room) && skip < 64; ++skip) {
    labelled.clear();
    const std::vector<double> all = set(3);
    for (size_t i = 0; i < all.size(); i += skip) labelled.push_back(all[i]);
  }
  std::vector<Tick> list;
  for (const double v : labelled) list.push_back({v, true});
  for (const double v : set(std::max(0, level - 1)))
    if (std::none_of(labelled.begin(), labelled.end(), [&](double l) { return std::abs(l / v - 1) < 1e-6; }))
      list.push_back({v, false});
  std::sort(list.begin(), list.end(), [](const Tick& a, const Tick& b) { return a.value < b.value; });
  return list;
}

std::string tick_text(double value, Unit unit) {
  switch (unit) {
    case Unit::relative:
      return fmt::format("{:.4g} %", 100 * value);
    case Unit::milliseconds:
      if (value < 0.001) return fmt::format("{:.3g} ns", 1e6 * value);
      if (value < 1) return fmt::format("{:.3g} \xC2\xB5s", 1e3 * value);
      return value < 1000 ? fmt::format("{:.3g} ms", value) : fmt::format("{:.3g} s", 1e-3 * value);
    case Unit::count:
      if (value >= 1e9) return fmt::format("{:.3g}G", 1e-9 * value);
      if (value >= 1e6) return fmt::format("{:.3g}M", 1e-6 * value);
      return value >= 1e4 ? fmt::format("{:.3g}k", 1e-3 * value) : fmt::format("{:.4g}", value);
    case Unit::seconds:
      break;
  }
  if (value < 0.0995) return fmt::format("{:.3g} ms", 1e3 * value);
  if (value < 59.5) return fmt::format("{:.3g} s", value);
  if (value < 3599) return fmt::format("{:.3g} min", value / 60);
  if (value < 86399) return fmt::format("{:.3g} h", value / 3600);
  return fmt::format("{:.3g} d", value / 86400);
}

double nice_below(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-9)), m = value / decade;
  return (m >= 5 - 1e-9 ? 5 : m >= 2 - 1e-9 ? 2 : 1) * decade;
}

double nice_above(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-9)), m = value / decade;
  return (m <= 1 + 1e-9 ? 1 : m <= 2 + 1e-9 ? 2 : m <= 5 + 1e-9 ? 5 : 10) * decade;
}

std::string about_text(double s) {
  const auto whole = [](double x, double step) {
    return static_cast<int64_t>(std::llround(x / step) * step);
  };
  const auto two = [](int64_t n, const char* large, int64_t rest, const char* small) {
    return rest == 0 ? fmt::format("{} {}", n, large) : fmt::format("{} {} {} {}", n, large, rest, small);
  };
  if (!(s < 3.15e9)) return "a century";
  if (s < 9.95) return fmt::format("{:.1f} s", s);
  if (s < 59.5) return fmt::format("{:.0f} s", s);
  if (s < 595) {
    const int64_t n = whole(s, s < 300 ? 5 : 10);
    return two(n / 60, "min", n % 60, "s");
  }
  if (s < 3570) return fmt::format("{} min", whole(s / 60, 1));
  if (s < 35700) {
    const int64_t n = whole(s / 60, s < 18000 ? 5 : 10);
    return two(n / 60, "h", n % 60, "min");
  }
  if (s < 171000) return fmt::format("{} h", whole(s / 3600, 1));
  if (s < 3.15e7) return fmt::format("{} days", whole(s / 86400, 1));
  const int64_t years = whole(s / 3.156e7, 1);
  return fmt::format("{} year{}", years, years == 1 ? "" : "s");
}

std::string percent_text(double fraction) {
  const double p = 100 * fraction;
  if (!(p >= 0)) return "\xE2\x80\x93";
  if (p >= 999.5) return "> 999 %";
  const int decimals = p < 0.0995 ? 3 : p < 9.95 ? 2 : p < 99.5 ? 1 : 0;
  return fmt::format("{:.{}f} %", p, decimals);
}

double snapped_target(double value) {
  const double v = std::clamp(value, k_least_target, k_most_target);
  const double grain = std::pow(10.0, std::floor(std::log10(v) + 1e-9) - 1);
  return std::clamp(std::round(v / grain) * grain, k_least_target, k_most_target);
}

void dashed_line(ImDrawList* list, const std::vector<ImVec2>& points, ImU32 colour, float on, float off,
                 float width) {
  float gone = 0;  // distance along the pattern
  for (size_t i = 1; i < points.size(); ++i) {
    const ImVec2 a = points[i - 1], b = points[i];
    const float dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    for (float s = 0; s < length;) {
      const float phase = std::fmod(gone, on + off);
      const float step = std::min(length - s, phase < on ? on - phase : on + off - phase);
      if (phase < on)
        list->AddLine({a.x + dx * s / length, a.y + dy * s / length},
                      {a.x + dx * (s + step) / length, a.y + dy * (s + step) / length}, colour, width);
      s += std::max(step, 1e-3f);
      gone += std::max(step, 1e-3f);
    }
  }
}

}  // namespace lucerna::ui
