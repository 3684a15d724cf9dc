#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/markup.h"
#include "bench/html.h"
#include "bench/page_parts.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string lead(const Json& report) {
  const Json& m = report.at("matrix");
  const int repeats = m.at("repeats").get<int>();
  const std::string first = escape_markup(text_of(m.at("settings").at(0), "name"));
  return fmt::format(
      "<h1>How soon rooms are right</h1>\n<p class=\"dim\" style=\"max-width:none\">lucerna bench, matrix "
      "“{}” · {} · {} · version {}</p>\n{}<p class=\"lead\">Every render is a process of its own, as "
      "<code>lucerna render --time</code> is for anyone: what has to be prepared is in its time, loading and "
      "compiling are not. Settings take turns, every second round backwards{}.</p>\n<p><b>Error as seen.</b> "
      "{}</p>\n<p><b>Factors</b> are by how much less variance × time is than that of <b>{}</b>, the first "
      "setting: of two renders of equal time the quotient of their squared errors. {}</p>\n",
      escape_markup(text_of(m, "name")), escape_markup(text_of(report, "date")),
      escape_markup(report.contains("device") ? text_of(report.at("device"), "name") : ""),
      escape_markup(text_of(report, "version")), incomplete(report),
      repeats > 1 ? fmt::format(", {} rounds with a seed each", repeats) : "", escape_markup(k_about_seen),
      first,
      repeats > 1 ? "Below it is the interval that holds the true factor nine times in ten, by how repeats "
                    "scatter; factors whose interval holds 1 are dim."
                  : "Of one repeat each, how far they can be trusted is not known.");
}

/// A list of the report; empty if it is missing.
const Json& list_of(const Json& report, const char* key) {
  static const Json k_none = Json::array();
  return report.contains(key) ? report.at(key) : k_none;
}

/// Geometric means over the scenes.
std::string means(const Json& report) {
  if (!report.contains("seen_ratios") && !report.contains("seen_besides")) return "";
  std::vector<std::string> budgets;
  for (const char* key : {"seen_ratios", "seen_besides"})
    for (const Json& e : list_of(report, key))
      if (std::find(budgets.begin(), budgets.end(), text_of(e, "budget")) == budgets.end())
        budgets.push_back(text_of(e, "budget"));
  std::string html =
      "<h2>All scenes</h2>\n<p>Geometric means of the factors.</p>\n<table "
      "style=\"width:auto\"><tr><th class=\"l\">setting</th><th class=\"l\">against</th>";
  for (const std::string& budget : budgets) html += fmt::format("<th>{}</th>", escape_markup(budget));
  html += "<th>scenes</th></tr>\n";
  const Json& settings = report.at("matrix").at("settings");
  for (const char* key : {"seen_ratios", "seen_besides"})
    for (const Json& s : settings) {
      const std::string name = text_of(s, "name");
      std::string row;
      double scenes = 0;
      for (const std::string& budget : budgets) {
        const Json* found = nullptr;
        for (const Json& e : list_of(report, key))
          if (text_of(e, "setting") == name && text_of(e, "budget") == budget) found = &e;
        row += found ? "<td>" + ratio_cell_with_range(*found) + "</td>" : "<td class=\"noise\">–</td>";
        if (found) scenes = std::max(scenes, found->at("scenes").get<double>());
      }
      if (scenes > 0)
        html += fmt::format("<tr><td class=\"l\">{}{}</td><td class=\"l\">{}</td>{}<td>{:.0f}</td></tr>\n",
                            key_of(index_of(report, name)), escape_markup(name),
                            escape_markup(key == std::string("seen_ratios") ? text_of(settings.at(0), "name")
                                                                            : text_of(s, "beside")),
                            row, scenes);
    }
  return html + "</table>\n";
}

/// The cell of a budget; null if it was not rendered.
const Json* cell_of(const Json& setting, const std::string& budget) {
  for (const Json& cell : setting.at("cells"))
    if (text_of(cell, "budget") == budget) return &cell;
  return nullptr;
}

std::string errors_table(const Json& report) {
  bool beside = false;
  std::vector<std::string> budgets;
  for (const Json& scene : report.at("scenes"))
    for (const Json& s : scene.at("settings"))
      for (const Json& cell : s.at("cells")) {
        beside = beside || cell.contains("seen_beside");
        if (std::find(budgets.begin(), budgets.end(), text_of(cell, "budget")) == budgets.end())
          budgets.push_back(text_of(cell, "budget"));
      }
  std::string html =
      "<h2>Error as seen after a time</h2>\n<p>Median of the repeats, the range below it.</p>\n<div "
      "class=\"wrap\"><table><tr><th class=\"l\">scene</th><th class=\"l\">setting</th>";
  for (const std::string& budget : budgets)
    html += fmt::format("<th>{}</th><th>squared</th><th>factor</th>{}", escape_markup(budget),
                        beside ? "<th>over the<br/>one beside</th>" : "");
  html += "</tr>\n";
  for (const Json& scene : report.at("scenes")) {
    const char* row = " class=\"first\"";
    for (const Json& s : scene.at("settings")) {
      html += fmt::format("<tr{}><td class=\"l scene\">{}</td><td class=\"l\">{}{}</td>", row,
                          *row ? escape_markup(text_of(scene, "name")) : "",
                          key_of(index_of(report, text_of(s, "name"))), escape_markup(text_of(s, "name")));
      row = "";
      for (const std::string& budget : budgets) {
        const Json* cell = cell_of(s, budget);
        if (!cell) {
          html += beside ? "<td>–</td><td></td><td></td><td></td>" : "<td>–</td><td></td><td></td>";
          continue;
        }
        const Json& seen = cell->at("seen");
        const auto rooted = [](double x) { return x > 0 ? percent_text(std::sqrt(x)) : "lost in noise"; };
        html +=
            fmt::format("<td>{}</td><td>{:.3g}</td><td>{}</td>", with_range(seen, rooted), median_of(seen),
                        cell->contains("seen_ratio") ? ratio_cell_with_range(cell->at("seen_ratio")) : "");
        if (beside)
          html += fmt::format("<td>{}</td>", cell->contains("seen_beside")
                                                 ? ratio_cell_with_range(cell->at("seen_beside"))
                                                 : "");
      }
      html += "</tr>\n";
    }
  }
  return html + "</table></div>\n";
}

/// Uncertainty of the figures from the references, scene by scene.
std::string references_table(const Json& report) {
  std::string html =
      "<h2>The measurement itself</h2>\n<p>References are plain path tracing with another seed; the two "
      "halves of their samples are independent. “Known to” is the standard error that their noise leaves to "
      "a squared error as seen.</p>\n<table style=\"width:auto\"><tr><th "
      "class=\"l\">scene</th><th>pixels</th>"
      "<th>samples</th><th>it took</th><th>known to</th><th>noise of factors</th></tr>\n";
  for (const Json& scene : report.at("scenes"))
    for (const Json& r : report.at("references")) {
      if (text_of(r, "scene") != text_of(scene, "name")) continue;
      const bool known = scene.contains("noise") && scene.at("noise").contains("seen_index");
      html += fmt::format(
          "<tr><td class=\"l scene\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>± "
          "{:.2g}</td><td>{}</td></tr>\n",
          escape_markup(text_of(scene, "name")), escape_markup(text_of(scene, "size")),
          r.at("samples").get<int>(), seconds_text(r.at("seconds").get<double>()),
          r.at("seen_noise").get<double>(),
          known ? ratio_text(scene.at("noise").at("seen_index").get<double>()) : "not known");
    }
  return html + "</table>\n";
}

std::string seen_part(const Json& report, const Json& scene, const fs::path& folder) {
  return fmt::format("<h2>{} <small class=\"dim\">{} pixels</small></h2>\n",
                     escape_markup(text_of(scene, "name")), escape_markup(text_of(scene, "size"))) +
         seen_plot(report, scene) + pictures(scene, folder, k_as_seen);
}

}  // namespace

std::string make_seen_page(const Json& report, const fs::path& folder) {
  std::string html = page_head(text_of(report.at("matrix"), "name")) + lead(report) + findings_list(report) +
                     settings_table(report);
  if (!report.at("scenes").empty()) {
    html += means(report) + errors_table(report);
    html +=
        "<h2>Time to an error as seen</h2>\n<p>From the ends of the renders. <b>~</b>: not reached; "
        "extrapolated, with the squared error proportional to one over the time; <b>&lt;</b>: reached by the "
        "shortest render; <b>–</b>: not predictable.</p>\n" +
        time_table(report, "seen_time");
    for (const Json& scene : report.at("scenes")) html += seen_part(report, scene, folder);
  }
  return html + references_table(report) + machine_facts(report) + "</main></body></html>\n";
}

}  // namespace lucerna::bench
