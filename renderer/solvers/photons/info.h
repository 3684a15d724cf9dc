#pragma once
// Description of photon mapping.
#include "solvers/info.h"

namespace lucerna::photons {

const solvers::SolverInfo& info();
/// SolverInfo::prospect
std::optional<solvers::Prospect> prospect(const solvers::Findings& findings, uint32_t components);

}  // namespace lucerna::photons
