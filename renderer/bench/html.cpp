#include "bench/html.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace lucerna::bench {
namespace {

/// Three significant digits, without exponent.
std::string three(double x) {
  if (!(x > 0)) return "0";
  const int digits = std::max(0, 2 - int(std::floor(std::log10(x))));
  return fmt::format("{:.{}f}", x, digits);
}

}  // namespace

std::string seconds_text(double s) {
  if (s < 99.95) return s < 0.01 ? fmt::format("{:.1f} ms", 1e3 * s) : three(s) + " s";
  const auto whole = (long long)(std::llround(s));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  const long long minutes = std::llround(s / 60);
  if (minutes < 48 * 60) return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
  return fmt::format("{} days", std::llround(s / 86400));
}

std::string percent_text(double share) { return three(100 * share) + " %"; }

std::string ratio_text(double ratio) { return three(ratio) + "×"; }

std::string count_text(double count) {
  for (const auto& [unit, name] : {std::pair(1e9, " G"), std::pair(1e6, " M"), std::pair(1e3, " k")})
    if (count >= unit) return three(count / unit) + name;
  return fmt::format("{:.0f}", count);
}

const char* setting_colour(size_t index) {
  static constexpr std::array<const char*, 8> k_colours = {"#e6e4e0", "#ec7fbc", "#86d36b", "#f2e05c",
                                                           "#b9773f", "#8fb4c8", "#d8c8ff", "#8a8a8a"};
  return k_colours[index % k_colours.size()];
}

const char* const k_style = R"(
:root { color-scheme: dark; }
* { box-sizing: border-box; }
body { margin: 0; background: #1e1e1e; color: #e2e1df; font: 14px/1.5 Inter, Roboto, "Segoe UI", "Noto Sans",
  "DejaVu Sans", sans-serif; font-variant-numeric: tabular-nums; -webkit-print-color-adjust: exact;
  print-color-adjust: exact; }
main { max-width: 1136px; margin: 0 auto; padding: 40px 24px 64px; }
h1 { font-size: 28px; line-height: 1.2; font-weight: 600; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 18px; font-weight: 600; margin: 56px 0 4px; padding-top: 16px; border-top: 1px solid #343434; }
h3 { font-size: 14px; font-weight: 600; margin: 24px 0 4px; }
p { margin: 8px 0; max-width: 76ch; }
.dim, td small, th small { color: #a09f9d; }
.faint { color: #8a8988; }
small { font-size: 12px; font-weight: 400; }
a { color: #70a4de; text-decoration: none; }
.lead { font-size: 16px; line-height: 1.55; margin-top: 20px; }
ul.found { margin: 16px 0; padding: 12px 20px 12px 36px; background: #242424; border-left: 3px solid #70a4de;
  border-radius: 3px; max-width: none; }
ul.found li { margin: 4px 0; }
table { border-collapse: collapse; margin: 12px 0 8px; width: 100%; }
th { text-align: right; font-weight: 500; color: #a09f9d; font-size: 12px; padding: 4px 12px 6px;
  border-bottom: 1px solid #4a4a4a; vertical-align: bottom; }
td { text-align: right; padding: 5px 12px; border-bottom: 1px solid #2c2c2c; white-space: nowrap;
  vertical-align: baseline; }
th.l, td.l { text-align: left; }
td:first-child, th:first-child { padding-left: 0; }
td.wide { white-space: normal; min-width: 16em; }
tr.first td { border-top: 1px solid #4a4a4a; }
td.scene { font-weight: 600; }
.key { display: inline-block; width: 14px; height: 3px; border-radius: 1px; margin-right: 8px;
  vertical-align: 4px; }
.win { color: #70a4de; font-weight: 600; }
.noise { color: #8a8988; }
.bar { display: inline-block; height: 8px; border-radius: 1px; vertical-align: 1px; margin-right: 8px; }
td.index { text-align: left; width: 22%; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(480px, 1fr)); gap: 8px 24px;
  margin: 8px 0; }
figure { margin: 0; }
figcaption { font-size: 12px; color: #a09f9d; margin: 4px 0 0; }
svg { display: block; width: 100%; height: auto; font: 12px Inter, Roboto, "Segoe UI", "Noto Sans",
  "DejaVu Sans", sans-serif; font-variant-numeric: tabular-nums; }
.pictures { display: flex; flex-wrap: wrap; gap: 16px 24px; margin: 16px 0 8px; }
.pictures figure { flex: 0 0 auto; }
.pair { display: flex; gap: 4px; }
.pair img { display: block; image-rendering: pixelated; background: #141414; }
.ramp { display: flex; align-items: center; gap: 8px; font-size: 12px; color: #a09f9d; margin: 4px 0 0; }
.ramp span.scale { display: inline-block; width: 160px; height: 10px; border-radius: 1px; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 4px 24px; margin: 12px 0; }
dt { color: #a09f9d; } dd { margin: 0; overflow-wrap: anywhere; }
code { font: 12px/1.5 "DejaVu Sans Mono", monospace; color: #c8c7c5; }
.wrap { overflow-x: auto; }
.warn { color: #deb258; }
@media (max-width: 600px) { .plots { grid-template-columns: 1fr; } main { padding: 24px 12px; } }
)";

}  // namespace lucerna::bench
