#pragma once
// Path tracing: the wavefront itself (transport/). No preparation and no lookups.
#include "solvers/info.h"

namespace lucerna::path_tracing {

const solvers::SolverInfo& info();

}  // namespace lucerna::path_tracing
