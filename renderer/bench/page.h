#pragma once
// The report as one page that needs nothing else: inline SVG, pictures as data URIs, no scripts.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace lucerna::bench {

/// HTML (well-formed as XML but for its first line) of a report as make_report() makes it; `pictures` is the
/// folder that the runner left pictures in (what is missing there is left out; error pictures are also
/// written there as PNG). Throws Error when the report lacks what every report has.
std::string make_page(const nlohmann::ordered_json& report, const std::filesystem::path& pictures);

/// One sentence a scene and measure on what the figures say, ratios within the noise never told as a gain. Of
/// the settings of one curve the best is told; and of two curves how many records they take to one error.
std::vector<std::string> findings(const nlohmann::ordered_json& report);

}  // namespace lucerna::bench
