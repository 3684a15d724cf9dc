#include "accuracy_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart.h"
#include "solvers/registry.h"

namespace lucerna::ui {

using session::Accuracy;

namespace {

/// Number of tiles stopped by the error of lookups rather than by the maximum of samples.
uint32_t limited_tiles(const Accuracy& a) {
  return static_cast<uint32_t>(
      std::count_if(a.tiles.begin(), a.tiles.end(), [&](const session::TileStatus& t) {
        return t.state == shared::k_tile_capped && (t.records > 0 || t.interpolation > 0) &&
               t.samples < a.max_samples;
      }));
}

std::string short_percent(double fraction, int figures = 3) {
  return fmt::format("{:.{}g} %", 100 * fraction, figures);
}

/// A forecast as a sentence and shorter ones. A wide range is given without its middle, a very wide one by
/// its lower end only.
std::vector<std::string> forecast_texts(const std::string& all, const std::string& goal,
                                        const stats::Band& forecast) {
  constexpr double k_vague = 2.5, k_open = 12;  // high over low
  const std::string low = about_text(forecast.low), high = about_text(forecast.high);
  const std::string middle = about_text(forecast.middle);
  const double span = forecast.high / std::max(forecast.low, 1e-9);
  if (low == high)
    return {fmt::format("{} will take about {}", all, middle), fmt::format("{} in about {}", goal, middle),
            goal};
  if (span > k_open)
    return {fmt::format("{} will take more than {}", all, low), fmt::format("{} in more than {}", goal, low),
            goal};
  std::vector<std::string> texts;
  if (span <= k_vague)
    texts.push_back(fmt::format("{} will take about {} ({} to {})", all, middle, low, high));
  texts.push_back(fmt::format("{} will take {} to {}", all, low, high));
  texts.push_back(fmt::format("{} in {} to {}", goal, low, high));
  texts.push_back(goal);
  return texts;
}

/// " (a.rays, a.noise)": the solvers' settings that reduce the error which samples do not.
std::string advice(std::vector<std::string> solvers::SolverInfo::*settings) {
  std::string keys;
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const std::string& key : solver->*settings) keys += (keys.empty() ? " (" : ", ") + key;
  return keys.empty() ? keys : keys + ")";
}

}  // namespace

std::optional<Present> present(const Accuracy& a) {
  if (a.ledger.entries().empty()) return std::nullopt;
  const stats::Entry& last = a.ledger.entries().back();
  const double error = !a.adaptive ? last.sum() : a.hardest.empty() ? 0 : a.hardest.back();
  if (!(error > 0) || !(last.wall_s > 0)) return std::nullopt;
  return Present{last.wall_s, error};
}

std::vector<ErrorFigure> error_figures(const stats::Entry& line) {
  std::vector<ErrorFigure> figures{
      {"as seen", "as seen", line.sum(),
       "Root mean square error of the pixels, each relative to the light around it. Pixels that the exposure "
       "shows as white or black have no visible error."},
      {"of the median tile", "median tile", line.tile_median,
       "Half of the tiles have a larger error, relative to the brightness of their own pixels."},
      {"of the worst tenth of the tiles", "worst tenth", line.tile_worst_tenth,
       "A tenth of the tiles have at least this error, relative to the brightness of their own pixels: the "
       "dark and difficult parts of the picture."},
      {"of the mean", "mean", line.of_mean.sum(),
       "Root mean square error of the pixels over the picture's mean luminance, independent of exposure. A "
       "few bright pixels, such as the edges of a window, dominate it."}};
  if (!looks_up(line)) return figures;
  figures.push_back({"as seen, by the paths", "paths", line.error[0],
                     "Noise of the samples, a part of the error as seen. More samples reduce it."});
  if (line.records > 0)
    figures.push_back({"as seen, by the records", "records", line.records,
                       "Noise of the records that the samples read, a part of the error as seen. More "
                       "samples do not reduce it; more rays per record do" +
                           advice(&solvers::SolverInfo::against_noise) + "."});
  figures.push_back({"as seen, by the bias of lookups", "bias", line.interpolation,
                     "Mean error of light that is interpolated between records or blurred over the discs of "
                     "photons, a part of the error as seen. More samples do not reduce it, or only slowly as "
                     "the discs shrink; more records and smaller discs do" +
                         advice(&solvers::SolverInfo::against_bias) + "."});
  return figures;
}

bool looks_up(const stats::Entry& line) { return line.records > 0 || line.interpolation > 0; }

PlotRange plot_range(const Accuracy& a, const std::deque<Run>& earlier, double target,
                     const std::optional<stats::Band>& forecast, double seconds) {
  double t_lo = 1e9, t_hi = std::max(seconds, 1e-3), e_lo = 0.5 * target, e_hi = 2 * target;
  const auto hold = [&](const Accuracy& run) {
    double last = 0;
    for (const stats::Entry& e : run.ledger.entries()) {
      if (!(e.error[0] > 0) || !(e.wall_s > 0)) continue;
      t_lo = std::min(t_lo, e.wall_s), t_hi = std::max(t_hi, e.wall_s);
      e_hi = std::max({e_hi, e.sum(), e.tile_worst_tenth});
      last = e.error[0];
    }
    if (last > 0) e_lo = std::min(e_lo, 0.5 * last);
    // The relevant components, down to a tenth of the sum.
    if (last > 0)
      for (const double x : run.ledger.entries().back().error)
        if (x > 0.1 * last) e_lo = std::min(e_lo, 0.7 * x);
  };
  hold(a);
  for (const double x : a.hardest) e_hi = std::max(e_hi, x);
  for (const Run& run : earlier) hold(*run.accuracy);
  const double now = t_hi;
  if (forecast) t_hi = std::max(t_hi, std::min(1.15 * forecast->high, 300 * now));
  if (t_lo > t_hi) t_lo = 0.1 * t_hi;
  PlotRange range;
  range.t_lo = nice_below(std::min(t_lo, 0.2 * t_hi)), range.t_hi = nice_above(1.05 * t_hi);
  range.e_lo = nice_below(std::max(e_lo, 1e-6)), range.e_hi = nice_above(std::min(e_hi, 20.0));
  if (range.e_hi < 4 * range.e_lo) range.e_hi = nice_above(4 * range.e_lo);
  return range;
}

std::vector<std::string> target_texts(const Accuracy& a, double target,
                                      const std::optional<stats::Band>& forecast, double seconds) {
  const std::string goal = short_percent(target);
  const std::string all = a.adaptive ? "Every tile under " + goal : goal;
  if (a.ledger.entries().empty()) return {all};
  if (a.adaptive && a.finished && target == a.target) {
    const uint32_t over = a.count(shared::k_tile_capped);
    if (over == 0) return {fmt::format("{} after {}", all, about_text(seconds)), all};
    if (limited_tiles(a) > over / 2)
      return {fmt::format("{} of {} tiles stay over {}: lookups are the limit, more samples hardly help",
                          over, a.tiles.size(), goal),
              fmt::format("{} tiles stay over {}: lookups are the limit", over, goal),
              fmt::format("{} tiles stay over {}", over, goal), goal};
    return {fmt::format("{} of {} tiles stay over {}, with all of {:.0f} samples", over, a.tiles.size(), goal,
                        a.max_samples),
            fmt::format("{} tiles stay over {}", over, goal), goal};
  }
  if (!a.adaptive && stats::paths_target(a.ledger, target) <= 0)
    return {fmt::format("{} will not be reached: lookups are the limit ({}), more samples hardly help", goal,
                        short_percent(a.ledger.entries().back().floor())),
            fmt::format("{}: lookups are the limit", goal), goal};
  if (a.finished && !a.adaptive && (!forecast || forecast->high > seconds * (1 + 1e-9)))
    return {fmt::format("{} was not reached: Samples ended at {:.0f}, at {}", goal, a.max_samples,
                        percent_text(a.ledger.entries().back().sum())),
            fmt::format("{} was not reached with {:.0f} samples", goal, a.max_samples),
            fmt::format("{} was not reached", goal), goal};
  if (!forecast) return {all + ": no forecast yet", all};
  if (forecast->high <= seconds * (1 + 1e-9))
    return {fmt::format("{} was reached after {}", all, about_text(forecast->middle)), all};
  if (const auto end = session::seconds_to_end(a); end && forecast->high > *end) {
    const std::string samples = fmt::format("{:.0f}", a.max_samples), after = about_text(*end);
    const auto error = stats::error_at(a.ledger, a.max_samples);
    if (forecast->low <= *end)
      return {fmt::format("{} may not be reached: Samples ends at {}, after {}", goal, samples, after),
              fmt::format("{} may not be reached with {} samples", goal, samples),
              fmt::format("{} may not be reached", goal), goal};
    return {fmt::format("{} will not be reached: Samples ends at {}, after {}{}", goal, samples, after,
                        error ? fmt::format(" at about {}", short_percent(error->middle, 2)) : ""),
            fmt::format("{} will not be reached with {} samples", goal, samples),
            fmt::format("{} will not be reached", goal), goal};
  }
  if (const uint32_t over = a.adaptive ? session::tiles_out_of_reach(a, target) : 0; over > 0) {
    return {
        fmt::format(
            "{} of {} tiles are likely to stay over {}, with all of {:.0f} samples; finished in {} to {}",
            over, a.tiles.size(), goal, a.max_samples, about_text(forecast->low), about_text(forecast->high)),
        fmt::format("{} of {} tiles are likely to stay over {}", over, a.tiles.size(), goal),
        fmt::format("{} tiles likely over {}", over, goal), goal};
  }
  return forecast_texts(all, goal, *forecast);
}

}  // namespace lucerna::ui
