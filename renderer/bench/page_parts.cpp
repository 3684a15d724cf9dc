#include "bench/page_parts.h"

#include <fmt/format.h>

#include <cmath>

#include "base/markup.h"
#include "bench/html.h"
#include "bench/page.h"
#include "bench/thumbnails.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr uint32_t k_picture_width = 344;  ///< maximum on the page

/// An error in the form of its measure: relative mean squared errors as numbers, others in per cent.
std::string error_text(const std::string& measure, double error) {
  return measure == "relmse_time" ? fmt::format("{:.3g}", error) : fmt::format("{:.4g} %", 100 * error);
}

}  // namespace

const char* const k_about_seen =
    "The root of the mean over the pixels of (t − r₁)(t − r₂) / (l + 0.05 m)², t the picture, r₁ and r₂ "
    "independent references, whose noise therefore adds nothing; l is the mean brightness of the 5×5 pixels "
    "around a pixel, m the picture’s median. 0.1 % of the pixels, the worst, are left out. A dark corner "
    "counts as much as a bright window.";

const ErrorPictures k_of_mean = {"", "the picture’s mean",
                                 [](const Json& cell) { return median_of(cell.at("true")); }};
const ErrorPictures k_as_seen = {".seen", "the brightness around each pixel",
                                 [](const Json& cell) { return std::sqrt(median_of(cell.at("seen"))); }};

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"/><title>lucerna bench: "
      "{}</title><style>{}</style></head><body><main>\n",
      escape_markup(title), k_style);
}

std::string incomplete(const Json& report) {
  if (report.value("complete", false)) return "";
  const Json& cells = report.at("cells");
  return fmt::format(
      "<p class=\"warn\">Not complete: {} of {} renders are done. Run the same command again to go "
      "on.</p>\n",
      cells.at("done").get<int>(), cells.at("total").get<int>());
}

std::string findings_list(const Json& report) {
  const auto found = findings(report);
  if (found.empty()) return "";
  std::string html = "<ul class=\"found\">";
  for (const std::string& line : found) html += "<li>" + escape_markup(line) + "</li>\n";
  return html + "</ul>\n";
}

std::string settings_table(const Json& report) {
  const Json& m = report.at("matrix");
  std::string html =
      "<table><tr><th class=\"l\">setting</th><th class=\"l\">what it is</th><th class=\"l\">options "
      "changed</th></tr>\n";
  for (size_t k = 0; k < m.at("settings").size(); ++k) {
    const Json& s = m.at("settings")[k];
    std::string set;
    for (const auto& [key, value] : s.at("set").items())
      set += fmt::format("{}{}={}", set.empty() ? "" : ", ", key, value.get<std::string>());
    if (const std::string program = text_of(s, "program"); !program.empty())
      set += fmt::format("{}rendered by {}", set.empty() ? "" : "; ", program);
    html += fmt::format(
        "<tr><td class=\"l\">{}{}</td><td class=\"l wide\">{}</td><td class=\"l "
        "wide\"><code>{}</code></td></tr>\n",
        key_of(index_of(report, text_of(s, "name"))), escape_markup(text_of(s, "name")),
        escape_markup(text_of(s, "about")), set.empty() ? "–" : escape_markup(set));
  }
  return html + "</table>\n";
}

std::string key_of(size_t setting) {
  return fmt::format("<span class=\"key\" style=\"background:{}\"></span>", setting_colour(setting));
}

/// A ratio, accented if it is a gain beyond the noise and dim if within.
std::string ratio_cell(const Json& entry, bool extrapolated) {
  if (!entry.contains("ratio")) return "<span class=\"noise\">1</span>";
  const double ratio = entry.at("ratio").get<double>();
  const bool known = entry.contains("noise"), noise = known && entry.at("noise").get<bool>();
  const char* look = !known || noise ? "noise" : ratio > 1 ? "win" : "";
  return fmt::format("<span class=\"{}\">{}{}</span>", look, extrapolated ? "~" : "", ratio_text(ratio));
}

std::string ratio_cell_with_range(const Json& entry) {
  std::string html = ratio_cell(entry, false);
  if (entry.contains("low"))
    html += fmt::format("<br/><small>{} – {}</small>", ratio_text(entry.at("low").get<double>()),
                        ratio_text(entry.at("high").get<double>()));
  return html;
}

std::string time_table(const Json& report, const std::string& measure) {
  std::string html = "<div class=\"wrap\"><table><tr><th class=\"l\">scene</th><th class=\"l\">setting</th>";
  for (const Json& e : report.at("scenes").at(0).at("settings").at(0).at(measure + "_to"))
    html +=
        fmt::format("<th>time to {}</th><th>factor</th>", error_text(measure, e.at("error").get<double>()));
  html += "<th>factor at the smallest<br/>error both reached</th></tr>\n";
  for (const Json& scene : report.at("scenes")) {
    bool first = true;
    for (const Json& s : scene.at("settings")) {
      html += fmt::format("<tr{}><td class=\"l scene\">{}</td><td class=\"l\">{}{}</td>",
                          first ? " class=\"first\"" : "", first ? escape_markup(text_of(scene, "name")) : "",
                          key_of(index_of(report, text_of(s, "name"))), escape_markup(text_of(s, "name")));
      for (const Json& e : s.at(measure + "_to")) {
        const std::string kind = text_of(e, "kind");
        if (!e.contains("seconds")) {
          html += "<td class=\"noise\">–</td><td></td>";
          continue;
        }
        html += fmt::format("<td>{}</td><td>{}</td>",
                            with_range(e.at("seconds"), seconds_text,
                                       kind == "extrapolated" ? "~"
                                       : kind == "at_once"    ? "&lt; "
                                                              : ""),
                            ratio_cell(e, text_of(e, "ratio_kind") == "extrapolated"));
      }
      const std::string common = measure + "_common";
      html += s.contains(common) ? fmt::format("<td>{}<br/><small>at {}</small></td></tr>\n",
                                               ratio_cell(s.at(common), false),
                                               error_text(measure, s.at(common).at("error").get<double>()))
                                 : "<td class=\"noise\">–</td></tr>\n";
      first = false;
    }
  }
  return html + "</table></div>\n";
}

std::string pictures(const Json& scene, const fs::path& folder, const ErrorPictures& of) {
  const std::string name = text_of(scene, "name");
  uint32_t width = 0, height = 0;
  if (std::sscanf(text_of(scene, "size").c_str(), "%ux%u", &width, &height) != 2 || !width || !height)
    return "";
  // Whole screen pixels per pixel if there is room.
  const double zoom =
      width <= k_picture_width ? double(k_picture_width / width) : double(k_picture_width) / width;
  const auto w = uint32_t(std::lround(zoom * width)), h = uint32_t(std::lround(zoom * height));
  double scale = 0;
  std::string html;
  for (const Json& s : scene.at("settings")) {
    const std::string setting = text_of(s, "name"), stem = name + "." + setting;
    const auto error = read_error_picture(folder / (stem + of.suffix + ".exr"));
    if (!error) continue;
    if (scale == 0) scale = scale_of(*error);
    const Json& cell = s.at("cells").back();
    const std::string what = fmt::format("{}, {}", setting, text_of(cell, "budget"));
    html += fmt::format(
        "<figure><div class=\"pair\" style=\"flex-direction:column\">{}{}</div><figcaption>{}<br/>{} in "
        "{}</figcaption></figure>\n",
        image_tag(folder / (stem + ".png"), w, h, name + ", " + what, name + ", " + what),
        image_tag(*error, scale, w, h, "error of " + name + ", " + what,
                  fmt::format("error of {}, {}: black 0, pale {}", name, what, percent_text(scale)),
                  folder / (stem + of.suffix + ".error.png")),
        escape_markup(what), percent_text(of.error(cell)), seconds_text(median_of(cell.at("wall_s"))));
  }
  if (html.empty()) return "";
  return fmt::format(
      "<div class=\"pictures\">{}</div>\n<div class=\"ramp\"><span>error image, difference in brightness "
      "over {}:</span><span>0</span><span class=\"scale\" "
      "style=\"background:{}\"></span><span>{} and more</span></div>\n",
      html, of.over, magma_gradient(), percent_text(scale));
}

std::string machine_facts(const Json& report) {
  std::string html = "<dl>";
  const auto line = [&](const char* name, const std::string& value) {
    if (!value.empty()) html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, escape_markup(value));
  };
  if (report.contains("machine")) {
    const Json& m = report.at("machine");
    line("processor", fmt::format("{}, {} core{}", text_of(m, "cpu"), m.at("cores").get<int>(),
                                  m.at("cores").get<int>() == 1 ? "" : "s"));
    line("memory", fmt::format("{:.1f} GiB", m.at("memory_gib").get<double>()));
    line("system", text_of(m, "system"));
    if (m.contains("load"))
      line("load before", fmt::format("{:.2f} programs running on average in the minute before the start",
                                      m.at("load").get<double>()));
  }
  if (report.contains("device"))
    line("device", text_of(report.at("device"), "name") + ", " + text_of(report.at("device"), "driver"));
  line("version", "Lucerna " + text_of(report, "version"));
  line("date", text_of(report, "date"));
  if (report.contains("wall_s")) line("the bench took", seconds_text(report.at("wall_s").get<double>()));
  if (!text_of(report, "command").empty())
    html +=
        fmt::format("<dt>command</dt><dd><code>{}</code></dd>\n", escape_markup(text_of(report, "command")));
  return html + "</dl>\n";
}

}  // namespace lucerna::bench
