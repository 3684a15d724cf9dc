#pragma once
// Common parts of the bench's pages.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/page_plots.h"

namespace lucerna::bench {

/// Explanation of the error as seen: one sentence or two.
extern const char* const k_about_seen;

/// From <!DOCTYPE to <main>.
std::string page_head(const std::string& title);
/// Note on missing renders; "" if complete.
std::string incomplete(const nlohmann::ordered_json& report);
/// findings() as a list; "" without any.
std::string findings_list(const nlohmann::ordered_json& report);
/// Description of every setting and its changes.
std::string settings_table(const nlohmann::ordered_json& report);
/// A row per scene and setting: seconds to the errors of a measure ("time", "tiles_time", "seen_time",
/// "relmse_time"), with factors over the first setting.
std::string time_table(const nlohmann::ordered_json& report, const std::string& measure);
/// Machine, device, version, date and command.
std::string machine_facts(const nlohmann::ordered_json& report);

/// Kind of the runner's error pictures: "": over the picture's mean; ".seen": as seen.
struct ErrorPictures {
  const char* suffix;
  const char* over;  ///< denominator of the difference, for the legend
  double (*error)(const nlohmann::ordered_json& cell);
};
extern const ErrorPictures k_of_mean, k_as_seen;
/// The pictures of a scene's settings with their errors below; "" without any.
std::string pictures(const nlohmann::ordered_json& scene, const std::filesystem::path& folder,
                     const ErrorPictures& of);

/// The mark of a setting in its colour, by its index in the matrix.
std::string key_of(size_t setting);
/// A ratio, accented if it is a gain beyond the noise and dim if within.
std::string ratio_cell(const nlohmann::ordered_json& entry, bool extrapolated);
/// Likewise, with its interval below, if any.
std::string ratio_cell_with_range(const nlohmann::ordered_json& entry);

/// "4.12 s" with the range of the repeats in small.
template <class F>
std::string with_range(const nlohmann::ordered_json& spread, F format, const std::string& mark = "") {
  const double low = spread.at("low").get<double>(), high = spread.at("high").get<double>();
  return mark + format(median_of(spread)) + "<br/><small>" + format(low) + " – " + format(high) + "</small>";
}

/// The page of a report for the error as seen only; arguments as for make_page().
std::string make_seen_page(const nlohmann::ordered_json& report, const std::filesystem::path& pictures);

}  // namespace lucerna::bench
