#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bench/html.h"
#include "bench/page.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

/// What is to be said of one measure of one scene; only what was measured, never what was extrapolated.
std::string finding(const Json& scene, const std::string& first, const char* measure, const char* what) {
  const std::string name = scene.at("name").get<std::string>();
  std::string line;
  size_t compared = 0;
  for (const Json& setting : scene.at("settings")) {
    if (!setting.contains(measure)) continue;
    const Json& common = setting.at(measure);
    ++compared;
    if (common.value("noise", true)) continue;
    const double ratio = common.at("ratio").get<double>();
    line +=
        fmt::format("{}{} brings {} to {:.4g} % in {}, {} in {}: {:.2f} times {}",
                    line.empty() ? name + ": " : "; ", setting.at("name").get<std::string>(), what,
                    100 * common.at("error").get<double>(), seconds_text(common.at("seconds").get<double>()),
                    first, seconds_text(common.at("first_seconds").get<double>()),
                    ratio > 1 ? ratio : 1 / ratio, ratio > 1 ? "sooner" : "later");
  }
  if (compared == 0)
    return fmt::format("{}: no error of {} was reached both by {} and by another setting.", name, what,
                       first);
  if (line.empty())
    return fmt::format("{}: for {}, no setting differs from {} by more than the measurement’s noise.", name,
                       what, first);
  return line + ".";
}

}  // namespace

std::vector<std::string> findings(const Json& report) {
  std::vector<std::string> lines;
  for (const Json& scene : report.at("scenes")) {
    const Json& settings = scene.at("settings");
    if (settings.size() < 2) continue;
    const std::string first = report.at("matrix").at("settings").at(0).at("name").get<std::string>();
    lines.push_back(finding(scene, first, "time_common", "the whole picture"));
    lines.push_back(finding(scene, first, "tiles_time_common", "nine tiles in ten"));
  }
  return lines;
}

}  // namespace lucerna::bench
