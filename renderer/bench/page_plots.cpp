#include "bench/page_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/html.h"
#include "bench/plot.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<double> k_marks = {0.05, 0.02, 0.01};

Spread spread_of(const Json& j) {
  return {median_of(j), j.at("low").get<double>(), j.at("high").get<double>(), 1};
}

PlotLine line_of(const Json& report, const Json& setting, const char* curve, const char* cell_figure,
                 double (*rooted)(double) = nullptr) {
  const std::string name = text_of(setting, "name");
  PlotLine line{.name = name, .colour = setting_colour(index_of(report, name))};
  for (const Json& p : setting.at(curve))
    line.points.push_back(
        {p[0].get<double>(), {p[1].get<double>(), p[2].get<double>(), p[3].get<double>(), 1}});
  for (const Json& cell : setting.at("cells")) {
    const double seconds = median_of(cell.at("wall_s")), figure = median_of(cell.at(cell_figure)),
                 error = rooted ? rooted(figure) : figure;
    if (seconds > 0 && error > 0)
      line.dots.push_back({seconds, error,
                           fmt::format("{}, {}: {} in {}", name, text_of(cell, "budget"), percent_text(error),
                                       seconds_text(seconds))});
  }
  return line;
}

}  // namespace

std::vector<PlotLine> record_curves(const Json& report, const Json& scene) {
  const double floor = 0.7 * scene.value("reference_noise", 0.0);
  std::vector<PlotLine> curves;
  for (const Json& s : scene.at("settings")) {
    const std::string name = text_of(s, "name"), curve = curve_of(report, name);
    const Json& cell = s.at("cells").back();
    if (curve.empty() || !cell.contains("records")) continue;
    const double records = median_of(cell.at("records"));
    Spread error = spread_of(cell.at("true"));
    if (!(records > 0) || !(error.median > 0) || cell.value("in_reference_noise", false)) continue;
    // A repeat lost in that noise has an error below the measurable one, not an error of 0.
    if (!(error.low > 0)) error.low = floor > 0 ? std::min(floor, error.median) : error.median;
    auto line =
        std::find_if(curves.begin(), curves.end(), [&](const PlotLine& l) { return l.name == curve; });
    if (line == curves.end())
      line = curves.insert(line, {.name = curve, .colour = setting_colour(index_of(report, name))});
    line->points.push_back({records, error});
    line->dots.push_back({records, error.median,
                          fmt::format("{}: {:.0f} records, {}", name, records, percent_text(error.median))});
  }
  std::erase_if(curves, [](const PlotLine& l) { return l.points.size() < 2; });
  for (PlotLine& line : curves) {
    const auto by_records = [](const auto& a, const auto& b) { return a.across < b.across; };
    std::stable_sort(line.points.begin(), line.points.end(), by_records);
    std::stable_sort(line.dots.begin(), line.dots.end(), by_records);
  }
  return curves;
}

namespace {

std::string figure(const std::string& svg, const char* caption) {
  return svg.empty() ? "" : fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", svg, caption);
}

}  // namespace

std::string text_of(const Json& json, const char* key) { return json.value(key, std::string()); }
double median_of(const Json& spread) { return spread.at("median").get<double>(); }

std::string curve_of(const Json& report, const std::string& setting) {
  for (const Json& s : report.at("matrix").at("settings"))
    if (text_of(s, "name") == setting) return text_of(s, "curve");
  return "";
}

size_t index_of(const Json& report, const std::string& setting) {
  std::vector<std::string> curves;
  size_t place = 0;
  for (const Json& s : report.at("matrix").at("settings")) {
    const std::string curve = text_of(s, "curve");
    size_t here = place;
    if (curve.empty()) {
      curves.emplace_back();  // separate curve
      ++place;
    } else if (const auto at = std::find(curves.begin(), curves.end(), curve); at != curves.end()) {
      here = size_t(at - curves.begin());
    } else {
      curves.push_back(curve);
      ++place;
    }
    if (text_of(s, "name") == setting) return here;
  }
  return 0;
}

std::string seen_plot(const Json& report, const Json& scene) {
  std::vector<PlotLine> lines;
  for (const Json& s : scene.at("settings"))
    lines.push_back(
        line_of(report, s, "seen_curve", "seen", [](double squared) { return std::sqrt(squared); }));
  const std::string svg =
      make_plot(lines, k_marks, text_of(scene, "name") + ": error as seen against seconds", "error as seen");
  return svg.empty() ? ""
                     : "<div class=\"plots\">\n" +
                           figure(svg,
                                  "Error as seen. The band is the range over the repeats, circles are the "
                                  "ends of renders; the dotted lines are 5, 2 and 1 %.") +
                           "</div>\n";
}

std::string plots(const Json& report, const Json& scene) {
  const std::string name = text_of(scene, "name");
  std::string html = "<div class=\"plots\">\n";
  struct View {
    const char *curve, *figure, *axis, *caption;
  };
  for (const View& v :
       {View{"curve", "true", "true error, whole picture",
             "True error of the whole picture. The band is the range over the repeats, circles are the ends "
             "of renders; the dotted lines are 5, 2 and 1 %."},
        View{"tiles_curve", "tiles_decile", "noise of the worst tenth of the tiles",
             "Estimated noise that a tenth of the tiles exceed, relative to their own pixels: the difficult "
             "parts of the picture."}}) {
    std::vector<PlotLine> lines;
    for (const Json& s : scene.at("settings")) lines.push_back(line_of(report, s, v.curve, v.figure));
    html += figure(make_plot(lines, k_marks, name + ": " + v.axis + " against seconds", v.axis), v.caption);
  }
  html += figure(make_plot(record_curves(report, scene), k_marks,
                           name + ": true error of the whole picture against records",
                           "true error, whole picture", Across::records),
                 "True error of the whole picture against the records that light was looked up in. "
                 "Circles are settings, the band is the range of their errors over the repeats: of two "
                 "curves, the lower one makes more of its records.");
  return html + "</div>\n";
}

}  // namespace lucerna::bench
