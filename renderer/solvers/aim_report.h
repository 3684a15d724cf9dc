#pragma once
// What solvers that aim light paths tell of it.
#include "overlay/light_paths.h"
#include "solvers/report.h"

namespace lucerna::solvers {

/// Boxes that light paths are aimed at, in this order.
struct AimedAt {
  uint32_t casters = 0;
  uint32_t entrances = 0;  ///< where light from afar gets in
};

/// How many of both there are, which share of the paths is aimed, and the greatest shares; nothing where
/// nothing is aimed.
void add_aim_rows(std::vector<PanelItem>& items, const AimedAt& at, double unaimed,
                  std::span<const overlay::AimedPair> pairs);
/// What the colours of LightPathsPainter::draw_aim() say.
Legend aim_legend();
/// Of overlay::LightPathsPainter::draw.
Legend light_paths_legend();

}  // namespace lucerna::solvers
