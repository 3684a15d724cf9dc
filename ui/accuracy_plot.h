#pragma once
// What the Accuracy panel says and how far its plot reaches: plain arithmetic on what the session tells.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "runs.h"

namespace lucerna::ui {

/// The ends of the plot's axes: seconds of rendering, relative error; each 0 < lo < hi, at 1-2-5.
struct PlotRange {
  double t_lo = 0.1, t_hi = 100, e_lo = 0.001, e_hi = 1;
};

/// One way to sum the picture's estimated error up, by its name.
struct ErrorFigure {
  std::string name;  ///< goes on after "Error": "of the median tile"
  std::string short_name;
  double value = 0;  ///< relative
  std::string help;
};
/// Of the ledger's line: as seen, of the median tile, of the worst tenth of the tiles, of the mean; and where
/// samples look light up, what of the error as seen comes from the paths, from the noise of records if there
/// are any, and from the lookups' bias.
std::vector<ErrorFigure> error_figures(const stats::Entry& line);
/// Whether that is so: else the error is the paths' noise.
bool looks_up(const stats::Entry& line);

/// A range that holds the run's lines, its earlier ones, the target with room below it, and the forecast as
/// far as it does not squeeze what is known into a corner (300 times the time so far).
PlotRange plot_range(const session::Accuracy& accuracy, const std::deque<Run>& earlier, double target,
                     const std::optional<stats::Band>& forecast, double seconds);

/// What reaching the target costs, in words, from the fullest to the shortest: "1 % will take about 2 min
/// 10 s (1 min 40 s to 3 min)". `seconds`: of rendering so far.
std::vector<std::string> target_texts(const session::Accuracy& accuracy, double target,
                                      const std::optional<stats::Band>& forecast, double seconds);

/// The line from which the forecast goes on: of the sum's error in uniform sampling, of the hardest tile's
/// in adaptive. Nothing where there is none yet.
struct Present {
  double seconds = 0, error = 0;
};
std::optional<Present> present(const session::Accuracy& accuracy);

}  // namespace lucerna::ui
