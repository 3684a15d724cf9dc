#include "bench/time_left.h"

#include <algorithm>

namespace lucerna::bench {

double TimeLeft::paths(const Unit& unit) const {
  const SceneEntry& scene = matrix_.scenes[unit.scene];
  double samples = 0;
  if (unit.setting == k_reference) {
    samples = scene.reference_samples;
  } else if (matrix_.settings[unit.setting].budget == BudgetKind::samples) {
    samples = matrix_.budgets(unit.scene, unit.setting)[unit.budget];
  } else {
    for (const double s : scene.budgets[size_t(BudgetKind::samples)]) samples = std::max(samples, s);
    if (samples == 0) samples = 256;
  }
  return samples * scene.width * scene.height;
}

void TimeLeft::finished(const Unit& unit, double seconds) {
  --todo_[unit];
  Known& k = known_[unit];
  k.seconds += seconds, k.paths += paths(unit), ++k.count;
}

std::optional<double> TimeLeft::expected(const Unit& unit, const Known& extra) const {
  if (const auto at = known_.find(unit); at != known_.end()) return at->second.seconds / at->second.count;
  if (unit.setting != k_reference && matrix_.settings[unit.setting].budget == BudgetKind::seconds)
    return matrix_.budgets(unit.scene, unit.setting)[unit.budget];
  Known scene, all = extra;
  for (const auto& [other, k] : known_) {
    all.seconds += k.seconds, all.paths += k.paths;
    if (other.scene == unit.scene) scene.seconds += k.seconds, scene.paths += k.paths;
  }
  const Known& pace = scene.paths > 0 ? scene : all;
  if (!(pace.paths > 0)) return std::nullopt;
  return pace.seconds / pace.paths * paths(unit);
}

std::optional<double> TimeLeft::seconds(const Unit& current, double fraction, double elapsed) const {
  // The pace of the current render is used if there is no other data.
  Known extra;
  if (fraction > 0.02) extra = {elapsed, fraction * paths(current), 1};
  double sum = 0;
  for (const auto& [unit, count] : todo_) {
    if (count == 0) continue;
    const auto one = expected(unit, extra);
    if (!one) return std::nullopt;
    sum += *one * count;
    if (unit == current) sum -= std::min(*one, elapsed);
  }
  return sum;
}

}  // namespace lucerna::bench
