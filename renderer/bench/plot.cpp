#include "bench/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/markup.h"
#include "bench/html.h"

namespace lucerna::bench {
namespace {

constexpr double k_width = 540, k_height = 320, k_left = 56, k_right = 104, k_top = 28, k_bottom = 44;

struct Axis {
  double lo = 1, hi = 1, from = 0, to = 0;
  double at(double x) const { return from + (to - from) * std::log(x / lo) / std::log(hi / lo); }
};

/// Range widened to a minimum factor and by a margin on both sides, so that lines do not touch the frame.
void widen(double& lo, double& hi, double factor, double margin) {
  const double k = std::sqrt(std::max(1.0, factor / (hi / lo)));
  lo /= k * margin, hi *= k * margin;
}

std::string short_number(double x) { return fmt::format("{:.6g}", x); }

const char* across_text(Across across) {
  switch (across) {
    case Across::records:
      return "records that light is looked up in";
    case Across::rounds:
      return "rounds of photons";
    case Across::radius:
      return "radius in pixels";
    case Across::seconds:
      break;
  }
  return "seconds of rendering";
}

/// Thousands of records as "5 k", which fits between two ticks.
std::string tick_text(double x, Across across) {
  return across == Across::records && x >= 1000 ? short_number(x / 1000) + " k" : short_number(x);
}

/// 1-2-5 ticks, reduced to powers of ten if crowded; more for a short axis.
std::vector<double> axis_ticks(const Axis& axis, double gap) {
  std::vector<double> ticks = log_ticks(axis.lo, axis.hi);
  if (ticks.size() < 3)
    for (const double more : {3.0, 4.0, 7.0})
      for (double t = more * std::pow(10.0, std::floor(std::log10(axis.lo))); t < axis.hi; t *= 10)
        if (t > axis.lo) ticks.push_back(t);
  const double a_factor_of_two = std::abs(axis.at(2 * axis.lo) - axis.from);
  if (a_factor_of_two < gap)
    std::erase_if(ticks, [](double t) {
      const double decade = std::log10(t);
      return std::abs(decade - std::round(decade)) > 1e-6;
    });
  return ticks;
}

std::string path_of(const PlotLine& line, const Axis& x, const Axis& y) {
  std::string path;
  for (const PlotLine::Point& p : line.points)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x.at(p.across), y.at(p.error.median));
  return path;
}

std::string band_of(const PlotLine& line, const Axis& x, const Axis& y) {
  std::string path;
  for (const PlotLine::Point& p : line.points)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x.at(p.across), y.at(p.error.high));
  for (auto p = line.points.rbegin(); p != line.points.rend(); ++p)
    path += fmt::format(" L{:.1f} {:.1f}", x.at(p->across), y.at(p->error.low));
  return path + " Z";
}

}  // namespace

std::vector<double> log_ticks(double lo, double hi) {
  std::vector<double> ticks;
  if (!(lo > 0) || !(hi > lo)) return ticks;
  for (double power = std::pow(10.0, std::floor(std::log10(lo))); power <= hi * 1.0001; power *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (step * power >= lo * 0.9999 && step * power <= hi * 1.0001) ticks.push_back(step * power);
  return ticks;
}

std::vector<double> spread_labels(const std::vector<double>& at, double gap, double lo, double hi) {
  std::vector<size_t> order(at.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return at[a] < at[b]; });
  std::vector<double> out = at;
  // Runs of labels that touch are laid out around their mean; runs that then touch are joined.
  struct Group {
    double mean = 0;
    std::vector<size_t> members;
  };
  std::vector<Group> groups;
  const auto top_of = [&](const Group& g) {
    const double span = gap * double(g.members.size() - 1);
    return std::clamp(g.mean - span / 2, lo, std::max(lo, hi - span));
  };
  for (const size_t i : order) {
    groups.push_back({at[i], {i}});
    while (groups.size() > 1) {
      Group &a = groups[groups.size() - 2], &b = groups.back();
      if (top_of(a) + gap * double(a.members.size()) <= top_of(b)) break;
      const double na = double(a.members.size()), nb = double(b.members.size());
      a.mean = (a.mean * na + b.mean * nb) / (na + nb);
      a.members.insert(a.members.end(), b.members.begin(), b.members.end());
      groups.pop_back();
    }
  }
  for (const Group& g : groups)
    for (size_t k = 0; k < g.members.size(); ++k) out[g.members[k]] = top_of(g) + gap * double(k);
  return out;
}

std::string make_plot(const std::vector<PlotLine>& lines, const std::vector<double>& marks,
                      const std::string& title, const std::string& error_axis, Across across) {
  Axis x{1e300, 0, k_left, k_width - k_right}, y{1e300, 0, k_height - k_bottom, k_top};
  const auto include = [&](double at, double low, double high) {
    x.lo = std::min(x.lo, at), x.hi = std::max(x.hi, at);
    y.lo = std::min(y.lo, low), y.hi = std::max(y.hi, high);
  };
  for (const PlotLine& line : lines) {
    for (const PlotLine::Point& p : line.points) include(p.across, p.error.low, p.error.high);
    for (const PlotLine::Dot& d : line.dots) include(d.across, d.error, d.error);
  }
  if (!(x.hi > 0) || !(y.lo > 0)) return "";
  widen(x.lo, x.hi, 4, 1.1), widen(y.lo, y.hi, 4, 1.12);

  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n<rect x=\"{}\" y=\"{}\" width=\"{}\" "
      "height=\"{}\" fill=\"#191919\"/>\n",
      k_width, k_height, escape_markup(title), x.from, y.to, x.to - x.from, y.from - y.to);
  for (const double t : axis_ticks(x, 26))
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1} V{2}\" stroke=\"#2b2b2b\"/><text x=\"{0:.1f}\" y=\"{3}\" fill=\"#a09f9d\" "
        "text-anchor=\"middle\">{4}</text>\n",
        x.at(t), y.to, y.from, y.from + 17, tick_text(t, across));
  for (const double t : axis_ticks(y, 15))
    svg += fmt::format(
        "<path d=\"M{0} {1:.1f} H{2}\" stroke=\"#2b2b2b\"/><text x=\"{3}\" y=\"{4:.1f}\" fill=\"#a09f9d\" "
        "text-anchor=\"end\">{5} %</text>\n",
        x.from, y.at(t), x.to, x.from - 8, y.at(t) + 4, short_number(100 * t));
  for (const double t : marks)
    if (t > y.lo && t < y.hi)
      svg += fmt::format("<path d=\"M{} {:.1f} H{}\" stroke=\"#8a8988\" stroke-dasharray=\"1 4\"/>\n", x.from,
                         y.at(t), x.to);
  svg += fmt::format(
      "<text x=\"{}\" y=\"{}\" fill=\"#a09f9d\" text-anchor=\"end\">{}</text>\n"
      "<text x=\"{}\" y=\"{}\" fill=\"#e2e1df\">{}</text>\n",
      x.to, k_height - 8, across_text(across), k_left, k_top - 12, escape_markup(error_axis));

  std::vector<double> ends;
  std::vector<size_t> labelled;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].points.empty() && lines[i].dots.empty()) continue;
    labelled.push_back(i);
    ends.push_back(
        y.at(lines[i].points.empty() ? lines[i].dots.back().error : lines[i].points.back().error.median));
  }
  const std::vector<double> at = spread_labels(ends, 17, y.to + 8, y.from - 4);
  for (const PlotLine& line : lines)
    if (line.points.size() > 1)
      svg += fmt::format("<path d=\"{}\" fill=\"{}\" fill-opacity=\"0.16\"/>\n", band_of(line, x, y),
                         line.colour);
  for (size_t k = 0; k < labelled.size(); ++k) {
    const PlotLine& line = lines[labelled[k]];
    if (line.points.size() > 1)
      svg += fmt::format(
          "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.75\" stroke-linejoin=\"round\">"
          "<title>{}</title></path>\n",
          path_of(line, x, y), line.colour, escape_markup(line.name));
    for (const PlotLine::Dot& d : line.dots)
      svg += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"#191919\" stroke=\"{}\" "
          "stroke-width=\"1.75\">"
          "<title>{}</title></circle>\n",
          x.at(d.across), y.at(d.error), line.colour, escape_markup(d.title));
    // From the end of the line to its name.
    const double from = x.at(line.points.empty() ? line.dots.back().across : line.points.back().across);
    svg += fmt::format(
        "<path d=\"M{:.1f} {:.1f} L{:.1f} {:.1f}\" stroke=\"{}\" stroke-opacity=\"0.35\" "
        "stroke-dasharray=\"2 3\"/><text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n",
        from + 4, ends[k], x.to + 4, at[k], line.colour, x.to + 8, at[k] + 4, line.colour,
        escape_markup(line.name.size() > 14 ? line.name.substr(0, 13) + "…" : line.name));
  }
  return svg + "</svg>";
}

}  // namespace lucerna::bench
