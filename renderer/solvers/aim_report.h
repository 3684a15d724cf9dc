#pragma once
// What solvers that aim light paths tell of it.
#include "overlay/light_paths.h"
#include "solvers/report.h"

namespace lucerna::solvers {

/// How many casters there are, which share of the paths is aimed, and the greatest shares; nothing where
/// there is no caster.
void add_aim_rows(std::vector<PanelItem>& items, uint32_t casters, double unaimed,
                  std::span<const overlay::AimedPair> pairs);
/// What the colours of LightPathsPainter::draw_aim() say.
Legend aim_legend();

}  // namespace lucerna::solvers
