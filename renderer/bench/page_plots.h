#pragma once
// Plots of one scene on the page, and functions common to plots and tables.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/plot.h"

namespace lucerna::bench {

/// "" if there is no such text.
std::string text_of(const nlohmann::ordered_json& json, const char* key);
/// The median of {median, low, high}.
double median_of(const nlohmann::ordered_json& spread);
/// The curve of which the setting is a point; "": none.
std::string curve_of(const nlohmann::ordered_json& report, const std::string& setting);
/// Index of a setting in the matrix for its colour; the settings of one curve have one index.
size_t index_of(const nlohmann::ordered_json& report, const std::string& setting);

/// True error against records: the curves of a scene that have two points or more, each the largest budget of
/// a setting, from few records to many. An error that is lost in the reference's noise is no point.
std::vector<PlotLine> record_curves(const nlohmann::ordered_json& report,
                                    const nlohmann::ordered_json& scene);

/// The scene's plots: true error and that of nine tiles in ten against seconds, and true error against the
/// records that light is looked up in where a curve has two settings or more with records.
std::string plots(const nlohmann::ordered_json& report, const nlohmann::ordered_json& scene);

/// Error as seen against seconds; "" where there is nothing to draw.
std::string seen_plot(const nlohmann::ordered_json& report, const nlohmann::ordered_json& scene);

}  // namespace lucerna::bench
