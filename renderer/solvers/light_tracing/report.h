#pragma once
// Report of light tracing.
#include "overlay/light_paths.h"
#include "solvers/light_tracing/splats.h"
#include "solvers/report.h"

namespace lucerna::light_tracing {

struct LightTracingReport {
  double lights_power = 0;  ///< luminance of all lights' flux [W]
  bool sends = true;        ///< traces light paths; false: nothing in the scene focuses light
  bool ready = true;        ///< the pilot is complete
  uint64_t rounds = 0, paths = 0, joined = 0, escaped = 0, dark = 0;  ///< totals of the picture
  RoundFigures last;
  uint32_t casters = 0;
  double unaimed = 1;                     ///< unaimed share of the paths
  std::vector<overlay::AimedPair> aimed;  ///< largest share first
  bool paths_shown = false, aim_shown = false;
  double sent_per_s = 0;  ///< 0: not yet known
  uint64_t bytes = 0;
};

solvers::Report make_report(const LightTracingReport& r);

}  // namespace lucerna::light_tracing
