#pragma once
// What the pages of the bench share.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/page_plots.h"

namespace lucerna::bench {

/// Explanation of the error as seen: one sentence or two.
extern const char* const k_about_seen;

/// From <!DOCTYPE to <main>.
std::string page_head(const std::string& title);
/// That renders are missing; "" where none is.
std::string incomplete(const nlohmann::ordered_json& report);
/// findings() as a list; "" where there are none.
std::string findings_list(const nlohmann::ordered_json& report);
/// What every setting is and changes.
std::string settings_table(const nlohmann::ordered_json& report);
/// A row each scene and setting: seconds to the errors of a measure ("time", "tiles_time", "seen_time",
/// "relmse_time"), with factors over the first setting.
std::string time_table(const nlohmann::ordered_json& report, const std::string& measure);
/// Machine, device, version, date and command.
std::string machine_facts(const nlohmann::ordered_json& report);

/// Which of the runner's error pictures are shown: "" is over the picture's mean, ".seen" as it is seen.
struct ErrorPictures {
  const char* suffix;
  const char* over;  ///< what the difference is over, for the legend
  double (*error)(const nlohmann::ordered_json& cell);
};
extern const ErrorPictures k_of_mean, k_as_seen;
/// The pictures of a scene's settings with their errors below; "" where there are none.
std::string pictures(const nlohmann::ordered_json& scene, const std::filesystem::path& folder,
                     const ErrorPictures& of);

/// The mark of a setting in its colour, by its place in the matrix.
std::string key_of(size_t setting);
/// A ratio, accented when it is a gain beyond the noise and dim when it is none.
std::string ratio_cell(const nlohmann::ordered_json& entry, bool extrapolated);
/// The same with its interval below, where it has one.
std::string ratio_cell_with_range(const nlohmann::ordered_json& entry);

/// "4.12 s" with the range of the repeats in small.
template <class F>
std::string with_range(const nlohmann::ordered_json& spread, F format, const std::string& mark = "") {
  const double low = spread.at("low").get<double>(), high = spread.at("high").get<double>();
  return mark + format(median_of(spread)) + "<br/><small>" + format(low) + " – " + format(high) + "</small>";
}

/// The page of a report whose matrix is of the error as seen alone; arguments as of make_page().
std::string make_seen_page(const nlohmann::ordered_json& report, const std::filesystem::path& pictures);

}  // namespace lucerna::bench
