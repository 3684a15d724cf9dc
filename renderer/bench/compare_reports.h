#pragma once
// Comparison of two bench reports.
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace lucerna::bench {

/// A text table: for every scene and setting of both reports, how much sooner NEW reaches each error, its
/// index, the same for the error as seen, and its rays per second, as ratios (above 1: NEW is better). Ratios
/// within the combined noise of both measurements (exp of the root of the sum of the squared logarithms) are
/// marked "=", extrapolated times "~". Lists scenes and settings of only one report, and differences of
/// machine, device, version or size.
std::string compare_reports(const nlohmann::ordered_json& before, const nlohmann::ordered_json& after);

}  // namespace lucerna::bench
