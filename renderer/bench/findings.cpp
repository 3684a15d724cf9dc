#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "bench/html.h"
#include "bench/page.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

/// How a ratio is told: how much better, or worse, than the first setting.
std::string gain_text(double ratio, const char* better, const char* worse) {
  return fmt::format("{:.2f} times {}", ratio > 1 ? ratio : 1 / ratio, ratio > 1 ? better : worse);
}

/// A scene's line of what its settings were found to do; what is to be said when none does anything.
std::string line_of(const Json& scene, const std::vector<std::string>& found, const std::string& otherwise) {
  const std::string name = scene.at("name").get<std::string>();
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
    found.push_back(fmt::format(
        "{} brings {} to {:.4g} % in {}, {} in {}: {}", setting.at("name").get<std::string>(), what,
        100 * common.at("error").get<double>(), seconds_text(common.at("seconds").get<double>()), first,
        seconds_text(common.at("first_seconds").get<double>()),
        gain_text(common.at("ratio").get<double>(), "sooner", "later")));
  }
  if (compared == 0)
    return line_of(scene, {},
                   fmt::format("no error of {} was reached both by {} and by another setting", what, first));
  return line_of(
      scene, found,
      fmt::format("for {}, no setting differs from {} by more than the measurement’s noise", what, first));
}

/// What the settings' relative squared errors come to, against the first setting's after the same time;
/// marked where the latter is foretold from an earlier one. "" for reports from before it was measured.
std::string relative_finding(const Json& scene, const std::string& first) {
  std::vector<std::string> found;
  size_t compared = 0;
  // The time to an error scatters as the error after a time does, which falls as one over it.
  const double noise = scene.contains("noise") ? scene.at("noise").value("relmse_time", 1.0) : 1.0;
  for (const Json& setting : scene.at("settings")) {
    if (!setting.contains("relmse_end") || !setting.at("relmse_end").contains("first")) continue;
    const Json& end = setting.at("relmse_end");
    const double own = end.at("relmse").at("median").get<double>(),
                 theirs = end.at("first").at("median").get<double>();
    if (!(own > 0) || !(theirs > 0)) continue;
    ++compared;
    const double ratio = theirs / own;
    if (ratio <= noise && ratio >= 1 / noise) continue;
    found.push_back(fmt::format(
        "{} ends with a relative squared error of {:.3g} after {}, {} {} {:.3g}: {}",
        setting.at("name").get<std::string>(), own, seconds_text(end.at("seconds").get<double>()), first,
        end.value("kind", std::string()) == "extrapolated" ? "would then have" : "then has", theirs,
        gain_text(ratio, "less", "more")));
  }
  if (compared == 0) return "";
  return line_of(
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
    const std::string first = report.at("matrix").at("settings").at(0).at("name").get<std::string>();
    lines.push_back(finding(scene, first, "time_common", "the whole picture"));
    lines.push_back(finding(scene, first, "tiles_time_common", "nine tiles in ten"));
    if (std::string line = relative_finding(scene, first); !line.empty()) lines.push_back(std::move(line));
  }
  if (!lines.empty() && report.at("matrix").at("repeats").get<int>() < 2)
    lines.push_back("Of one repeat each: what of these factors is noise is not known.");
  return lines;
}

}  // namespace lucerna::bench
