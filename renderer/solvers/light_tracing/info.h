#pragma once
// What light tracing says of itself.
#include "solvers/info.h"

namespace lucerna::light_tracing {

const solvers::SolverInfo& info();

}  // namespace lucerna::light_tracing
