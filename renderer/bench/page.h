#pragma once
// The report as one page that needs nothing else: inline SVG, pictures as data URIs, no scripts.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace lucerna::bench {

/// HTML (well-formed XML apart from the first line) of a report by make_report(). `pictures`: folder with the
/// runner's pictures (missing ones are left out; error pictures are also written there as PNG). Throws Error
/// if the report is incomplete.
std::string make_page(const nlohmann::ordered_json& report, const std::filesystem::path& pictures);

/// One sentence per scene and measure; ratios within the noise are never reported as a gain. Of the settings
/// of one curve the best is reported; of two curves, the number of records for one error.
std::vector<std::string> findings(const nlohmann::ordered_json& report);

}  // namespace lucerna::bench
