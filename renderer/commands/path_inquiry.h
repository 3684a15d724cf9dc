#pragma once
// Paths of a pixel that are being traced or followed, and the noise that is being explained.
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recording/noise.h"
#include "session/session.h"

namespace lucerna::commands {

/// By inspect.trace.
struct PathInquiry {
  vec2 at{0};  ///< 0..1 to the right and down
  std::shared_future<std::shared_ptr<const recording::Recording>> traced;
  std::shared_ptr<const recording::Recording> paths;  ///< null until they are traced
  std::vector<uint32_t> order;                        ///< indices of the paths, the brightest first
  double mean_light = 0;                              ///< mean luminance of the paths
  size_t dark = 0;                                    ///< paths without light
  std::string problem;                                ///< why there are none
  int followed = -1;                                  ///< place in `order`; -1: none
  int vertex = -1;                                    ///< its marked event; -1: none

  bool done() const { return paths || !problem.empty(); }
  /// Takes the result when it is there, and logs a summary.
  void refresh();
  /// What is drawn over the picture.
  session::ShownPaths shown() const;
};

/// By inspect.noise.
struct NoiseInquiry {
  vec2 lo{0}, hi{1};  ///< 0..1 to the right and down
  std::shared_future<recording::NoiseReport> explained;
  std::optional<recording::NoiseReport> report;
  std::string problem;

  bool whole_picture() const { return lo == vec2(0) && hi == vec2(1); }
  bool done() const { return report || !problem.empty(); }
  void refresh();
};

}  // namespace lucerna::commands
