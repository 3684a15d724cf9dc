#pragma once
// Option table and benches of the irradiance cache (info.h).
#include "solvers/info.h"

namespace lucerna::irradiance_cache {

std::vector<OptionInfo> option_rows();
std::vector<solvers::BenchInfo> bench_rows();
std::vector<std::string> bench_settings();

}  // namespace lucerna::irradiance_cache
