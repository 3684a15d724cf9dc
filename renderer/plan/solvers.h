#pragma once
// The ways to compute a component of the light: the registry from which the settings take their choices.
#include <array>
#include <string>
#include <vector>

#include "paths/automaton.h"

namespace lucerna::plan {

struct SolverInfo {
  std::string name;                                   ///< as in settings: components.secondary = NAME
  std::string help;                                   ///< one sentence
  std::array<bool, paths::k_component_count> serves;  ///< components that it can compute
  /// Whether its mean is the true image at every number of samples: then noise is all its error.
  bool unbiased;
  /// Whether its light is looked up at a diffuse vertex (paths::lookup_routes), not traced on from there.
  bool looked_up;
};

/// All of them, the default of every component first. A new solver is a line here.
const std::vector<SolverInfo>& solvers();

}  // namespace lucerna::plan
