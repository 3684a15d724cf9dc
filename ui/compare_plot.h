#pragma once
// Accuracy against time of held results and the live picture, for the Compare panel. Computed without a
// window.
#include <string>
#include <utility>
#include <vector>

#include "accuracy_plot.h"
#include "commands/held_results.h"

namespace lucerna::ui {

/// One result of the plot: error as seen over seconds of rendering.
struct CompareLine {
  std::string mark;  ///< "A", "B", ..., as in the list; "" of the live picture
  std::string name;
  bool compared = false;  ///< the one compared with the live picture
  std::vector<std::pair<double, double>>
      points;  ///< seconds, relative error; both > 0; by time, one at least
};

/// The mark of the result at that place of the list.
std::string held_mark(size_t index);

/// Lines of the held results with known error and time, and of the live picture last. Others are left out.
std::vector<CompareLine> compare_lines(const commands::HeldResults& results, const session::Snapshot* live);

/// Ranges that contain all points, with room around them. Defaults without lines.
PlotRange compare_range(const std::vector<CompareLine>& lines);

/// "2.1 %": the estimated error of samples as seen; of a filtered picture "3.4 % off, filtered": of the
/// median tile. "" if it is not known.
std::string held_error_text(const session::HeldPicture& picture);
/// "cache, 12 s, 2.1 %". In full: "before: path, caustic only, 12 s, 3.4 % off, filtered", with the state of
/// the light, the methods, the shown components, time and error.
std::string held_text(const commands::HeldResult& held);
/// The same of the live picture.
std::string live_text(const session::Snapshot& live);

}  // namespace lucerna::ui
