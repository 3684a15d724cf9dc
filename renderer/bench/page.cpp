#include "bench/page.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/html.h"
#include "bench/page_plots.h"
#include "bench/thumbnails.h"

namespace lucerna::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr uint32_t k_picture_width = 344;  ///< at most, on the page

/// "4.12 s" with the range of the repeats in small.
template <class F>
std::string with_range(const Json& spread, F format, const std::string& mark = "") {
  return fmt::format("{}{}<br/><small>{} – {}</small>", mark, format(median_of(spread)),
                     format(spread.at("low").get<double>()), format(spread.at("high").get<double>()));
}

std::string key_of(size_t setting) {
  return fmt::format("<span class=\"key\" style=\"background:{}\"></span>", setting_colour(setting));
}

std::string times_text(int times) {
  return times == 1 ? "once" : times == 2 ? "twice" : fmt::format("{} times", times);
}

/// A ratio, accented when it is a gain beyond the noise and dim when it is none.
std::string ratio_cell(const Json& entry, bool extrapolated) {
  if (!entry.contains("ratio")) return "<span class=\"noise\">1</span>";
  const double ratio = entry.at("ratio").get<double>();
  const bool known = entry.contains("noise"), noise = known && entry.at("noise").get<bool>();
  const char* look = !known || noise ? "noise" : ratio > 1 ? "win" : "";
  return fmt::format("<span class=\"{}\">{}{}</span>", look, extrapolated ? "~" : "", ratio_text(ratio));
}

std::string heading(const Json& report) {
  const Json& cells = report.at("cells");
  std::string html = fmt::format(
      "<h1>What accuracy costs in time</h1>\n<p class=\"dim\" style=\"max-width:none\">lucerna bench, matrix "
      "“{}” · {} · {} · version {}</p>\n",
      escape(text_of(report.at("matrix"), "name")), escape(text_of(report, "date")),
      escape(report.contains("device") ? text_of(report.at("device"), "name") : ""),
      escape(text_of(report, "version")));
  if (!report.value("complete", false))
    html += fmt::format(
        "<p class=\"warn\">Not complete: {} of {} renders are done. Run the same command again to go "
        "on.</p>\n",
        cells.at("done").get<int>(), cells.at("total").get<int>());
  const Json& m = report.at("matrix");
  const std::string plain = escape(text_of(m.at("settings").at(0), "name"));
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
  const auto found = findings(report);
  if (!found.empty()) {
    html += "<ul class=\"found\">";
    for (const std::string& line : found) html += "<li>" + escape(line) + "</li>\n";
    html += "</ul>\n";
  }
  html +=
      "<table><tr><th class=\"l\">setting</th><th class=\"l\">what it is</th><th class=\"l\">options "
      "changed</th></tr>\n";
  for (size_t k = 0; k < m.at("settings").size(); ++k) {
    const Json& s = m.at("settings")[k];
    std::string set;
    for (const auto& [key, value] : s.at("set").items())
      set += fmt::format("{}{}={}", set.empty() ? "" : ", ", key, value.get<std::string>());
    html += fmt::format(
        "<tr><td class=\"l\">{}{}</td><td class=\"l wide\">{}</td><td class=\"l "
        "wide\"><code>{}</code></td></tr>\n",
        key_of(index_of(report, text_of(s, "name"))), escape(text_of(s, "name")), escape(text_of(s, "about")),
        set.empty() ? "–" : escape(set));
  }
  return html + "</table>\n";
}

/// An error as a measure gives it: relative mean squared errors as they are, others in per cent.
std::string error_text(const std::string& measure, double error) {
  return measure == "relmse_time" ? fmt::format("{:.3g}", error) : fmt::format("{:.4g} %", 100 * error);
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
                          first ? " class=\"first\"" : "", first ? escape(text_of(scene, "name")) : "",
                          key_of(index_of(report, text_of(s, "name"))), escape(text_of(s, "name")));
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

/// Nothing for reports from before it was measured.
std::string relative_times(const Json& report) {
  for (const Json& scene : report.at("scenes"))
    for (const Json& s : scene.at("settings"))
      if (!s.contains("relmse_time_to") || !s.contains("relmse_end")) return "";
  const std::string first = escape(text_of(report.at("matrix").at("settings").at(0), "name"));
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
                      row, *row ? escape(text_of(scene, "name")) : "",
                      key_of(index_of(report, text_of(s, "name"))), escape(text_of(s, "name")),
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

std::string times(const Json& report) {
  return "<h2>Time to an error</h2>\n<p>Seconds of rendering, loading and compiling left out: median of the "
         "repeats, the range below it. <b>~</b> marks errors that were not reached: the time is what it "
         "would be if the squared error went on falling as one over the time. <b>&lt;</b>: reached before "
         "the first measurement. <b>–</b>: not reached, nor to be foretold: most of the time went by "
         "before the first sample (as in building a cache), or the reference’s noise hides the "
         "error.</p>\n<h3>The whole picture, true error</h3>\n" +
         time_table(report, "time") +
         "<h3>Nine tiles in ten, estimated error</h3>\n<p class=\"dim\">The renderer’s own estimate for "
         "tiles of 16×16 pixels, each relative to its own brightness: what the eye meets in the difficult "
         "corners, and what adaptive sampling works on.</p>\n" +
         time_table(report, "tiles_time") + relative_times(report);
}

std::string index_table(const Json& report) {
  std::string html =
      "<h2>Relative performance</h2>\n<p>1 / (mean squared error × seconds): twice the figure is the same "
      "error in half the time. The best setting of each scene has 100; the bars are the mean over the "
      "scenes. From the largest budget of each setting. It sees the whole picture only: what is gained in "
      "the difficult tiles stands in the table above.</p>\n<div class=\"wrap\"><table><tr><th "
      "class=\"l\">setting</th><th class=\"l\">mean over scenes</th>";
  for (const Json& scene : report.at("scenes"))
    html += fmt::format("<th>{}</th><th>factor</th>", escape(text_of(scene, "name")));
  html += "</tr>\n";
  for (const Json& entry : report.at("index")) {
    const std::string setting = text_of(entry, "setting");
    const size_t k = index_of(report, setting);
    const double value = entry.at("value").get<double>();
    html += fmt::format(
        "<tr><td class=\"l\">{}{}</td><td class=\"index\"><span class=\"bar\" "
        "style=\"width:{:.0f}px;background:{}\"></span>{:.0f}</td>",
        key_of(k), escape(setting), std::max(1.0, 1.6 * value), setting_colour(k), value);
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

std::string pictures(const Json& scene, const fs::path& folder) {
  const std::string name = text_of(scene, "name");
  uint32_t width = 0, height = 0;
  if (std::sscanf(text_of(scene, "size").c_str(), "%ux%u", &width, &height) != 2 || !width || !height)
    return "";
  // Whole screen pixels a pixel where there is room for them.
  const double zoom =
      width <= k_picture_width ? double(k_picture_width / width) : double(k_picture_width) / width;
  const auto w = uint32_t(std::lround(zoom * width)), h = uint32_t(std::lround(zoom * height));
  double scale = 0;
  std::string html;
  for (const Json& s : scene.at("settings")) {
    const std::string setting = text_of(s, "name"), stem = name + "." + setting;
    const auto error = read_error_picture(folder / (stem + ".exr"));
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
                  folder / (stem + ".error.png")),
        escape(what), percent_text(median_of(cell.at("true"))), seconds_text(median_of(cell.at("wall_s"))));
  }
  if (html.empty()) return "";
  return fmt::format(
      "<div class=\"pictures\">{}</div>\n<div class=\"ramp\"><span>error image, difference in brightness "
      "over the picture’s mean:</span><span>0</span><span class=\"scale\" "
      "style=\"background:{}\"></span><span>{} and more</span></div>\n",
      html, magma_gradient(), percent_text(scale));
}

/// That light was looked up in; 0 without any, and in reports from before they were counted.
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
      "second</th><th>error told of<br/>the mean</th><th>of the<br/>median tile</th><th>of the "
      "worst<br/>tenth of "
      "the tiles</th><th>true error<br/>of the mean</th><th>not<br/>reached</th>";
  const bool with_records = has_records(scene);
  html += with_records
              ? "<th>records</th><th>their rays</th><th>told of the mean:<br/>paths</th><th>records</th>"
                "<th>inter-<br/>polation</th></tr>\n"
              : "</tr>\n";
  for (const Json& s : scene.at("settings")) {
    for (const Json& c : s.at("cells")) {
      const double seconds = median_of(c.at("wall_s"));
      html += fmt::format(
          "<tr><td class=\"l\">{}{}</td><td "
          "class=\"l\">{}</td><td>{}</td><td>{:.4g}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</"
          "td><td>{}</td><td>{}</td>",
          key_of(index_of(report, text_of(s, "name"))), escape(text_of(s, "name")),
          escape(text_of(c, "budget")), with_range(c.at("wall_s"), seconds_text), median_of(c.at("samples")),
          count_text(median_of(c.at("rays"))), count_text(median_of(c.at("rays")) / seconds),
          percent_text(median_of(c.at("estimated"))),
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
                        escape(text_of(s, "name")));
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
                        escape(text_of(s, "name")));
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
  return fmt::format("<h2>{} <small class=\"dim\">{} pixels</small></h2>\n", escape(text_of(scene, "name")),
                     escape(text_of(scene, "size"))) +
         plots(report, scene) + pictures(scene, folder) + cells_table(report, scene) +
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
          escape(text_of(scene, "name")), key_of(index_of(report, text_of(s, "name"))),
          escape(text_of(s, "name")), percent_text(f.at("at").get<double>()),
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
    html += fmt::format("<tr><td class=\"l scene\">{}</td>", escape(text_of(scene, "name")));
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
      "measured.</p>\n<dl>";
  const auto line = [&](const char* name, const std::string& value) {
    if (!value.empty()) html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, escape(value));
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
    html += fmt::format("<dt>command</dt><dd><code>{}</code></dd>\n", escape(text_of(report, "command")));
  return html + "</dl>\n";
}

}  // namespace

std::string make_page(const Json& report, const fs::path& folder) {
  try {
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\"/><title>lucerna bench: "
        "{}</title><style>{}</style></head><body><main>\n",
        escape(text_of(report.at("matrix"), "name")), k_style);
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
