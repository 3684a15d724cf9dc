#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "bench/html.h"
#include "bench/page.h"
#include "bench/page_plots.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

/// How a ratio is told: how much better, or worse, than the first setting.
std::string gain_text(double ratio, const char* better, const char* worse) {
  return fmt::format("{:.2f} times {}", ratio > 1 ? ratio : 1 / ratio, ratio > 1 ? better : worse);
}

/// A scene's line of what its settings were found to do; what is to be said when none does anything.
std::string scene_line(const Json& scene, const std::vector<std::string>& found,
                       const std::string& otherwise) {
  const std::string name = text_of(scene, "name");
  return found.empty() ? fmt::format("{}: {}.", name, otherwise)
                       : fmt::format("{}: {}.", name, fmt::join(found, "; "));
}

/// What is to be said of one measure of one scene; only what was measured, never what was extrapolated.
std::string finding(const Json& scene, const std::string& first, const char* measure, const char* what) {
  std::vector<std::string> found;
  size_t compared = 0;
  for (const Json& setting : scene.at("settings")) {
    if (!setting.contains(measure)) continue;
    const Json& common = setting.at(measure);
    ++compared;
    if (common.value("noise", false)) continue;
    found.push_back(fmt::format("{} brings {} to {:.4g} % in {}, {} in {}: {}", text_of(setting, "name"),
                                what, 100 * common.at("error").get<double>(),
                                seconds_text(common.at("seconds").get<double>()), first,
                                seconds_text(common.at("first_seconds").get<double>()),
                                gain_text(common.at("ratio").get<double>(), "sooner", "later")));
  }
  if (compared == 0)
    return scene_line(
        scene, {}, fmt::format("no error of {} was reached both by {} and by another setting", what, first));
  return scene_line(
      scene, found,
      fmt::format("for {}, no setting differs from {} by more than the measurement’s noise", what, first));
}

/// What the settings' relative squared errors come to, against the first setting's after the same time;
/// marked where the latter is foretold from an earlier one. "" for reports from before it was measured.
std::string relative_finding(const Json& scene, const std::string& first) {
  std::vector<std::string> found;
  size_t compared = 0;
  for (const Json& setting : scene.at("settings")) {
    if (!setting.contains("relmse_end") || !setting.at("relmse_end").contains("ratio")) continue;
    const Json& end = setting.at("relmse_end");
    ++compared;
    if (end.value("noise", false)) continue;
    found.push_back(fmt::format(
        "{} ends with a relative squared error of {:.3g} after {}, {} {} {:.3g}: {}",
        text_of(setting, "name"), median_of(end.at("relmse")), seconds_text(end.at("seconds").get<double>()),
        first, text_of(end, "kind") == "extrapolated" ? "would then have" : "then has",
        median_of(end.at("first")), gain_text(end.at("ratio").get<double>(), "less", "more")));
  }
  if (compared == 0) return "";
  return scene_line(
      scene, found,
      fmt::format("for the relative squared error, no setting differs from {} by more than the measurement’s "
                  "noise",
                  first));
}

}  // namespace

std::vector<std::string> findings(const Json& report) {
  std::vector<std::string> lines;
  for (const Json& scene : report.at("scenes")) {
    const Json& settings = scene.at("settings");
    if (settings.size() < 2) continue;
    const std::string first = text_of(report.at("matrix").at("settings").at(0), "name");
    lines.push_back(finding(scene, first, "time_common", "the whole picture"));
    lines.push_back(finding(scene, first, "tiles_time_common", "nine tiles in ten"));
    if (std::string line = relative_finding(scene, first); !line.empty()) lines.push_back(std::move(line));
  }
  if (!lines.empty() && report.at("matrix").at("repeats").get<int>() < 2)
    lines.push_back("Of one repeat each: what of these factors is noise is not known.");
  return lines;
}

}  // namespace lucerna::bench
