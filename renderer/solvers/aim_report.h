#pragma once
// What solvers that aim light paths tell of it.
#include "overlay/light_paths.h"
#include "solvers/report.h"

namespace lucerna::solvers {

/// The greatest shares, for a panel; no rows where nothing is aimed.
Table aim_table(std::span<const overlay::AimedPair> pairs);
/// What the colours of LightPathsPainter::draw_aim() say.
Legend aim_legend();

}  // namespace lucerna::solvers
