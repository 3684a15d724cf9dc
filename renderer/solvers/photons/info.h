#pragma once
// What the photons say of themselves.
#include "solvers/info.h"

namespace lucerna::photons {

const solvers::SolverInfo& info();

}  // namespace lucerna::photons
