// The Accuracy panel: error over time, the cost of a smaller error, and earlier renders for comparison.
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "accuracy_plot.h"
#include "chart.h"
#include "shown_text.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using session::Accuracy;

constexpr ImU32 k_sum = colour::text;
/// The error as seen, of the median tile, of the worst tenth of the tiles, of the mean; and the parts of the
/// error as seen.
constexpr std::array<ImU32, 7> k_noise_ink = {k_sum,
                                              colour::grey(132),
                                              colour::grey(164),
                                              colour::text_dim,
                                              colour::text_dim,
                                              colour::text_dim,
                                              colour::text_dim};

/// Lines of noise as seen: the sum, the components, then the layers by path expressions.
size_t line_count(const Accuracy& a) { return stats::k_layers + a.ledger.layers().size(); }
ImU32 layer_ink(size_t line) {
  if (line >= stats::k_layers) return colour::own_layer[(line - stats::k_layers) % colour::own_layer.size()];
  return line == 0 ? k_sum : colour::component[line - 1];
}
std::string layer_name(const Accuracy& a, size_t line) {
  return line < stats::k_layers ? stats::k_layer_names[line] : a.ledger.layers()[line - stats::k_layers];
}
/// That of a line in an entry, as seen or of the mean; 0: unknown.
template <class Errors>
double error_of(const Errors& errors, size_t line) {
  if (line < stats::k_layers) return errors.error[line];
  return line - stats::k_layers < errors.layers.size() ? errors.layers[line - stats::k_layers] : 0;
}

struct Plot {
  Area area;
  LogAxis x, y;
  ImVec2 at(double seconds, double error) const { return {x.at(seconds), y.at(error)}; }
};

/// Points of a line of the plot; values of 0 are unknown and skipped.
template <class Value>
std::vector<ImVec2> line_points(const Plot& plot, const Accuracy& a, const Value& value) {
  std::vector<ImVec2> points;
  const auto& lines = a.ledger.entries();
  for (size_t i = 0; i < lines.size(); ++i)
    if (const double e = value(i); e > 0 && lines[i].wall_s > 0)
      points.push_back(plot.at(lines[i].wall_s, e));
  return points;
}

std::vector<ImVec2> error_points(const Plot& plot, const Accuracy& a, size_t layer) {
  return line_points(plot, a, [&](size_t i) {
    const stats::Entry& e = a.ledger.entries()[i];
    return layer == 0 && e.error[0] > 0 ? e.sum() : error_of(e, layer);
  });
}

/// The part of the sum's error that more samples do not reduce.
std::vector<ImVec2> floor_points(const Plot& plot, const Accuracy& a) {
  return line_points(plot, a, [&](size_t i) { return a.ledger.entries()[i].floor(); });
}

/// The median tile's error, or that of the worst tenth of the tiles.
std::vector<ImVec2> tile_points(const Plot& plot, const Accuracy& a, double stats::Entry::*noise) {
  return line_points(plot, a, [&](size_t i) { return a.ledger.entries()[i].*noise; });
}

void stroke(ImDrawList* list, const std::vector<ImVec2>& points, ImU32 ink, float width) {
  if (points.size() == 1) list->AddCircleFilled(points[0], width, ink, 8);
  if (points.size() > 1) list->AddPolyline(points.data(), static_cast<int>(points.size()), ink, 0, width);
}

float distance_to(const ImVec2& p, const std::vector<ImVec2>& points) {
  float best = 1e9f;
  for (size_t i = 0; i < points.size(); ++i) {
    const ImVec2 a = points[i > 0 ? i - 1 : 0], b = points[i];
    const ImVec2 c = ImLineClosestPoint(a, b, p);
    best = std::min(best, std::hypot(c.x - p.x, c.y - p.y));
  }
  return best;
}

void draw_axes(ImDrawList* list, const Plot& plot) {
  ImFont* font = theme().fonts.small;
  const Area& a = plot.area;
  for (const Tick& t : ticks(plot.x, Unit::seconds, px(46))) {
    const float x = std::floor(plot.x.at(t.value));
    list->AddLine({x, a.lo.y}, {x, a.hi.y}, colour::grey(t.labelled ? 48 : 40));
    if (!t.labelled) continue;
    const std::string text = tick_text(t.value, Unit::seconds);
    const float half = 0.5f * text_width(text, font);
    const float middle = std::clamp(x, a.lo.x + half - px(8), a.hi.x - half + px(4));
    draw_text(list, {middle - half - 1, a.hi.y + px(1)}, {middle + half + px(2), a.hi.y + px(15)}, text,
              colour::text_faint, Align::left, font);
  }
  for (const Tick& t : ticks(plot.y, Unit::relative, px(17))) {
    const float y = std::floor(plot.y.at(t.value));
    list->AddLine({a.lo.x, y}, {a.hi.x, y}, colour::grey(t.labelled ? 48 : 40));
    if (!t.labelled || y > a.hi.y - px(5)) continue;
    draw_text(list, {a.lo.x - px(44), y - px(8)}, {a.lo.x - px(6), y + px(7)},
              tick_text(t.value, Unit::relative), colour::text_faint, Align::right, font);
  }
}

/// The target's line: shows its cost, and can be dragged. In adaptive sampling it is the setting, in uniform
/// sampling a what-if value. The range stays fixed during a drag. Returns true if the pointer is over the
/// line or drags it.
bool drag_target(Actions& actions, AccuracyView& view, const Plot& plot, const Accuracy& a, double target,
                 const PlotRange& range) {
  const float y = std::floor(plot.y.at(target));
  const bool inside = y >= plot.area.lo.y && y <= plot.area.hi.y;
  if (!inside && !view.held_range) return false;
  ImGui::SetCursorScreenPos({plot.area.lo.x, y - px(5)});
  ImGui::InvisibleButton("##target", {plot.area.width(), px(11)});
  const bool held = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  if (ImGui::IsItemActivated()) view.held_offset = ImGui::GetIO().MousePos.y - y, view.held_range = range;
  if (!held) view.held_range.reset();
  if (held) {
    const float place =
        std::clamp(ImGui::GetIO().MousePos.y - view.held_offset, plot.area.lo.y, plot.area.hi.y);
    const double wanted = snapped_target(plot.y.value(place));
    if (wanted != target && ImGui::GetIO().MouseDelta.y != 0) {
      const std::string text = fmt::format("{:.4g}", wanted);
      if (a.adaptive)
        actions.act("set", "sampling.target_error", text);
      else
        actions.act("accuracy.what_if", text);
    }
  }
  if (held || hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNS);
  if (hovered && !held)
    tooltip(a.adaptive
                ? "Target error of every tile. Drag to change it; samples are kept."
                : "Drag to see the cost of another error. In adaptive sampling this line is the target.");
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImU32 ink = held || hovered ? colour::accent : colour::with_alpha(colour::accent, 0.75f);
  list->AddLine({plot.area.lo.x, y}, {plot.area.hi.x, y}, ink);
  const std::string tag = tick_text(target, Unit::relative);
  ImFont* font = theme().fonts.small;
  const float w = text_width(tag, font) + px(10);
  const ImVec2 lo(plot.area.hi.x - w, y - px(8)), hi(plot.area.hi.x, y + px(8));
  list->AddRectFilled(lo, hi, ink, px(3));
  draw_text(list, lo, hi, tag, colour::grey(24), Align::centre, font);
  return held || hovered;
}

/// The forecast: a fan from the line's present end to its intersection with the target.
void draw_forecast(ImDrawList* list, const Plot& plot, const Accuracy& a, double target,
                   const std::optional<stats::Band>& band) {
  const auto from = present(a);
  if (!band || !from || from->error <= target) return;
  const ImVec2 tip = plot.at(from->seconds, from->error);
  const ImVec2 low = plot.at(band->low, target), high = plot.at(band->high, target);
  list->AddTriangleFilled(tip, low, high, colour::with_alpha(k_sum, 0.16f));
  dashed_line(list, {tip, plot.at(band->middle, target)}, colour::with_alpha(k_sum, 0.55f), px(3), px(3), 1);
}

void tooltip_rows(const std::vector<std::pair<std::string, ImU32>>& rows) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(10), px(7)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(3));
  ImGui::BeginTooltip();
  for (const auto& [text, ink] : rows) label(text, ink, theme().fonts.small);
  ImGui::EndTooltip();
  ImGui::PopStyleVar(2);
}

/// The bias of a layer, which its line does not include; layer 0 is the sum.
std::string bias_text(const Accuracy& a, size_t layer) {
  std::string unknown;
  double most = 0;
  for (size_t c = 0; c < a.bias.size(); ++c) {
    if (layer > 0 ? c + 1 != layer : a.error()[c + 1] <= 0) continue;
    if (!a.bias[c])
      unknown += fmt::format("{}{}", unknown.empty() ? "" : ", ", session::k_component_names[c]);
    else
      most = std::max(most, std::abs(*a.bias[c]));
  }
  if (!unknown.empty()) return fmt::format("Bias unknown: {}", unknown);
  return most > 0 ? fmt::format("Bias in addition to noise: {}", percent_text(most))
                  : "No bias: the error is noise only";
}

std::string run_figures(const Accuracy& a, size_t line) {
  const stats::Entry& e = a.ledger.entries()[line];
  return fmt::format("{} \xC2\xB7 {} samples per pixel \xC2\xB7 {} rays", seconds_text(e.wall_s),
                     mean_text(e.samples), count_text(static_cast<double>(e.rays)));
}

/// Shows what is under the pointer: a line's values at that time, or how an earlier run differs.
void hover(const AccuracyView& view, const Plot& plot, const Accuracy& a) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (!ImGui::IsMouseHoveringRect(plot.area.lo, plot.area.hi) || !ImGui::IsWindowHovered()) return;
  const float reach = px(9);
  struct Found {
    float distance;
    std::string name;
    ImU32 ink;
    std::vector<ImVec2> points;
    const Run* run = nullptr;
    std::optional<size_t> layer{};  ///< its component's layer
  } best{reach, "", 0, {}, nullptr, {}};
  const auto look = [&](std::vector<ImVec2> points, const std::string& name, ImU32 ink,
                        const Run* run = nullptr, std::optional<size_t> layer = {}) {
    const float d = distance_to(mouse, points);
    if (d < best.distance) best = {d, name, ink, std::move(points), run, layer};
  };
  const auto& lines = a.ledger.entries();
  for (size_t k = 0; k < line_count(a); ++k)
    look(error_points(plot, a, k),
         k == 0
             ? std::string(looks_up(lines.back()) ? "error as seen (estimated)" : "noise as seen (estimated)")
             : fmt::format("{}, noise as seen (estimated)", layer_name(a, k)),
         layer_ink(k), nullptr, k);
  const char* const what = looks_up(lines.back()) ? "error" : "noise";
  look(tile_points(plot, a, &stats::Entry::tile_median),
       fmt::format("{} of the median tile (estimated)", what), k_noise_ink[1]);
  look(tile_points(plot, a, &stats::Entry::tile_worst_tenth),
       fmt::format("{} of the worst tenth of the tiles (estimated)", what), k_noise_ink[2]);
  look(line_points(plot, a, [&](size_t i) { return lines[i].truth ? (*lines[i].truth)[0] : 0.0; }),
       "sum, true error of the mean against " + a.reference, k_sum);
  if (a.adaptive) look(line_points(plot, a, [&](size_t i) { return a.hardest[i]; }), "hardest tile", k_sum);
  look(floor_points(plot, a), "noise of records and bias of lookups, as seen: the limit of more samples",
       colour::text_dim);
  for (const Run& run : view.runs.earlier())
    look(error_points(plot, *run.accuracy, 0), "earlier render, noise as seen (estimated)", colour::text_dim,
         &run);
  if (best.points.empty()) return;
  // The measured point nearest to the pointer.
  const auto near = std::min_element(best.points.begin(), best.points.end(), [&](ImVec2 p, ImVec2 q) {
    return std::abs(p.x - mouse.x) < std::abs(q.x - mouse.x);
  });
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (best.run) stroke(list, best.points, colour::text_dim, px(1.5f));
  list->AddCircleFilled(*near, px(3), best.ink, 12);
  const Accuracy& chosen = best.run ? *best.run->accuracy : a;
  // The ledger entry of that point, by its time.
  const double seconds = plot.x.value(near->x);
  size_t line = 0;
  for (size_t i = 0; i < chosen.ledger.entries().size(); ++i)
    if (std::abs(std::log(chosen.ledger.entries()[i].wall_s / seconds)) <
        std::abs(std::log(chosen.ledger.entries()[line].wall_s / seconds)))
      line = i;
  std::string name = best.name;
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  std::vector<std::pair<std::string, ImU32>> rows{
      {fmt::format("{}: {}", name, percent_text(plot.y.value(near->y))), colour::text},
      {run_figures(chosen, line), colour::text_dim}};
  const stats::Entry& then = chosen.ledger.entries()[line];
  if (best.layer && *best.layer >= stats::k_layers)
    rows.emplace_back(fmt::format("A layer. 100 %: as much as the picture's light there; of the mean {}",
                                  percent_text(error_of(then.of_mean, *best.layer))),
                      colour::text_dim);
  else if (best.layer && *best.layer > 0)
    rows.emplace_back(
        fmt::format("{:.0f} % of the noise as seen (squared); of the mean {}",
                    100 * then.share(int(*best.layer) - 1), percent_text(then.of_mean.error[*best.layer])),
        colour::text_dim);
  else if (best.layer)
    rows.emplace_back(fmt::format("Of the mean {}", percent_text(then.of_mean.sum())), colour::text_dim);
  if (best.layer == size_t{0} && looks_up(then))
    rows.emplace_back(
        fmt::format("Paths {}{}, bias of lookups {} (added)", percent_text(then.error[0]),
                    then.records > 0 ? fmt::format(", records {} (in quadrature)", percent_text(then.records))
                                     : std::string(),
                    percent_text(then.interpolation)),
        colour::text_dim);
  else if (best.layer && *best.layer < stats::k_layers)
    rows.emplace_back(bias_text(a, *best.layer), colour::text_dim);
  if (best.run) {
    const std::vector<std::string> other = differences(*best.run, view.runs.current());
    if (other.empty()) rows.emplace_back("Same settings", colour::text_dim);
    for (const std::string& row : other) rows.emplace_back(row, colour::text);
  }
  tooltip_rows(rows);
}

/// The error figures, each in its line's colour; a tooltip explains each.
void noise_row(const Accuracy& a, const ImVec2& lo, float right) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImFont* font = theme().fonts.small;
  const stats::Entry& line = a.ledger.entries().back();
  const std::vector<ErrorFigure> figures = error_figures(line);
  const auto texts = [&](bool whole) {
    std::vector<std::string> all;
    for (const ErrorFigure& f : figures)
      all.push_back(fmt::format("{} {}", whole ? f.name : f.short_name,
                                padded(f.value > 0 ? percent_text(f.value) : "\xE2\x80\x93", 6)));
    return all;
  };
  // The samples' noise is the whole error, or a part of it.
  const std::string head = looks_up(line) ? "Error" : "Noise";
  const float head_width = text_width(head, font) + px(6), space = px(10);
  const auto width = [&](const std::vector<std::string>& all) {
    float sum = head_width - space;
    for (const std::string& text : all) sum += text_width(text, font) + space;
    return sum;
  };
  const bool whole = lo.x + width(texts(true)) <= right;
  const std::vector<std::string> shown = texts(whole);
  draw_text(list, lo, {lo.x + head_width, lo.y + px(16)}, head, colour::text_dim, Align::left, font);
  float x = lo.x + head_width;
  for (size_t i = 0; i < shown.size(); ++i) {
    const float w = text_width(shown[i], font);
    if (x + w > right) return;
    draw_text(list, {x, lo.y}, {x + w + 1, lo.y + px(16)}, shown[i], k_noise_ink[i], Align::left, font);
    ImGui::SetCursorScreenPos({x, lo.y});
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##noise", {w, px(16)});
    ImGui::PopID();
    tooltip(fmt::format("{} {}, estimated. {}", head, figures[i].name, figures[i].help));
    x += w + space;
  }
}

/// Names of the lines in their colours.
void line_names(const AccuracyView& view, const Accuracy& a, const ImVec2& lo, float right) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImFont* font = theme().fonts.small;
  float x = lo.x;
  const auto put = [&](const std::string& text, ImU32 ink, float after) {
    const float w = text_width(text, font);
    if (x + w > right) return;
    draw_text(list, {x, lo.y}, {x + w + 1, lo.y + px(16)}, text, ink, Align::left, font);
    x += w + px(after);
  };
  put("Lines:", colour::text_dim, 6);
  put("as seen", k_noise_ink[0], 8);
  put("median tile", k_noise_ink[1], 8);
  put("worst tenth", k_noise_ink[2], 8);
  if (looks_up(a.ledger.entries().back())) put("- - lookups", colour::text_dim, 8);
  if (a.adaptive) put("- - hardest tile", colour::text_dim, 8);
  if (!a.reference.empty())
    put(a.reference_applies ? "\xC2\xB7 \xC2\xB7 \xC2\xB7 true error of the mean"
                            : "reference of another view",
        a.reference_applies ? colour::text : colour::warning, 8);
  for (size_t k = stats::k_layers; k < line_count(a); ++k)
    if (error_of(a.ledger.entries().back(), k) > 0) put(layer_name(a, k), layer_ink(k), 8);
  // The components come last: without room for them, their colours are known from the panel on the left.
  const auto error = a.error();
  for (const size_t c : k_components)
    if (error[c + 1] > 0) put(session::k_component_names[c], colour::component[c], 8);
  if (!view.runs.earlier().empty())
    put(fmt::format("{} earlier", view.runs.earlier().size()), colour::text_faint, 8);
}

void body(Actions& actions, AccuracyView& view, const Area& area, const Accuracy& a, double seconds) {
  const double target = view.target();
  const std::optional<stats::Band> band = view.forecast();
  const PlotRange range =
      view.held_range ? *view.held_range : plot_range(a, view.runs.earlier(), target, band, seconds);
  Plot plot;
  plot.area = {{area.lo.x + px(56), area.lo.y + px(40)}, {area.hi.x - px(16), area.hi.y - px(18)}};
  if (plot.area.width() < px(60) || plot.area.height() < px(30)) return;
  plot.x = {range.t_lo, range.t_hi, plot.area.lo.x, plot.area.hi.x};
  plot.y = {range.e_lo, range.e_hi, plot.area.hi.y, plot.area.lo.y};
  ImDrawList* list = ImGui::GetWindowDrawList();
  draw_axes(list, plot);
  noise_row(a, {area.lo.x + px(12), area.lo.y}, area.hi.x - px(12));
  line_names(view, a, {area.lo.x + px(12), area.lo.y + px(16)}, area.hi.x - px(12));

  list->PushClipRect(plot.area.lo, plot.area.hi, true);
  for (const Run& run : view.runs.earlier())
    stroke(list, error_points(plot, *run.accuracy, 0), colour::grey(92), 1);
  draw_forecast(list, plot, a, target, band);
  for (size_t k = line_count(a); k-- > 1;) stroke(list, error_points(plot, a, k), layer_ink(k), px(1.25f));
  const auto& lines = a.ledger.entries();
  stroke(list, tile_points(plot, a, &stats::Entry::tile_median), k_noise_ink[1], px(1));
  stroke(list, tile_points(plot, a, &stats::Entry::tile_worst_tenth), k_noise_ink[2], px(1));
  dashed_line(list, floor_points(plot, a), colour::text_dim, px(2), px(4), px(1.25f));
  stroke(list, error_points(plot, a, 0), k_sum, px(2));
  if (a.adaptive)
    dashed_line(list, line_points(plot, a, [&](size_t i) { return a.hardest[i]; }),
                colour::with_alpha(k_sum, 0.7f), px(5), px(4), px(1.25f));
  dashed_line(list,
              line_points(plot, a, [&](size_t i) { return lines[i].truth ? (*lines[i].truth)[0] : 0.0; }),
              k_sum, px(1.5f), px(3), px(1.5f));
  // The present time.
  if (seconds > 0) {
    const float x = std::floor(plot.x.at(seconds));
    list->AddLine({x, plot.area.lo.y}, {x, plot.area.hi.y}, colour::grey(104));
    list->AddTriangleFilled({x - px(4), plot.area.lo.y}, {x + px(4), plot.area.lo.y},
                            {x, plot.area.lo.y + px(5)}, colour::text_dim);
  }
  list->PopClipRect();

  if (!drag_target(actions, view, plot, a, target, range)) hover(view, plot, a);
}

/// Lines shown before the first samples: the error of the preview, and the progress of preparation.
std::vector<std::string> early_texts(const session::Snapshot& s, double target) {
  std::vector<std::string> texts;
  if (const std::vector<std::string> shown = shown_texts(s); !shown.empty())
    texts.push_back("Displayed picture: " + shown.front() + usable_text(s));
  if (!s.preparing.empty())
    texts.push_back(s.preparing_left ? fmt::format("{}; {:.0f} % done, about {} left", s.preparing,
                                                   100 * s.preparing_done, about_text(*s.preparing_left))
                                     : s.preparing);
  if (s.preparing_left && s.path_pace && s.path_pace->noise > 0) {
    const double paths = s.path_pace->seconds_to(target);
    texts.push_back(fmt::format("Path tracing would take about {} to reach {}{}", about_text(paths),
                                tick_text(target, Unit::relative),
                                paths < s.seconds + *s.preparing_left ? ", which is faster" : ""));
  }
  texts.push_back(s.samples == 0 ? "No samples yet" : "Too few samples to estimate their noise");
  return texts;
}

void draw_early(ImDrawList* list, const Area& inside, const session::Snapshot& s, double target) {
  float y = inside.lo.y;
  for (const std::string& text : early_texts(s, target))
    for (const std::string& line : wrapped(text, inside.width() - px(24))) {
      draw_text(list, {inside.lo.x + px(12), y}, {inside.hi.x - px(12), y + px(20)}, line, colour::text_dim);
      y += px(20);
    }
}

}  // namespace

void draw_accuracy(Actions& actions, const commands::OpenScene& open, AccuracyView& view, bool expanded,
                   const Area& area) {
  begin_panel("##accuracy", area, colour::panel, false);
  const float left = panel_heading("ACCURACY", area);
  const Accuracy* a = open.snapshot ? open.snapshot->accuracy.get() : nullptr;
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (a && open.scene) {
    const float right = area.hi.x - px(16), room = right - left - px(16);
    std::vector<std::string> texts = target_texts(*a, view.target(), view.forecast(), open.snapshot->seconds);
    // The displayed picture's error first, if there is room for both.
    if (const std::vector<std::string> shown = shown_texts(*open.snapshot); !shown.empty())
      texts.insert(texts.begin(), fmt::format("Displayed: {}  ·  samples: {}", shown.front(), texts.front()));
    for (const std::string& text : texts) {
      if (text_width(text, theme().fonts.small) > room) continue;
      draw_text(list, {left, area.lo.y}, {right, area.lo.y + px(k_folded_bottom)}, text, colour::text,
                Align::right, theme().fonts.small);
      break;
    }
  }
  if (expanded) {
    const Area inside{{area.lo.x, area.lo.y + px(k_folded_bottom)}, area.hi};
    if (a && open.scene && !a->ledger.entries().empty())
      body(actions, view, inside, *a, open.snapshot->seconds);
    else if (open.snapshot && open.scene)
      draw_early(list, inside, *open.snapshot, view.target());
  }
  ImGui::End();
}

}  // namespace lucerna::ui
