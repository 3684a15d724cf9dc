#include "solvers/irradiance_cache/stages.h"

#include <fmt/format.h>

#include <algorithm>

namespace lucerna::irradiance_cache {

std::string stage_words(const StageDone& done) {
  const char* name = k_build_stages[size_t(done.stage)];
  if (done.stage == BuildStage::evaluate)
    return fmt::format("{} level {}, pass {}", name, done.level, done.pass + 1);
  return fmt::format("{}, pass {}", name, done.pass + 1);
}

PlacementShow placement_drawn(PlacementShow show, const PlacementShown& placement) {
  if (show == PlacementShow::off || placement.candidates.empty()) return PlacementShow::off;
  const PlacementShow known = placement.cluster.empty() ? PlacementShow::candidates
                              : placement.radii.empty() ? PlacementShow::clusters
                                                        : PlacementShow::chosen;
  return show == PlacementShow::stage ? known : std::min(show, known);
}

}  // namespace lucerna::irradiance_cache
