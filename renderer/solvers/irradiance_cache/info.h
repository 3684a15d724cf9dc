#pragma once
// What the irradiance cache says of itself: its options, what changes spoil of it, its views, commands,
// files.
#include "solvers/info.h"

namespace lucerna::irradiance_cache {

const solvers::SolverInfo& info();

}  // namespace lucerna::irradiance_cache
