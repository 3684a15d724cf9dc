#include "solvers/irradiance_cache/build_forecast.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lucerna::irradiance_cache {
namespace {

// Measured from scratch with the default settings, on classroom, hall, teapot and two real interiors:
// remaining share of the work when a pass began, ...
constexpr std::array<double, 7> k_remaining_after = {1, 0.7, 0.38, 0.12, 0.06, 0.04, 0.03};
// ... and when the last one began; ...
constexpr double k_remaining_last = 0.12;
// ... share of placement in the first pass, and rays per record in it, without those of placement.
constexpr double k_placing = 0.5, k_rays_a_record = 300;

/// Remaining share of the work by the share of uncovered paths, largest first.
struct Remaining {
  double share, remaining;
};
constexpr std::array<Remaining, 6> k_remaining_uncovered = {
    {{1, 1}, {0.6, 0.75}, {0.1, 0.47}, {0.02, 0.25}, {0.008, 0.14}, {0.0015, 0.05}}};

double remaining_uncovered(double share) {
  if (share <= 0) return 0;
  for (size_t i = 1; i < k_remaining_uncovered.size(); ++i) {
    const Remaining &a = k_remaining_uncovered[i - 1], &b = k_remaining_uncovered[i];
    if (share < b.share) continue;
    const double f = std::log(share / b.share) / std::log(a.share / b.share);
    return b.remaining + std::min(f, 1.0) * (a.remaining - b.remaining);
  }
  return k_remaining_uncovered.back().remaining * share / k_remaining_uncovered.back().share;
}

/// `before_ms`: of building before it was extended or relit.
BuildForecast forecast(double all_ms, double done_ms, double before_ms = 0) {
  // Work that takes longer than predicted is assumed to be nearly done.
  const double remaining = std::max(all_ms - done_ms, 0.04 * done_ms);
  return {.done = (before_ms + done_ms) / (before_ms + done_ms + remaining), .left_ms = remaining};
}

}  // namespace

std::optional<BuildForecast> forecast_of(const CacheStatus& s, double stop_share) {
  if (s.stop != StopReason::building || s.passes.empty()) return {};
  double all = 0;
  for (const CachePass& p : s.passes) all += p.total_ms();
  if (s.relighting.records > 0) {
    if (s.rays == 0 || s.relighting.rays == 0) return {};
    // By rays alone: setup time before the first ray is already spent.
    double evaluating = 0;
    for (const CachePass& p : s.passes) evaluating += p.ms[size_t(BuildStep::evaluate)];
    if (evaluating <= 0) return {};  // rays are counted before their time is measured
    return forecast(evaluating * std::max(1.0, double(s.relighting.rays) / double(s.rays)), evaluating);
  }
  if (s.passes.back().relit) return {};  // all are relit; missing records are not known yet
  // Extending building restarts the pass count; the work before it is a measure of the rest. Relit passes
  // represent the passes that placed their records.
  size_t first = s.passes.size() - 1;
  while (first > 0 && (s.passes[first].number > 0 || s.passes[first].relit)) --first;
  double before = 0;
  for (size_t i = 0; i < first; ++i) before += s.passes[i].total_ms();
  const CachePass& now = s.passes.back();
  const double done = all - before, of_pass = now.total_ms();
  // Use this pass if it has counted uncovered paths already; else the one before.
  const bool looked = now.paths > 0;
  if (before > 0) {
    if (!looked) return {};
    return forecast(done - of_pass + before * remaining_uncovered(now.uncovered_share()), done, before);
  }
  if (now.number == 0) {
    if (now.rays == 0 || now.records == 0) return {};
    const double evaluating = double(now.rays) - double(now.tried) * Evaluator::k_distance_rays;
    const double part =
        k_placing + (1 - k_placing) * std::clamp(evaluating / (now.records * k_rays_a_record), 0.0, 1.0);
    return forecast(done / (part * (1 - k_remaining_after[1])), done);
  }
  const double begun = done - of_pass;  // at the start of this pass
  const bool last = looked && double(now.uncovered) <= stop_share * double(now.paths);
  double remaining = k_remaining_after[std::min<size_t>(now.number, k_remaining_after.size() - 1)];
  // Small scenes have fewer passes, which the share of uncovered paths shows.
  if (looked) remaining = std::sqrt(remaining * remaining_uncovered(now.uncovered_share()));
  if (last) remaining = k_remaining_last;
  return forecast(begun / (1 - remaining), done);
}

}  // namespace lucerna::irradiance_cache
