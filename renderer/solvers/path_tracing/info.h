#pragma once
// Path tracing: the wavefront itself (transport/) brings its light; nothing is prepared and nothing looked
// up.
#include "solvers/info.h"

namespace lucerna::path_tracing {

const solvers::SolverInfo& info();

}  // namespace lucerna::path_tracing
