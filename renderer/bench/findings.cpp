#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/html.h"
#include "bench/page.h"
#include "bench/page_plots.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Text for a ratio: how much better or worse than the first setting.
std::string gain_text(double ratio, const char* better, const char* worse) {
  return fmt::format("{:.2f} times {}", ratio > 1 ? ratio : 1 / ratio, ratio > 1 ? better : worse);
}

/// Line of a scene with the findings on its settings; `none`: text without findings.
std::string scene_line(const Json& scene, const std::vector<std::string>& found,
                       const std::string& otherwise) {
  const std::string name = text_of(scene, "name");
  return found.empty() ? fmt::format("{}: {}.", name, otherwise)
                       : fmt::format("{}: {}.", name, fmt::join(found, "; "));
}

/// Findings on the settings; of the settings of one curve only on the best.
class Found {
 public:
  explicit Found(const Json& report) : report_(report) {}
  void add(const std::string& setting, double ratio, std::string text) {
    const std::string curve = curve_of(report_, setting);
    const auto same = [&](const Finding& t) { return !curve.empty() && t.curve == curve; };
    const auto at = std::find_if(findings_.begin(), findings_.end(), same);
    if (at == findings_.end())
      findings_.push_back({curve, ratio, std::move(text)});
    else if (ratio > at->ratio)
      *at = {curve, ratio, std::move(text)};
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> all;
    for (const Finding& t : findings_) all.push_back(t.text);
    return all;
  }

 private:
  struct Finding {
    std::string curve;
    double ratio;
    std::string text;
  };
  const Json& report_;
  std::vector<Finding> findings_;
};

/// Finding on one measure of one scene; from measured values only, never extrapolated ones.
std::string finding(const Json& report, const Json& scene, const std::string& first, const char* measure,
                    const char* what) {
  Found found(report);
  size_t compared = 0;
  for (const Json& setting : scene.at("settings")) {
    if (!setting.contains(measure)) continue;
    const Json& common = setting.at(measure);
    ++compared;
    if (common.value("noise", false)) continue;
    const double ratio = common.at("ratio").get<double>();
    found.add(
        text_of(setting, "name"), ratio,
        fmt::format("{}: {} to {:.4g} % in {}, {} in {}: {}", text_of(setting, "name"), what,
                    100 * common.at("error").get<double>(), seconds_text(common.at("seconds").get<double>()),
                    first, seconds_text(common.at("first_seconds").get<double>()),
                    gain_text(ratio, "sooner", "later")));
  }
  if (compared == 0)
    return scene_line(
        scene, {}, fmt::format("no error of {} was reached both by {} and by another setting", what, first));
  return scene_line(
      scene, found.texts(),
      fmt::format("for {}, no setting differs from {} by more than the measurement’s noise", what, first));
}

/// Final relative squared errors of the settings, relative to the first setting's after the same time, marked
/// if that is extrapolated. "" for reports from before they were measured.
std::string relative_finding(const Json& report, const Json& scene, const std::string& first) {
  Found found(report);
  size_t compared = 0;
  for (const Json& setting : scene.at("settings")) {
    if (!setting.contains("relmse_end") || !setting.at("relmse_end").contains("ratio")) continue;
    const Json& end = setting.at("relmse_end");
    ++compared;
    if (end.value("noise", false)) continue;
    const double ratio = end.at("ratio").get<double>();
    found.add(text_of(setting, "name"), ratio,
              fmt::format("{} ends with a relative squared error of {:.3g} after {}, {} {} {:.3g}: {}",
                          text_of(setting, "name"), median_of(end.at("relmse")),
                          seconds_text(end.at("seconds").get<double>()), first,
                          text_of(end, "kind") == "extrapolated" ? "would then have" : "then has",
                          median_of(end.at("first")), gain_text(ratio, "less", "more")));
  }
  if (compared == 0) return "";
  return scene_line(
      scene, found.texts(),
      fmt::format("for the relative squared error, no setting differs from {} by more than the measurement’s "
                  "noise",
                  first));
}

/// Minimum number of records with which a curve has that error (not below its minimum); interpolated in
/// logarithms. Its first number if it begins with less error.
double records_to(const PlotLine& curve, double error) {
  const auto at = std::find_if(curve.points.begin(), curve.points.end(),
                               [&](const PlotLine::Point& p) { return p.error.median <= error; });
  if (at == curve.points.begin()) return at->across;
  const PlotLine::Point &a = *(at - 1), &b = *at;
  return log_line(a.error.median, a.across, b.error.median, b.across, error);
}

double least_error(const PlotLine& curve) {
  return std::ranges::min(curve.points, {}, [](const PlotLine::Point& p) { return p.error.median; })
      .error.median;
}

/// Number of records of each further curve relative to the first, at the smallest error that both reach; ""
/// with fewer than two curves.
std::string records_finding(const Json& report, const Json& scene) {
  const std::vector<PlotLine> curves = record_curves(report, scene);
  std::vector<std::string> found;
  for (size_t i = 1; i < curves.size(); ++i) {
    const double error = std::max(least_error(curves[0]), least_error(curves[i]));
    const double first = records_to(curves[0], error), own = records_to(curves[i], error);
    found.push_back(fmt::format("{}: the whole picture to {:.3g} % with {:.0f} records, {} with {:.0f}: {}",
                                curves[i].name, 100 * error, own, curves[0].name, first,
                                gain_text(first / own, "fewer", "more")));
  }
  return found.empty() ? "" : scene_line(scene, found, "");
}

/// Finding from the mean factor over all scenes of a setting relative to another one.
std::string seen_finding(const Json& entry, const std::string& other) {
  const std::string what = fmt::format("{}, {}", text_of(entry, "setting"), text_of(entry, "budget"));
  if (entry.value("noise", false))
    return fmt::format("{}: over {:.0f} scenes no difference from {} beyond the measurement’s noise.", what,
                       entry.at("scenes").get<double>(), other);
  const double ratio = entry.at("ratio").get<double>();
  const std::string range = entry.contains("low")
                                ? fmt::format(" ({} to {})", ratio_text(entry.at("low").get<double>()),
                                              ratio_text(entry.at("high").get<double>()))
                                : std::string();
  return fmt::format("{}: over {:.0f} scenes {}{} the efficiency of {}.", what,
                     entry.at("scenes").get<double>(), ratio_text(ratio), range, other);
}

/// For a matrix of the error as seen: mean factors over all scenes.
std::vector<std::string> seen_findings(const Json& report) {
  std::vector<std::string> lines;
  const Json& settings = report.at("matrix").at("settings");
  for (const Json& e : report.value("seen_ratios", Json::array()))
    lines.push_back(seen_finding(e, text_of(settings.at(0), "name")));
  for (const Json& e : report.value("seen_besides", Json::array()))
    for (const Json& s : settings)
      if (text_of(s, "name") == text_of(e, "setting")) lines.push_back(seen_finding(e, text_of(s, "beside")));
  if (!lines.empty() && report.at("matrix").at("repeats").get<int>() < 2)
    lines.push_back("Of one repeat each: what of these factors is noise is not known.");
  return lines;
}

}  // namespace

std::vector<std::string> findings(const Json& report) {
  std::vector<std::string> lines;
  if (report.at("matrix").value("as_seen", false)) return seen_findings(report);
  for (const Json& scene : report.at("scenes")) {
    const Json& settings = scene.at("settings");
    if (settings.size() < 2) continue;
    const std::string first = text_of(report.at("matrix").at("settings").at(0), "name");
    lines.push_back(finding(report, scene, first, "time_common", "the whole picture"));
    lines.push_back(finding(report, scene, first, "tiles_time_common", "nine tiles in ten"));
    for (std::string line : {relative_finding(report, scene, first), records_finding(report, scene)})
      if (!line.empty()) lines.push_back(std::move(line));
  }
  if (!lines.empty() && report.at("matrix").at("repeats").get<int>() < 2)
    lines.push_back("Of one repeat each: what of these factors is noise is not known.");
  return lines;
}

}  // namespace lucerna::bench
