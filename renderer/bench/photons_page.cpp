#include <cmath>
#include <nlohmann/json.hpp>

#include "base/markup.h"
#include "bench/html.h"
#include "bench/page_plots.h"
#include "bench/photon_errors.h"
#include "bench/photons.h"

namespace lucerna::bench {
namespace {

using Json = nlohmann::ordered_json;

/// Costs within this factor are reported as equal.
constexpr double k_flat = 1.25;
constexpr double k_free_promise = 0.01;

std::string slope_text(double x) { return fmt::format("{:+.3f}", x); }

std::string verdict(const Json& slope) {
  if (slope.at("value").is_null()) return "lost in noise";
  return slope_kept(slope.at("value").get<double>(), slope.at("expected").get<double>())
             ? "within a tenth of what is expected"
             : "not within a tenth of what is expected";
}

std::string measured(const Json& slope) {
  if (slope.at("value").is_null()) return "not known";
  return fmt::format("{} ({} to {})", slope_text(slope.at("value").get<double>()),
                     slope_text(slope.at("low").get<double>()), slope_text(slope.at("high").get<double>()));
}

/// Largest over smallest cost of a path in the rows from `from`.
double growth(const Json& rows, size_t from) {
  double least = 1e300, most = 0;
  for (size_t i = from; i < rows.size(); ++i) {
    const double cost = rows[i].at("cpu_us_a_path").get<double>();
    least = std::min(least, cost), most = std::max(most, cost);
  }
  return least > 0 && least < 1e300 ? most / least : 0;
}

/// Cost of a light path over `what`, and the value from which it is constant.
std::string cost_text(const Json& rows, const char* what) {
  const auto at = [&](size_t i) { return rows[i].at(what).get<uint32_t>(); };
  std::string text = fmt::format(
      "a light path and its photons' sorting cost {:.2f} µs of CPU time at {} {}, {:.2f} µs at {}",
      rows.front().at("cpu_us_a_path").get<double>(), at(0), what,
      rows.back().at("cpu_us_a_path").get<double>(), at(rows.size() - 1));
  size_t flat = 0;
  while (flat + 1 < rows.size() && growth(rows, flat) >= k_flat) ++flat;
  if (flat + 1 < rows.size())
    text += fmt::format("; within {:.2f} of each other from {} on", growth(rows, flat), at(flat));
  return text;
}

std::vector<std::string> photon_findings(const Json& report) {
  std::vector<std::string> all;
  if (report.contains("slopes"))
    for (const Json& s : report.at("slopes"))
      for (const Json& slope : s.at("slopes"))
        all.push_back(fmt::format("{}, {}: {} over {} {}, expected {}: {}", text_of(s, "scene"),
                                  text_of(s, "series"), text_of(slope, "of"), text_of(slope, "over"),
                                  measured(slope), slope_text(slope.at("expected").get<double>()),
                                  verdict(slope)));
  for (const auto& [part, what] : {std::pair("rounds", "paths"), std::pair("lamps", "lamps")})
    if (report.contains(part) && report.at(part).size() > 1) all.push_back(cost_text(report.at(part), what));
  if (report.contains("free")) {
    const Json& f = report.at("free");
    const double high = f.at("high").get<double>(), low = f.at("low").get<double>();
    all.push_back(
        fmt::format("{}, nothing to bundle light: photons for caustics cost {:+.2f} % ({:+.2f} to {:+.2f}), "
                    "{} rays against "
                    "{}: {}",
                    text_of(f, "scene"), 100 * f.at("extra").get<double>(), 100 * low, 100 * high,
                    f.at("rays_with_photons").get<uint64_t>(), f.at("rays").get<uint64_t>(),
                    high < k_free_promise  ? "under 1 %"
                    : low > k_free_promise ? "over 1 %"
                                           : "not distinguishable from 1 %"));
  }
  return all;
}

std::string rate(double x) { return x > 0 ? count_text(x) + "/s" : "–"; }

// Tables as rows of cells, for text and page alike; the first row is the heading.
using Table = std::vector<std::vector<std::string>>;

Table slope_points(const Json& s) {
  const std::string over = text_of(s, "over");
  Table t{{over == "radius" ? "radius, pixels" : "rounds", "noise", "bias", "error"}};
  const auto cell = [](const Json& p, const char* key) {
    if (!p.contains(key)) return std::string("–");
    const double x = p.at(key).get<double>();
    return x > 0 ? percent_text(x) : std::string("lost in noise");
  };
  for (const Json& p : s.at("points"))
    t.push_back({fmt::format("{:.3g}", p.at(over).get<double>()), cell(p, "noise"), cell(p, "bias"),
                 cell(p, "error")});
  return t;
}

Table slopes_table(const Json& s) {
  Table t{{"slope of", "over", "measured (95 %)", "expected", "", ""}};
  for (const Json& slope : s.at("slopes"))
    t.push_back({text_of(slope, "of"), text_of(slope, "over"), measured(slope),
                 slope_text(slope.at("expected").get<double>()), text_of(slope, "why"), verdict(slope)});
  return t;
}

Table rounds_table(const Json& rows, const char* what) {
  Table t{{what, "photons", "round", "light paths", "sorting", "its share", "emitted", "stored", "sorted",
           "gathered", "memory", "CPU a path"}};
  for (const Json& r : rows) {
    const auto number = [&](const char* key) { return r.at(key).get<double>(); };
    t.push_back({count_text(number(what)), count_text(number("photons")), seconds_text(number("wall_s")),
                 seconds_text(number("trace_s")), seconds_text(number("build_s")),
                 percent_text(number("build_share")), rate(number("emitted_per_s")),
                 rate(number("stored_per_s")), rate(number("sorted_per_s")), rate(number("gathered_per_s")),
                 count_text(number("bytes")) + "B", fmt::format("{:.2f} µs", number("cpu_us_a_path"))});
  }
  return t;
}

/// Figures of the largest round.
std::optional<double> bytes_a_million(const Json& rows) {
  const double photons = rows.back().at("photons").get<double>();
  if (!(photons > 0)) return std::nullopt;
  return 1e6 * rows.back().at("bytes").get<double>() / photons;
}

size_t width_of(const std::string& text) {
  size_t n = 0;
  for (const char c : text) n += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  return n;
}

std::string as_text(const Table& t) {
  std::vector<size_t> widths;
  for (const auto& row : t)
    for (size_t i = 0; i < row.size(); ++i) {
      if (widths.size() <= i) widths.push_back(0);
      widths[i] = std::max(widths[i], width_of(row[i]));
    }
  std::string text;
  for (const auto& row : t) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i)
      line += std::string(2 + widths[i] - width_of(row[i]), ' ') + row[i];
    text += line + "\n";
  }
  return text;
}

std::string as_html(const Table& t) {
  std::string html = "<div class=\"wrap\"><table>";
  for (size_t k = 0; k < t.size(); ++k) {
    html += "<tr>";
    for (const std::string& cell : t[k])
      html += k == 0 ? "<th>" + escape_markup(cell) + "</th>" : "<td>" + escape_markup(cell) + "</td>";
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string plot_of(const Json& s) {
  const std::string over = text_of(s, "over");
  static constexpr std::pair<const char*, const char*> k_lines[] = {
      {"noise", "#8fb4c8"}, {"bias", "#ec7fbc"}, {"error", "#e6e4e0"}};
  std::vector<PlotLine> lines;
  for (const auto& [name, colour] : k_lines) {
    PlotLine line{.name = name, .colour = colour, .points = {}, .dots = {}};
    for (const Json& p : s.at("points")) {
      const double y = p.contains(name) ? p.at(name).get<double>() : 0;
      if (!(y > 0)) continue;
      const double x = p.at(over).get<double>();
      line.points.push_back({x, {y, y, y}});
      line.dots.push_back({x, y, fmt::format("{} {:.3g}: {} {}", over, x, name, percent_text(y))});
    }
    if (!line.points.empty()) lines.push_back(std::move(line));
  }
  return make_plot(lines, {}, text_of(s, "scene") + ", " + text_of(s, "series"),
                   "rms over the mean luminance", over == "radius" ? Across::radius : Across::rounds);
}

std::string about_series(const Json& s) {
  return fmt::format(
      "{} pixels that show a plane, {} renders with seeds of their own; radius {:.3g} pixels at first, floor "
      "{:.3g}, alpha {:.3g}.",
      s.at("pixels").get<int>(), s.at("seeds").get<int>(), s.at("radius").get<double>(),
      s.at("floor").get<double>(), s.at("alpha").get<double>());
}

constexpr const char* k_about_slopes =
    "Noise: standard deviation of renders with different seeds. Bias: difference of their mean from the "
    "truth, from products of the differences of two renders from two independent references, so that it "
    "contains no noise. Error: that of one render. Slopes are exponents, by least squares on the logarithms, "
    "with jackknife intervals. The variance of a pass goes with 1 / r², its bias with r² if light is at most "
    "parabolic within a disc. Passes are averaged, so noise falls with the power -alpha / 2 and bias with "
    "alpha - 1; where the radius rests, noise with -1/2. At the sharp rim of a caustic the blur is as wide "
    "as "
    "the disc whatever its size, and bias falls more slowly.";

}  // namespace

bool slope_kept(double measured, double expected) {
  return std::abs(measured - expected) <= 0.1 * std::abs(expected);
}

std::string photons_text(const Json& report) {
  std::string text;
  if (report.contains("slopes"))
    for (const Json& s : report.at("slopes"))
      text += fmt::format("{}, {}: {}\n", text_of(s, "scene"), text_of(s, "series"), about_series(s)) +
              as_text(slope_points(s)) + as_text(slopes_table(s)) + "\n";
  if (report.contains("rounds")) {
    text += "light paths a round, glass, caustics\n" + as_text(rounds_table(report.at("rounds"), "paths"));
    if (const auto bytes = bytes_a_million(report.at("rounds")))
      text += fmt::format("  {}B a million photons, in the largest round\n", count_text(*bytes));
    text += "\n";
  }
  if (report.contains("lamps"))
    text += "lamps, glass, caustics\n" + as_text(rounds_table(report.at("lamps"), "lamps")) + "\n";
  for (const std::string& found : photon_findings(report)) text += found + "\n";
  return text;
}

std::string photons_page(const Json& report) {
  try {
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\"/><title>lucerna bench: photons</title><style>{}"
        "</style></head><body><main>\n<h1>What photons cost, and how their errors fall</h1>\n<p "
        "class=\"dim\">{}, {}; Lucerna {}, {}</p>\n<ul class=\"found\">\n",
        k_style, escape_markup(text_of(report.at("machine"), "cpu")),
        escape_markup(text_of(report.at("device"), "name")), escape_markup(text_of(report, "version")),
        escape_markup(text_of(report, "date")));
    for (const std::string& found : photon_findings(report))
      html += "<li>" + escape_markup(found) + "</li>\n";
    html += "</ul>\n";
    if (report.contains("slopes")) {
      html += "<h2>Errors over rounds and radii</h2>\n<p>" + escape_markup(k_about_slopes) + "</p>\n";
      for (const Json& s : report.at("slopes"))
        html += fmt::format("<h3>{}, {}</h3>\n<p class=\"dim\">{}</p>\n", escape_markup(text_of(s, "scene")),
                            escape_markup(text_of(s, "series")), escape_markup(about_series(s))) +
                "<div class=\"plots\"><figure>" + plot_of(s) + "</figure><div>" + as_html(slope_points(s)) +
                "</div></div>" + as_html(slopes_table(s));
    }
    if (report.contains("rounds")) {
      html +=
          "<h2>Rounds</h2>\n<p>Caustics on glass; medians over rounds after one that is not counted. A "
          "round is a sample of the picture with its light paths, their photons' sorting, and paths from "
          "the eye.</p>\n" +
          as_html(rounds_table(report.at("rounds"), "paths"));
      if (const auto bytes = bytes_a_million(report.at("rounds")))
        html += fmt::format(
            "<p>{}B a million photons in the largest round, working memory of the sort included.</p>\n",
            count_text(*bytes));
    }
    if (report.contains("lamps"))
      html += "<h2>Lamps</h2>\n<p>The same scene under lamps without extent, as strong together.</p>\n" +
              as_html(rounds_table(report.at("lamps"), "lamps"));
    if (report.contains("free")) {
      const Json& f = report.at("free");
      html += fmt::format(
          "<h2>Where nothing bundles light</h2>\n<p>{}: photons for caustics against path tracing, in turns, "
          "{} pairs of {} samples, {} of CPU time each: {:+.2f} % ({:+.2f} to {:+.2f}, the median's 95 % "
          "interval); {:.0f} light paths sent.</p>\n",
          escape_markup(text_of(f, "scene")), f.at("pairs").get<int>(), f.at("samples").get<int>(),
          seconds_text(f.at("path_cpu_s").get<double>()), 100 * f.at("extra").get<double>(),
          100 * f.at("low").get<double>(), 100 * f.at("high").get<double>(),
          f.at("light_paths").get<double>());
    }
    html += "<h2>The measurement itself</h2>\n<dl>";
    const Json& m = report.at("machine");
    html += fmt::format(
        "<dt>processor</dt><dd>{}, {} cores</dd>\n<dt>device</dt><dd>{}, {}</dd>\n<dt>load "
        "before</dt><dd>{:.2f}"
        "</dd>\n<dt>the bench took</dt><dd>{}</dd>\n<dt>command</dt><dd><code>{}</code></dd></dl>\n",
        escape_markup(text_of(m, "cpu")), m.at("cores").get<int>(),
        escape_markup(text_of(report.at("device"), "name")),
        escape_markup(text_of(report.at("device"), "driver")), m.at("load").get<double>(),
        seconds_text(report.at("wall_s").get<double>()), escape_markup(text_of(report, "command")));
    return html + "</main></body></html>\n";
  } catch (const nlohmann::json::exception& e) {
    throw_error("report", "not as a bench writes it: {}", e.what());
  }
}

}  // namespace lucerna::bench
