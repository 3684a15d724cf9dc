#pragma once
// The figures of the bench from its results: report.json contains all; the table, the page and comparisons
// are made from it.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/matrix.h"
#include "bench/runner.h"

namespace lucerna::bench {

/// Errors for which times are reported.
inline constexpr double k_targets[] = {0.05, 0.02, 0.01};
/// Relative mean squared errors for which times are reported; at the end 2 % or less of a pixel's brightness.
inline constexpr double k_relmse_targets[] = {0.01, 0.002, 0.0004};

/// `about`: copied to its head (version, date, command, machine, device ...). The rest:
///   matrix, complete, cells {done, total}, references [{scene, file, samples, seconds, noise ..}],
///   scenes [{name, size, noise {time, index, rate}, fixed_s, settings [summary]}],
///   index [{setting, value, scenes}], seen_ratios and seen_besides [{setting, budget, scenes, ratio ..}]:
///   the geometric means over the scenes of seen_ratio and seen_beside, results [as in cells/].
/// A summary of a setting on a scene: cells [{budget, wall_s, rays, records .. as {median, low, high}}],
///   time_to [{error, kind, seconds {median, low, high}, ratio, noise, low, high}] of the whole picture's
///   true error, time_common {error, seconds, first_seconds, ratio, noise} at the smallest error that it and
///   the first setting have both reached, tiles_time_to and tiles_time_common, the same for the estimated
///   error that nine tiles in ten are under, relmse_time_to and relmse_time_common, the same for the relative
///   mean squared error (Result::relmse), relmse_power (exponent of its fall over time: -1 where
///   extrapolation is reliable), relmse_end {seconds, relmse, first, kind}: its final value, and the
///   first setting's after as many seconds, seen_time_to and seen_time_common, the same for the error as seen
///   (the root of Result::seen), in cells seen_ratio {ratio, noise}: efficiency as seen (variance times time)
///   relative to the first setting at this budget, seen_beside {ratio, noise} relative to the
///   setting it is compared with, seen_time_to_beside, seen_curve, seen_index {pi: 1 / (seen * seconds)},
///   error_at [{seconds, error}], curve [[seconds, median, low, high]] and tiles_curve, index {pi, relative,
///   ratio, noise}, rays_per_s, forecast {seconds, rays: ratio to the final value}.
/// Curves of a setting with a separate program are the ends of its budgets, repeat by repeat. Ratios are the
/// first setting's time over this one's, above 1: sooner; `noise`: the ratio is not distinguishable from 1
/// (analysis.h); low and high: 90 % interval. Unknown values are left out.
nlohmann::ordered_json make_report(const Matrix& matrix, const RunSummary& summary,
                                   const nlohmann::ordered_json& about);

/// One line per cell and repeat, with a heading.
std::string make_csv(const nlohmann::ordered_json& report);

/// Writes report.json, report.csv and report.html into the folder.
void write_report(const std::filesystem::path& folder, const nlohmann::ordered_json& report);

/// Reads report.json, or that of a folder. Throws Error located at the file if it is missing, not JSON or not
/// a report.
nlohmann::ordered_json read_report(const std::filesystem::path& file_or_folder);

}  // namespace lucerna::bench
