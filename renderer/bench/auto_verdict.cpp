#include "bench/auto_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* k_setting = "auto";
constexpr double k_over_best = 1.15, k_under_worst = 2;

}  // namespace

std::vector<AutoResult> auto_results(const Json& report) {
  std::vector<AutoResult> results;
  for (const Json& scene : report.at("scenes")) {
    // Errors by budget: of every setting.
    std::vector<std::pair<std::string, std::vector<std::pair<std::string, double>>>> budgets;
    for (const Json& setting : scene.at("settings"))
      for (const Json& cell : setting.at("cells")) {
        const double squared = cell.at("seen").at("median").get<double>();
        if (!(squared > 0)) continue;
        const auto budget = cell.at("budget").get<std::string>();
        auto at =
            std::find_if(budgets.begin(), budgets.end(), [&](const auto& b) { return b.first == budget; });
        if (at == budgets.end()) at = budgets.insert(at, {budget, {}});
        at->second.emplace_back(setting.at("name").get<std::string>(), std::sqrt(squared));
      }
    for (const auto& [budget, errors] : budgets) {
      AutoResult r{.scene = scene.at("name").get<std::string>(), .budget = budget};
      for (const auto& [setting, error] : errors) {
        if (setting == k_setting) {
          r.chosen = error;
          continue;
        }
        if (r.best == 0 || error < r.best) r.best = error, r.best_setting = setting;
        if (error > r.worst) r.worst = error, r.worst_setting = setting;
      }
      if (r.chosen > 0 && r.best > 0) results.push_back(std::move(r));
    }
  }
  return results;
}

std::string auto_verdict(const Json& report) {
  const std::vector<AutoResult> results = auto_results(report);
  if (results.empty()) return "";
  std::string text = fmt::format("{:<14}{:<10}{:>8}  {:<24}{:>6}  {:<24}{:>6}\n", "scene", "after", "auto",
                                 "best fixed choice", "time", "worst", "time");
  size_t near_best = 0, far_from_worst = 0;
  for (const AutoResult& r : results) {
    near_best += r.over_best() <= k_over_best, far_from_worst += r.under_worst() >= k_under_worst;
    const auto with_error = [](const std::string& name, double error) {
      return fmt::format("{} {:.1f} %", name, 100 * error);
    };
    text += fmt::format("{:<14}{:<10}{:>6.1f} %  {:<24}{:>6.2f}  {:<24}{:>6.2f}\n", r.scene, r.budget,
                        100 * r.chosen, with_error(r.best_setting, r.best), r.over_best(),
                        with_error(r.worst_setting, r.worst), 1 / r.under_worst());
  }
  return text + fmt::format(
                    "auto: at most {} times the time of the best fixed choice in {} of {}; at least {} "
                    "times sooner than the worst in {}\n",
                    k_over_best, near_best, results.size(), k_under_worst, far_from_worst);
}

}  // namespace lucerna::bench
