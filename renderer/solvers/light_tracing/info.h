#pragma once
// Description of light tracing.
#include "solvers/info.h"

namespace lucerna::light_tracing {

const solvers::SolverInfo& info();

}  // namespace lucerna::light_tracing
