#pragma once
// Description of the irradiance cache: options, change table, views, commands, files.
#include "solvers/info.h"

namespace lucerna::irradiance_cache {

const solvers::SolverInfo& info();

}  // namespace lucerna::irradiance_cache
