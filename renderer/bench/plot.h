#pragma once
// Error over time, number of records, rounds or radii of photons, on logarithmic axes, as inline SVG.
#include <string>
#include <vector>

#include "bench/analysis.h"

namespace lucerna::bench {

/// Horizontal axis of an error plot.
enum class Across { seconds, records, rounds, radius };

struct PlotLine {
  std::string name, colour;
  struct Point {
    double across = 0;  ///< above 0
    Spread error;
  };
  std::vector<Point> points;  ///< median as a line, low and high as a band; from left to right
  /// End points of renders, with their tooltips.
  struct Dot {
    double across = 0, error = 0;
    std::string title;
  };
  std::vector<Dot> dots;
};

/// A plot of 540 by 320 units with every line's name at its end; errors are fractions, shown in per cent,
/// with a dotted line at each of `marks`. `title`: text for screen readers. "" if there is nothing to draw.
std::string make_plot(const std::vector<PlotLine>& lines, const std::vector<double>& marks,
                      const std::string& title, const std::string& error_axis,
                      Across across = Across::seconds);

/// The ticks 1, 2, 5 times powers of ten within [lo, hi], both above 0.
std::vector<double> log_ticks(double lo, double hi);

/// Moves positions apart to at least `gap`, keeping their order and mean if [lo, hi] permits. Positions need
/// not be sorted; the result has their order.
std::vector<double> spread_labels(const std::vector<double>& at, double gap, double lo, double hi);

}  // namespace lucerna::bench
