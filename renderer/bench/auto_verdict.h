#pragma once
// Verdict of `lucerna bench auto`: solvers chosen for the scene against the best and the worst fixed choice.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace lucerna::bench {

/// Result of one scene at one budget. Errors as seen: medians of the repeats.
struct AutoResult {
  std::string scene, budget;
  double chosen = 0, best = 0, worst = 0;
  std::string best_setting, worst_setting;
  /// Time to equal error relative to the fixed choices, from squared errors after equal time.
  double over_best() const { return chosen * chosen / (best * best); }
  double under_worst() const { return worst * worst / (chosen * chosen); }
};

/// From a report (report.h) with a setting "auto" and others; scenes and budgets without all of them, and
/// errors lost in the reference's noise, are left out.
std::vector<AutoResult> auto_results(const nlohmann::ordered_json& report);

/// A table, and the numbers of results within 1.15 of the best and at least 2 times sooner than the worst;
/// "" without results.
std::string auto_verdict(const nlohmann::ordered_json& report);

}  // namespace lucerna::bench
