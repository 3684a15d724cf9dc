#pragma once
// Description of the irradiance cache: options, change table, views, commands, files.
#include "solvers/info.h"

namespace lucerna::irradiance_cache {

const solvers::SolverInfo& info();
/// SolverInfo::prospect
std::optional<solvers::Prospect> prospect(const solvers::Findings& findings, uint32_t components);

}  // namespace lucerna::irradiance_cache
