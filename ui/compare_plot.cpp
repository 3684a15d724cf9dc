#include "compare_plot.h"

#include <fmt/format.h>

#include <algorithm>

#include "chart.h"

namespace lucerna::ui {
namespace {

CompareLine line_of(const stats::Ledger& ledger, double seconds, std::optional<double> error) {
  CompareLine line;
  for (const stats::Entry& e : ledger.entries())
    if (e.has_error && e.sum() > 0 && e.wall_s > 0) line.points.emplace_back(e.wall_s, e.sum());
  // The state when it was held.
  if (error && *error > 0 && seconds > 0 && (line.points.empty() || seconds > line.points.back().first))
    line.points.emplace_back(seconds, *error);
  return line;
}

/// Appends what a result took, and how far it is off.
std::string result_text(std::string text, const session::HeldPicture& p) {
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (!p.shows.empty()) add(p.shows + " only");
  if (p.seconds > 0) add(about_text(p.seconds));
  if (const std::string error = held_error_text(p); !error.empty()) add(error);
  return text;
}

}  // namespace

std::string held_error_text(const session::HeldPicture& p) {
  constexpr double k_least_former = 0.005;
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (p.filtered) {
    add(p.shown_error ? percent_text(*p.shown_error) + " off" : "");
    add("filtered");
    if (p.former > k_least_former) add(fmt::format("{:.0f} % former light", 100 * p.former));
  } else if (p.error && *p.error > 0) {
    add(percent_text(*p.error));
  }
  return text;
}

std::string held_mark(size_t index) { return std::string(1, static_cast<char>('A' + index)); }

std::vector<CompareLine> compare_lines(const commands::HeldResults& results, const session::Snapshot* live) {
  std::vector<CompareLine> lines;
  for (size_t i = 0; i < results.list().size(); ++i) {
    const commands::HeldResult& held = results.list()[i];
    CompareLine line = line_of(held.picture->ledger, held.picture->seconds, held.picture->error);
    if (line.points.empty()) continue;
    line.mark = held_mark(i), line.name = held.name, line.compared = &held == results.compared();
    lines.push_back(std::move(line));
  }
  if (!live || !live->accuracy) return lines;
  CompareLine line = line_of(live->accuracy->ledger, 0, {});
  line.name = "the live picture";
  if (!line.points.empty()) lines.push_back(std::move(line));
  return lines;
}

PlotRange compare_range(const std::vector<CompareLine>& lines) {
  if (lines.empty()) return {};
  double t_lo = 1e300, t_hi = 0, e_lo = 1e300, e_hi = 0;
  for (const CompareLine& line : lines)
    for (const auto& [seconds, error] : line.points) {
      t_lo = std::min(t_lo, seconds), t_hi = std::max(t_hi, seconds);
      e_lo = std::min(e_lo, error), e_hi = std::max(e_hi, error);
    }
  PlotRange range{nice_below(t_lo), nice_above(1.1 * t_hi), nice_below(0.9 * e_lo), nice_above(e_hi)};
  if (range.e_hi < 4 * range.e_lo) range.e_lo = nice_below(0.25 * range.e_hi);
  if (range.t_hi < 4 * range.t_lo) range.t_lo = nice_below(0.25 * range.t_hi);
  return range;
}

std::string held_text(const commands::HeldResult& held) {
  const session::HeldPicture& p = *held.picture;
  const std::string methods = session::methods_text(p.methods);
  std::string what = held.name;
  // A default name is the methods, perhaps with a number.
  if (!methods.empty() && !what.starts_with(methods)) what += ": " + methods;
  return result_text(what, p);
}

std::string live_text(const session::Snapshot& live) {
  session::HeldPicture p;
  for (size_t c = 0; c < p.methods.size(); ++c) p.methods[c] = live.components[c].solver;
  p.seconds = live.seconds, p.filtered = live.filtered > 0 || live.stale > 0, p.former = live.stale;
  if (live.shown_error) p.shown_error = live.shown_error->median;
  if (live.accuracy && !live.accuracy->ledger.entries().empty() &&
      live.accuracy->ledger.entries().back().has_error)
    p.error = live.accuracy->ledger.entries().back().sum();
  return result_text(session::methods_text(p.methods), p);
}

}  // namespace lucerna::ui
