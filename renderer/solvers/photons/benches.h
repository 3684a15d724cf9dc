#pragma once
// Benches of photons and of caustics (info.h).
#include <vector>

#include "solvers/info.h"

namespace lucerna::photons {

std::vector<solvers::BenchInfo> bench_rows();

}  // namespace lucerna::photons
