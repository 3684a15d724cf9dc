#pragma once
// Description of photon mapping.
#include "solvers/info.h"

namespace lucerna::photons {

const solvers::SolverInfo& info();

}  // namespace lucerna::photons
