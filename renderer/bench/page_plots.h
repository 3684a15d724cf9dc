#pragma once
// Plots of one scene on the page, and what tables share with them.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/plot.h"

namespace lucerna::bench {

/// "" where there is no such text.
std::string text_of(const nlohmann::ordered_json& json, const char* key);
/// Of {median, low, high}.
double median_of(const nlohmann::ordered_json& spread);
/// The curve that the setting is a point of; "" where it is of none.
std::string curve_of(const nlohmann::ordered_json& report, const std::string& setting);
/// The place of a setting in the matrix, where the settings of one curve have one place: it decides the
/// colour.
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
