#pragma once
// Two benches held against each other.
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace lucerna::bench {

/// A table for people: for every scene and setting that both reports have, how much sooner NEW reaches each
/// error, its index, the same of the error as seen, and its rays a second, as ratios (above 1: NEW is
/// better). Ratios within the noise of the two measurements together (exp of the root of the sum of the
/// squared logarithms of both) are marked "=", extrapolated times "~". Scenes and settings that only one of
/// them has are named, and so is what makes the two hard to compare: another machine, device, version or
/// size.
std::string compare_reports(const nlohmann::ordered_json& before, const nlohmann::ordered_json& after);

}  // namespace lucerna::bench
