#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/html.h"
#include "bench/page.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Finding {
  double error = 0, ratio = 1, seconds = 0, plain = 0;
  std::string setting, kind;
};

const Json* entry_of(const Json& setting, const char* measure, double error) {
  if (!setting.contains(measure)) return nullptr;
  for (const Json& e : setting.at(measure))
    if (e.at("error").get<double>() == error && e.contains("seconds")) return &e;
  return nullptr;
}

/// The settings' ratios that the noise does not explain, at the smallest error that the first setting has
/// reached; where it has reached none, at the largest.
std::vector<Finding> clear_ratios(const Json& scene, const char* measure) {
  const Json& settings = scene.at("settings");
  const Json& plain = settings.at(0);
  double error = 0;
  for (const Json& e : plain.at(measure))
    if (e.at("kind") == "measured" || error == 0) error = e.at("error").get<double>();
  std::vector<Finding> list;
  const Json* there = entry_of(plain, measure, error);
  for (size_t k = 1; there && k < settings.size(); ++k) {
    const Json* here = entry_of(settings[k], measure, error);
    if (!here || !here->contains("ratio") || here->value("noise", true)) continue;
    list.push_back({error, here->at("ratio").get<double>(), here->at("seconds").at("median").get<double>(),
                    there->at("seconds").at("median").get<double>(),
                    settings[k].at("name").get<std::string>(), here->at("ratio_kind").get<std::string>()});
  }
  return list;
}

}  // namespace

std::vector<std::string> findings(const Json& report) {
  std::vector<std::string> lines;
  for (const Json& scene : report.at("scenes")) {
    const Json& settings = scene.at("settings");
    if (settings.size() < 2) continue;
    const std::string name = scene.at("name").get<std::string>(),
                      plain = settings.at(0).at("name").get<std::string>();
    for (const auto& [measure, what] :
         {std::pair("time_to", "the whole picture"), std::pair("tiles_time_to", "nine tiles in ten")}) {
      std::string line;
      for (const Finding& f : clear_ratios(scene, measure)) {
        const bool sooner = f.ratio > 1;
        const double factor = sooner ? f.ratio : 1 / f.ratio;
        line +=
            fmt::format("{}{} brings {} to {} in {}{}, {} in {}: {} times {}",
                        line.empty() ? name + ": " : "; ", f.setting, what, percent_text(f.error),
                        f.kind == "extrapolated" ? "about " : "", seconds_text(f.seconds), plain,
                        seconds_text(f.plain), fmt::format("{:.2f}", factor), sooner ? "sooner" : "later");
      }
      if (line.empty())
        line = fmt::format("{}: for {}, no setting differs from {} by more than the measurement's noise",
                           name, what, plain);
      lines.push_back(line + ".");
    }
  }
  return lines;
}

}  // namespace lucerna::bench
