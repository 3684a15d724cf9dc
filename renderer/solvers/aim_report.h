#pragma once
// Report rows and legend of solvers that aim light paths.
#include "overlay/light_paths.h"
#include "solvers/report.h"

namespace lucerna::solvers {

/// Number of boxes that light paths are aimed at, in this order.
struct AimedAt {
  uint32_t casters = 0;
  uint32_t entrances = 0;  ///< where distant light enters
};

/// Adds rows for both counts, the aimed share of the paths, and the largest shares; nothing if nothing is
/// aimed.
void add_aim_rows(std::vector<PanelItem>& items, const AimedAt& at, double unaimed,
                  std::span<const overlay::AimedPair> pairs);
/// Legend of the colours of LightPathsPainter::draw_aim().
Legend aim_legend();
/// Legend of the picture of LightPathsPainter::draw().
Legend light_paths_legend();

}  // namespace lucerna::solvers
