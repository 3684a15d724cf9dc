#pragma once
// Texts and ranges of the Accuracy panel, computed from the session's data without a window.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "runs.h"

namespace lucerna::ui {

/// The ranges of the plot's axes: seconds of rendering, relative error. 0 < lo < hi, at 1-2-5.
struct PlotRange {
  double t_lo = 0.1, t_hi = 100, e_lo = 0.001, e_hi = 1;
};

/// A figure for the picture's estimated error.
struct ErrorFigure {
  std::string name;  ///< continues "Error": "of the median tile"
  std::string short_name;
  double value = 0;  ///< relative
  std::string help;
};
/// The figures of a line of the ledger: as seen, of the median tile, of the worst tenth of the tiles, of the
/// mean. If samples look light up, also the parts of the error as seen: paths, noise of records if there are
/// any, bias of lookups.
std::vector<ErrorFigure> error_figures(const stats::Entry& line);
/// True if samples look light up; otherwise the error is the paths' noise.
bool looks_up(const stats::Entry& line);

/// A range that contains the run's lines, earlier runs, the target with room below it, and the forecast up to
/// 300 times the time so far.
PlotRange plot_range(const session::Accuracy& accuracy, const std::deque<Run>& earlier, double target,
                     const std::optional<stats::Band>& forecast, double seconds);

/// The cost of reaching the target in words, longest text first: "1 % will take about 2 min 10 s (1 min 40 s
/// to 3 min)". `seconds`: of rendering so far.
std::vector<std::string> target_texts(const session::Accuracy& accuracy, double target,
                                      const std::optional<stats::Band>& forecast, double seconds);

/// The point where the forecast starts: on the line of the sum's error in uniform sampling, of the hardest
/// tile in adaptive sampling. Nothing if there is none yet.
struct Present {
  double seconds = 0, error = 0;
};
std::optional<Present> present(const session::Accuracy& accuracy);

}  // namespace lucerna::ui
