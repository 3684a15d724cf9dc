#include "bench/page.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/markup.h"
#include "bench/html.h"
#include "bench/page_parts.h"
#include "bench/page_plots.h"
#include "bench/thumbnails.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string times_text(int times) {
  return times == 1 ? "once" : times == 2 ? "twice" : fmt::format("{} times", times);
}

std::string heading(const Json& report) {
  std::string html = fmt::format(
      "<h1>What accuracy costs in time</h1>\n<p class=\"dim\" style=\"max-width:none\">lucerna bench, matrix "
      "“{}” · {} · {} · version {}</p>\n",
      escape_markup(text_of(report.at("matrix"), "name")), escape_markup(text_of(report, "date")),
      escape_markup(report.contains("device") ? text_of(report.at("device"), "name") : ""),
      escape_markup(text_of(report, "version")));
  html += incomplete(report);
  const Json& m = report.at("matrix");
  const std::string plain = escape_markup(text_of(m.at("settings").at(0), "name"));
  html += fmt::format(
      "<p class=\"lead\">{} scene{} {} rendered with {} setting{} of the renderer, each {}, and held "
      "against a picture that was rendered much longer. <b>Error</b> is the distance from that picture: the "
      "root mean square of the difference in brightness, over the mean brightness. At 5 % noise is plainly "
      "seen, at 2 % on a second look, at 1 % hardly.</p>\n<p>What to read: how soon a setting reaches an "
      "error, and by what factor that is sooner than <b>{}</b>, the first setting. Every factor rests on "
      "measurements that scatter; those that the scatter explains are <span class=\"noise\">dim</span>, "
      "gains beyond it are <span class=\"win\">blue</span>.</p>\n",
      m.at("scenes").size(), m.at("scenes").size() == 1 ? "" : "s",
      m.at("scenes").size() == 1 ? "was" : "were", m.at("settings").size(),
      m.at("settings").size() == 1 ? "" : "s", times_text(m.at("repeats").get<int>()), plain);
  html += findings_list(report);
  return html + settings_table(report);
}

/// "" for reports from before it was measured.
std::string relative_times(const Json& report) {
  for (const Json& scene : report.at("scenes"))
    for (const Json& s : scene.at("settings"))
      if (!s.contains("relmse_time_to") || !s.contains("relmse_end")) return "";
  const std::string first = escape_markup(text_of(report.at("matrix").at("settings").at(0), "name"));
  std::string html = fmt::format(
      "<h3>Every pixel by its own brightness, relative mean squared error</h3>\n<p class=\"dim\">The mean "
      "over the pixels and colours of (t − r₁)(t − r₂) / (r² + 0.01), t the picture, r₁ and r₂ the halves of "
      "the reference, which are independent, so that its noise adds nothing; r is their mean over the "
      "neighbours. Left out is 0.1 % of the pixels, those whose neighbours are worst. 0.0004 is 2 % of a "
      "pixel’s brightness.</p>\n"
      "{}<div class=\"wrap\"><table><tr><th class=\"l\">scene</th><th class=\"l\">setting</th><th>rendered "
      "for</th><th>error in the end</th><th>of {} by then</th><th>times</th><th>falls as</th><th>known "
      "to</th></tr>\n",
      time_table(report, "relmse_time"), first);
  for (const Json& scene : report.at("scenes")) {
    std::string noise = "–";
    for (const Json& r : report.at("references"))
      if (text_of(r, "scene") == text_of(scene, "name") && r.contains("relmse_noise"))
        noise = fmt::format("± {:.2g}", r.at("relmse_noise").get<double>());
    const char* row = " class=\"first\"";
    for (const Json& s : scene.at("settings")) {
      const Json& end = s.at("relmse_end");
      const auto plain = [](double x) { return fmt::format("{:.3g}", x); };
      html +=
          fmt::format("<tr{}><td class=\"l scene\">{}</td><td class=\"l\">{}{}</td><td>{}</td><td>{}</td>",
                      row, *row ? escape_markup(text_of(scene, "name")) : "",
                      key_of(index_of(report, text_of(s, "name"))), escape_markup(text_of(s, "name")),
                      seconds_text(end.at("seconds").get<double>()), with_range(end.at("relmse"), plain));
      html += !end.contains("first")
                  ? "<td></td><td></td>"
                  : fmt::format(
                        "<td>{}</td><td>{}</td>",
                        with_range(end.at("first"), plain, text_of(end, "kind") == "extrapolated" ? "~" : ""),
                        end.contains("ratio") ? ratio_text(end.at("ratio").get<double>()) : "–");
      html += s.contains("relmse_power")
                  ? fmt::format("<td>t<sup>{:.2f}</sup></td>", median_of(s.at("relmse_power")))
                  : "<td class=\"noise\">–</td>";
      html += fmt::format("<td>{}</td></tr>\n", noise);
      row = "";
    }
  }
  return html +
         "</table></div>\n<p class=\"dim\">“Known to” is the standard error that the references’ noise "
         "leaves. Extrapolated times (~) may be trusted where the error falls as t<sup>−1</sup>, as that of "
         "plain sampling does.</p>\n";
}

/// "" for reports from before it was measured.
std::string seen_times(const Json& report) {
  for (const Json& scene : report.at("scenes"))
    for (const Json& s : scene.at("settings"))
      if (!s.contains("seen_time_to")) return "";
  return "<h3>The error as seen</h3>\n<p class=\"dim\">" + escape_markup(k_about_seen) + "</p>\n" +
         time_table(report, "seen_time");
}

std::string times(const Json& report) {
  return "<h2>Time to an error</h2>\n<p>Seconds of rendering, without loading and compiling: median of the "
         "repeats, and their range below it. <b>~</b>: not reached; extrapolated, with the squared error "
         "proportional to one over the time. <b>&lt;</b>: reached before the first measurement. "
         "<b>–</b>: not reached and not predictable: most of the time passed before the first sample (as in "
         "building a cache), or the reference’s noise hides the error.</p>\n<h3>The whole picture, true "
         "error</h3>\n" +
         time_table(report, "time") +
         "<h3>Nine tiles in ten, estimated error</h3>\n<p class=\"dim\">The renderer’s own estimate for "
         "tiles of 16×16 pixels, each relative to its own brightness: the visible error of difficult parts, "
         "which adaptive sampling reduces.</p>\n" +
         time_table(report, "tiles_time") + seen_times(report) + relative_times(report);
}

std::string index_table(const Json& report) {
  std::string html =
      "<h2>Relative performance</h2>\n<p>1 / (mean squared error × seconds): twice the figure is the same "
      "error in half the time. The best setting of each scene has 100; the bars are the mean over the "
      "scenes. From the largest budget of each setting. It measures the whole picture only; the table above "
      "has the difficult tiles.</p>\n<div class=\"wrap\"><table><tr><th "
      "class=\"l\">setting</th><th class=\"l\">mean over scenes</th>";
  for (const Json& scene : report.at("scenes"))
    html += fmt::format("<th>{}</th><th>factor</th>", escape_markup(text_of(scene, "name")));
  html += "</tr>\n";
  for (const Json& entry : report.at("index")) {
    const std::string setting = text_of(entry, "setting");
    const size_t k = index_of(report, setting);
    const double value = entry.at("value").get<double>();
    html += fmt::format(
        "<tr><td class=\"l\">{}{}</td><td class=\"index\"><span class=\"bar\" "
        "style=\"width:{:.0f}px;background:{}\"></span>{:.0f}</td>",
        key_of(k), escape_markup(setting), std::max(1.0, 1.6 * value), setting_colour(k), value);
    for (const Json& scene : report.at("scenes")) {
      const Json* found = nullptr;
      for (const Json& s : scene.at("settings"))
        if (text_of(s, "name") == setting && s.contains("index")) found = &s.at("index");
      html += found ? fmt::format("<td>{:.0f}</td><td>{}</td>", found->at("relative").get<double>(),
                                  ratio_cell(*found, false))
                    : "<td class=\"noise\">–</td><td></td>";
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

/// Number of records for lookups; 0 without any, and in reports from before they were counted.
double records_of(const Json& cell) { return cell.contains("records") ? median_of(cell.at("records")) : 0; }

bool has_records(const Json& scene) {
  for (const Json& s : scene.at("settings"))
    for (const Json& c : s.at("cells"))
      if (records_of(c) > 0) return true;
  return false;
}

std::string records_cells(const Json& cell) {
  std::string html =
      fmt::format("<td>{:.0f}</td><td>{}</td>", records_of(cell),
                  cell.contains("record_rays") ? count_text(median_of(cell.at("record_rays"))) : "–");
  for (const char* part : {"paths_error", "records_error", "interpolation_error"})
    html += fmt::format("<td>{}</td>", cell.contains(part) ? percent_text(median_of(cell.at(part))) : "–");
  return html;
}

std::string cells_table(const Json& report, const Json& scene) {
  std::string html =
      "<div class=\"wrap\"><table><tr><th class=\"l\">setting</th><th "
      "class=\"l\">budget</th><th>seconds</th><th>samples<br/>a pixel</th><th>rays</th><th>rays a "
      "second</th><th>estimated error<br/>of the mean</th><th>of the<br/>median tile</th><th>of the "
      "worst<br/>tenth of "
      "the tiles</th><th>true error<br/>of the mean</th><th>not<br/>reached</th>";
  const bool with_records = has_records(scene);
  html +=
      with_records
          ? "<th>records</th><th>their rays</th><th>estimated for the mean:<br/>paths</th><th>records</th>"
            "<th>inter-<br/>polation</th></tr>\n"
          : "</tr>\n";
  for (const Json& s : scene.at("settings")) {
    for (const Json& c : s.at("cells")) {
      const double seconds = median_of(c.at("wall_s"));
      html += fmt::format(
          "<tr><td class=\"l\">{}{}</td><td "
          "class=\"l\">{}</td><td>{}</td><td>{:.4g}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</"
          "td><td>{}</td><td>{}</td>",
          key_of(index_of(report, text_of(s, "name"))), escape_markup(text_of(s, "name")),
          escape_markup(text_of(c, "budget")), with_range(c.at("wall_s"), seconds_text),
          median_of(c.at("samples")), count_text(median_of(c.at("rays"))),
          count_text(median_of(c.at("rays")) / seconds), percent_text(median_of(c.at("estimated"))),
          c.contains("tiles_median") ? percent_text(median_of(c.at("tiles_median"))) : "–",
          percent_text(median_of(c.at("tiles_decile"))),
          c.value("in_reference_noise", false) ? "in the reference’s noise"
                                               : with_range(c.at("true"), percent_text),
          median_of(c.at("tiles_over")) > 0 ? fmt::format("{:.0f} tile{}", median_of(c.at("tiles_over")),
                                                          median_of(c.at("tiles_over")) == 1 ? "" : "s")
                                            : "–");
      if (with_records)
        html += records_of(c) > 0 ? records_cells(c) : "<td>–</td><td>–</td><td>–</td><td>–</td><td>–</td>";
      html += "</tr>\n";
    }
  }
  return html + "</table></div>\n";
}

std::string short_times(const Json& report, const Json& scene) {
  const Json& first = scene.at("settings").at(0);
  if (!first.contains("error_at")) return "";
  std::string html = "<table style=\"width:auto\"><tr><th class=\"l\">error after a fixed time</th>";
  for (const Json& e : first.at("error_at"))
    html += fmt::format("<th>{}</th>", seconds_text(e.at("seconds").get<double>()));
  html += "</tr>\n";
  for (const Json& s : scene.at("settings")) {
    html += fmt::format("<tr><td class=\"l\">{}{}</td>", key_of(index_of(report, text_of(s, "name"))),
                        escape_markup(text_of(s, "name")));
    if (s.contains("error_at"))
      for (const Json& e : s.at("error_at"))
        html += "<td>" + with_range(e.at("error"), percent_text) + "</td>";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string component_table(const Json& report, const Json& scene) {
  std::string html = "<div class=\"wrap\"><table><tr><th class=\"l\">by component, largest budget</th>";
  static constexpr const char* k_names[] = {"primary", "secondary", "tertiary", "caustic"};
  static constexpr const char* k_colours[] = {"#eba842", "#40b8ac", "#9c80e0", "#f2745e"};
  for (int k = 0; k < 4; ++k)
    html += fmt::format(
        "<th><span class=\"key\" style=\"background:{}\"></span>{}<br/>true error</th><th>share of "
        "<br/>device time</th>",
        k_colours[k], k_names[k]);
  html += "</tr>\n";
  for (const Json& s : scene.at("settings")) {
    const Json& c = s.at("cells").back();
    html += fmt::format("<tr><td class=\"l\">{}{}</td>", key_of(index_of(report, text_of(s, "name"))),
                        escape_markup(text_of(s, "name")));
    const double all = median_of(c.at("device_s"));
    for (const char* name : k_names) {
      const Json& layer = c.at("components").at(name);
      const double error = median_of(layer.at("true")), estimate = median_of(layer.at("estimated"));
      const double share = all > 0 ? 100 * median_of(layer.at("device_s")) / all : 0;
      html += fmt::format("<td>{}</td><td>{}</td>",
                          error > 0      ? percent_text(error)
                          : estimate > 0 ? "in the reference’s noise"
                                         : "–",
                          share > 0 || error > 0 ? fmt::format("{:.0f} %", share) : "–");
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string scene_part(const Json& report, const Json& scene, const fs::path& folder) {
  return fmt::format("<h2>{} <small class=\"dim\">{} pixels</small></h2>\n",
                     escape_markup(text_of(scene, "name")), escape_markup(text_of(scene, "size"))) +
         plots(report, scene) + pictures(scene, folder, k_of_mean) + cells_table(report, scene) +
         short_times(report, scene) + component_table(report, scene);
}

std::string forecast_table(const Json& report) {
  std::string rows;
  for (const Json& scene : report.at("scenes"))
    for (const Json& s : scene.at("settings")) {
      if (!s.contains("forecast")) continue;
      const Json& f = s.at("forecast");
      rows += fmt::format(
          "<tr><td class=\"l scene\">{}</td><td class=\"l\">{}{}</td><td>{}</td><td>{}</td><td>{}</td><td>{} "
          "of {}</td></tr>\n",
          escape_markup(text_of(scene, "name")), key_of(index_of(report, text_of(s, "name"))),
          escape_markup(text_of(s, "name")), percent_text(f.at("at").get<double>()),
          with_range(f.at("rays"), ratio_text), with_range(f.at("seconds"), ratio_text),
          f.at("in_band").get<int>(), f.at("of").get<int>());
    }
  if (rows.empty()) return "";
  return "<h2>How good the forecast is</h2>\n<p>When a tenth of a render’s time was over it foretold what "
         "the whole would take: to its target error (adaptive), or to the error that it had in the end. "
         "1.00× is right, 2× foretold twice as much as it took.</p>\n<table style=\"width:auto\"><tr><th "
         "class=\"l\">scene</th><th class=\"l\">setting</th><th>foretold "
         "at</th><th>rays</th><th>seconds</th><th>seconds within<br/>the band</th></tr>\n" +
         rows + "</table>\n";
}

std::string measurement(const Json& report) {
  std::string html =
      "<h2>The measurement itself</h2>\n<p>Every render ran in a renderer of its own, after a warm-up that "
      "is not in the times; the settings of a scene took turns, every second round backwards. Repeats differ "
      "in their seed, so that their range holds the luck of sampling and the machine’s moods alike. A ratio "
      "of two settings that is below the figure in this table (and above its inverse) is noise: nine in ten "
      "ratios of two equal settings would be. Where the times to one error scatter more than that, their own "
      "scatter counts.</p>\n<table style=\"width:auto\"><tr><th class=\"l\">scene</th><th>time to an "
      "error</th><th>nine tiles in ten</th><th>performance</th><th>rays a second</th><th>reference’s own "
      "noise</th><th>its samples</th><th>it took</th></tr>\n";
  for (const Json& scene : report.at("scenes")) {
    html += fmt::format("<tr><td class=\"l scene\">{}</td>", escape_markup(text_of(scene, "name")));
    for (const char* key : {"time", "tiles_time", "index", "rate"}) {
      const bool known = scene.contains("noise") && scene.at("noise").contains(key);
      html += known ? fmt::format("<td>{}</td>", ratio_text(scene.at("noise").at(key).get<double>()))
                    : "<td class=\"noise\">not known</td>";
    }
    html += fmt::format("<td>{}</td>", percent_text(scene.at("reference_noise").get<double>()));
    const Json* reference = nullptr;
    for (const Json& r : report.at("references"))
      if (text_of(r, "scene") == text_of(scene, "name")) reference = &r;
    html += reference ? fmt::format("<td>{}</td><td>{}</td></tr>\n", reference->at("samples").get<int>(),
                                    seconds_text(reference->at("seconds").get<double>()))
                      : "<td>–</td><td>–</td></tr>\n";
  }
  html +=
      "</table>\n<p class=\"dim\">References are plain path tracing with another seed. The variance of their "
      "noise is taken off every true error; an error below 0.7 of that noise counts as not "
      "measured.</p>\n";
  return html + machine_facts(report);
}

}  // namespace

std::string make_page(const Json& report, const fs::path& folder) {
  try {
    if (report.at("matrix").value("as_seen", false)) return make_seen_page(report, folder);
    std::string html = page_head(text_of(report.at("matrix"), "name"));
    html += heading(report);
    if (!report.at("scenes").empty()) {
      html += times(report) + index_table(report);
      for (const Json& scene : report.at("scenes")) html += scene_part(report, scene, folder);
      html += forecast_table(report);
    }
    return html + measurement(report) + "</main></body></html>\n";
  } catch (const nlohmann::json::exception& e) {
    throw_error("report", "not as a bench writes it: {}", e.what());
  }
}

}  // namespace lucerna::bench
