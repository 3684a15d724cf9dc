// The panel of a solver, on the right in the scene's place: its report (solvers/report.h), then its options.
// Also the tabs of the right panel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "panel_block.h"
#include "solvers/registry.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using solvers::PanelItem;
using solvers::PanelSection;
using solvers::Report;
using solvers::SolverInfo;

constexpr float k_tabs_height = 32;
constexpr float k_narrow = 236;  // width of a panel's content below which words are shorter and columns fewer

bool narrow() { return ImGui::CalcItemWidth() < px(k_narrow); }

/// A help sentence with its key.
std::string with_key(const std::string& help, char shortcut) {
  return shortcut ? fmt::format("{} {}.", help, shortcut) : help;
}

/// Draws the items of a section. Controls have ids by meaning, so an item that appears or disappears above
/// does not lose a press.
class Items {
 public:
  Items(Controls& controls, const SolverInfo& solver) : controls_(controls), solver_(solver) {}

  void operator()(const solvers::ValueRow& row) {
    value_row(row.name, row.value, row.help, tone_ink(row.tone));
  }
  void operator()(const solvers::Paragraph& p) { paragraph(p.text, tone_ink(p.tone)); }
  void operator()(const solvers::Gap& g) { gap(g.size); }

  void operator()(const solvers::OptionRow& row) {
    if (const OptionInfo* option = plan::find_option(row.key))
      option_control(controls_, row.key, option_label(*option));
  }

  void operator()(const solvers::ChoiceButtons& choice) {
    const OptionInfo* option = plan::find_option(choice.key);
    if (!option || option->choices.empty()) return;
    const std::vector<std::string>& labels = narrow() ? choice.short_labels : choice.labels;
    const float each = part_width(option->choices.size());
    for (size_t i = 0; i < option->choices.size(); ++i) {
      const std::string& value = option->choices[i];
      if (i > 0) ImGui::SameLine(0, px(4));
      if (button(("##" + choice.key + value).c_str(), i < labels.size() ? labels[i] : value,
                 controls_.open.setting(choice.key) == value, each))
        controls_.act("set", choice.key, value);
      tooltip(choice.help.empty() ? option->help : option->help + " " + choice.help);
    }
  }

  void operator()(const solvers::CommandButtons& row) {
    const float each = part_width(row.buttons.size());
    for (size_t i = 0; i < row.buttons.size(); ++i) {
      const solvers::CommandButtons::Button& b = row.buttons[i];
      const solvers::CommandInfo* command = solvers::find_command(solver_, b.command);
      if (!command) continue;
      if (i > 0) ImGui::SameLine(0, px(4));
      ImGui::BeginDisabled(!b.enabled);
      if (button(("##" + command->name).c_str(), command->label, false, each))
        controls_.act(solver_.name + "." + command->name);
      tooltip(b.enabled ? with_key(b.help, command->shortcut) : b.help);
      ImGui::EndDisabled();
    }
  }

  void operator()(const solvers::ViewButtons& row) {
    const float each = part_width(3);
    size_t drawn = 0;
    for (const std::string& key : row.options) {
      const auto view = std::find_if(solver_.views.begin(), solver_.views.end(),
                                     [&](const solvers::ViewInfo& v) { return v.option == key; });
      const OptionInfo* option = plan::find_option(key);
      if (view == solver_.views.end() || !option) continue;
      if (drawn++ % 3 > 0) ImGui::SameLine(0, px(4));
      if (button(("##" + key).c_str(), view->label, controls_.view_on(*view), each))
        controls_.turn_view(*view);
      tooltip(with_key(option->help, view->shortcut));
    }
  }

  void operator()(const solvers::Histogram& histogram);
  void operator()(const solvers::Table& table);
  void operator()(const solvers::Parts& parts);
  void operator()(const solvers::StepStrip& strip);

 private:
  /// Width of one of n buttons side by side.
  static float part_width(size_t n) {
    const float gaps = px(4) * static_cast<float>(n - 1);
    return std::floor((ImGui::CalcItemWidth() - gaps) / static_cast<float>(n));
  }

  Controls& controls_;
  const SolverInfo& solver_;
};

void Items::operator()(const solvers::Histogram& histogram) {
  if (histogram.columns.empty()) return;
  gap(8);
  const float width = ImGui::CalcItemWidth(), height = px(36);
  const float pitch = width / static_cast<float>(histogram.columns.size());
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + height);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddLine({lo.x, hi.y}, hi, colour::hairline);
  ImGui::PushID("histogram");
  for (size_t i = 0; i < histogram.columns.size(); ++i) {
    const solvers::Histogram::Column& column = histogram.columns[i];
    const float x = std::floor(lo.x + pitch * static_cast<float>(i)), right = std::floor(x + pitch) - 1;
    const float top = column.height > 0 ? std::min(hi.y - 1, hi.y - height * column.height) : hi.y;
    list->AddRectFilled({x, top}, {right, hi.y}, ink(column.ink));
    if (column.lower > 0)
      list->AddRectFilled({x, hi.y - (hi.y - top) * column.lower}, {right, hi.y}, ink(column.lower_ink));
    if (i % 4 == 0)
      draw_text(list, {x - pitch, hi.y + px(1)}, {x + 2 * pitch, hi.y + px(15)}, column.label,
                colour::text_faint, Align::centre, theme().fonts.small);
    ImGui::SetCursorScreenPos({x, lo.y});
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##column", {std::max(1.0f, pitch), height});
    tooltip(column.help);
    ImGui::PopID();
  }
  ImGui::PopID();
  ImGui::SetCursorScreenPos({lo.x, hi.y + px(18)});
}

/// Greys for parts, as for stages; host parts are bluish.
ImU32 part_ink(size_t part, bool host) {
  static constexpr std::array<int, 7> k_greys{178, 140, 160, 118, 152, 98, 132};
  const int v = k_greys[part % k_greys.size()];
  return host ? IM_COL32(v * 2 / 3, v * 5 / 6, v, 255) : colour::grey(v);
}

void Items::operator()(const solvers::Parts& all) {
  std::vector<Part> bar;
  for (size_t i = 0; i < all.parts.size(); ++i)
    bar.push_back({all.parts[i].share, part_ink(i, all.parts[i].host)});
  stacked_bar(bar, 8, ImGui::CalcItemWidth());
  gap(6);
  const float width = ImGui::CalcItemWidth(), row = px(18);
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImFont* font = theme().fonts.small;
  ImGui::PushID("parts");
  for (size_t i = 0; i < all.parts.size(); ++i) {
    const solvers::Parts::Part& part = all.parts[i];
    const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + row);
    const float middle = std::floor(0.5f * (lo.y + hi.y));
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##part", {width, row});
    tooltip(part.help);
    ImGui::PopID();
    list->AddRectFilled({lo.x, middle - px(4)}, {lo.x + px(8), middle + px(4)}, part_ink(i, part.host),
                        px(2));
    draw_text(list, {lo.x + px(14), lo.y}, hi, part.name, colour::text_dim, Align::left, font);
    draw_text(list, lo, {hi.x - px(56), hi.y}, part.value, colour::text, Align::right, font);
    draw_text(list, lo, hi, fmt::format("{:.1f} %", 100 * part.share), colour::text_dim, Align::right, font);
    ImGui::SetCursorScreenPos({lo.x, hi.y});
  }
  ImGui::PopID();
}

void Items::operator()(const solvers::Table& table) {
  const float width = ImGui::CalcItemWidth(), row = px(18), first = px(30);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const auto dropped = [&](size_t column) { return narrow() && table.droppable == column; };
  size_t shown = 0;
  for (size_t i = 1; i < table.columns.size(); ++i) shown += !dropped(i);
  const float each = std::floor((width - first) / static_cast<float>(std::max<size_t>(shown, 1)));
  const auto cells = [&](const ImVec2& lo, const std::vector<std::string>& texts, ImU32 colour) {
    float right = lo.x + first;
    for (size_t i = 0; i < texts.size(); ++i) {
      if (i == 0) {
        draw_text(list, {lo.x + px(14), lo.y}, {right, lo.y + row}, texts[i], colour, Align::left,
                  theme().fonts.small);
      } else if (!dropped(i)) {
        right += each;
        draw_text(list, {right - each, lo.y}, {right, lo.y + row}, texts[i], colour, Align::right,
                  theme().fonts.small);
      }
    }
  };
  const ImVec2 head = ImGui::GetCursorScreenPos();
  cells(head, table.columns, colour::text_faint);
  ImGui::SetCursorScreenPos({head.x, head.y + row});
  ImGui::PushID("table");
  for (size_t i = 0; i < table.rows.size(); ++i) {
    const solvers::Table::Row& r = table.rows[i];
    const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + row);
    const float middle = std::floor(0.5f * (lo.y + hi.y));
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##row", {width, row});
    tooltip(r.help);
    ImGui::PopID();
    if (r.bar > 0)
      list->AddRectFilled({lo.x + first, lo.y + px(2)},
                          {lo.x + first + (width - first) * r.bar, hi.y - px(2)}, colour::field, px(2));
    if (r.ink)
      list->AddRectFilled({lo.x, middle - px(4)}, {lo.x + px(8), middle + px(4)}, ink(*r.ink), px(2));
    cells(lo, r.cells, tone_ink(r.tone));
    ImGui::SetCursorScreenPos({lo.x, hi.y});
  }
  ImGui::PopID();
}

/// A row of steps: the completed ones, and the last one.
void Items::operator()(const solvers::StepStrip& strip) {
  const int n = static_cast<int>(strip.steps.size());
  const float width = ImGui::CalcItemWidth(), height = px(20);
  // The space beyond the names is distributed. Without room for all names only the current step is named, and
  // the others share the rest.
  ImFont* font = theme().fonts.small;
  const float gaps = px(2) * static_cast<float>(n - 1);
  float left = width - gaps;
  for (const solvers::StepStrip::Step& step : strip.steps) left -= text_width(step.name, font);
  const float named = strip.last >= 0 && strip.last < n
                          ? text_width(strip.steps[static_cast<size_t>(strip.last)].name, font) + px(8)
                          : 0;
  const ImVec2 lo = ImGui::GetCursorScreenPos();
  float x = lo.x;
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImGui::PushID("strip");
  for (int i = 0; i < n; ++i) {
    const solvers::StepStrip::Step& step = strip.steps[static_cast<size_t>(i)];
    const bool now = i == strip.last, over = i < strip.last;
    const float end = x + (left >= 0 ? text_width(step.name, font) + left / static_cast<float>(n)
                           : now     ? named
                                     : (width - gaps - named) / static_cast<float>(n - (named > 0)));
    const ImVec2 a(std::floor(x), lo.y), b(std::floor(end), lo.y + height);
    x = end + px(2);
    ImGui::SetCursorScreenPos(a);
    ImGui::PushID(i);
    ImGui::InvisibleButton("##step", {std::max(1.0f, b.x - a.x), height});
    tooltip(step.help);
    ImGui::PopID();
    list->AddRectFilled(a, b, now ? colour::accent_dim : over ? colour::fill : colour::field, px(2));
    if (now) list->AddRectFilled({a.x, b.y - px(2)}, b, colour::accent, px(1));
    if (left < 0 && !now) continue;
    draw_text(list, a, b, step.name,
              now    ? colour::text
              : over ? colour::text_dim
                     : colour::text_faint,
              Align::centre, font);
  }
  ImGui::PopID();
  ImGui::SetCursorScreenPos({lo.x, lo.y + height + px(6)});
}

/// A section of the panel with the content that `draw` draws.
template <class Draw>
void block(Controls& controls, const std::string& title, const std::string& note, const Draw& draw) {
  panel_block(controls, title.c_str(), true, note, 10, draw);
}

/// The components that a solver can compute completely, as words.
std::vector<std::string> served(const SolverInfo& solver) {
  std::vector<std::string> names;
  for (size_t c = solver.primary_part.empty() ? 0 : 1; c < solver.serves.size(); ++c)
    if (solver.serves[c]) names.push_back(session::k_component_names[c]);
  return names;
}

std::string joined(const std::vector<std::string>& names, const std::string& head = "") {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + head + names[i];
  return text;
}

/// A solver that is not used: how to use it.
void unused(Controls& controls, const SolverInfo& solver) {
  paragraph(fmt::format("No component is computed by {}.", solver.title));
  gap(8);
  const std::vector<std::string> names = served(solver);
  if (button("##use", fmt::format("Use it for {} light", joined(names)), false, ImGui::CalcItemWidth()))
    for (const std::string& name : names) controls.act("set", "components." + name, solver.name);
  tooltip(fmt::format("Sets {} to {}; the Light panel sets each separately.", joined(names, "components."),
                      solver.name));
}

/// Options with a control elsewhere in the panel.
std::set<std::string> placed(const SolverInfo& solver, const Report* report) {
  std::set<std::string> keys;
  for (const solvers::ViewInfo& view : solver.views) keys.insert(view.option);
  if (!report) return keys;
  for (const PanelSection& section : report->sections)
    for (const PanelItem& item : section.items) {
      if (const auto* row = std::get_if<solvers::OptionRow>(&item)) keys.insert(row->key);
      if (const auto* choice = std::get_if<solvers::ChoiceButtons>(&item)) keys.insert(choice->key);
    }
  return keys;
}

void options(Controls& controls, const SolverInfo& solver, const Report* report) {
  const std::set<std::string> elsewhere = placed(solver, report);
  // Other options control how a view is drawn, and are shown beside that view.
  for (const OptionInfo& option : solver.options)
    if (option.key.starts_with(solver.name + ".") && option.type != OptionType::text &&
        !elsewhere.contains(option.key))
      option_control(controls, option.key, option_label(option));
}

std::string capitals(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

Area draw_side_tabs(Actions& actions, const std::string& side, bool paths, bool compare, bool expanded,
                    const Area& area) {
  struct Tab {
    std::string side, label, help;
  };
  std::vector<Tab> tabs{{k_scene_side, "Scene", "Cameras, lights, environment, materials."}};
  for (const SolverInfo* solver : solvers::registered())
    if (solver->has_panel()) tabs.push_back({solver->name, solver->label, panel_help(*solver) + " K."});
  if (paths) tabs.push_back({k_paths_side, "Paths", "Paths of a pixel, and what the noise comes from."});
  if (compare) tabs.push_back({k_compare_side, "Compare", "Held results, and the picture against them."});
  if (!expanded) {
    begin_panel("##side_folded", area, colour::panel, false);
    const auto shown = std::find_if(tabs.begin(), tabs.end(), [&](const Tab& t) { return t.side == side; });
    if (folded_strip(shown == tabs.end() ? "" : shown->label.c_str(), area.lo, area.hi, false))
      actions.act("window.fold", "right", false);
    ImGui::End();
    return area;
  }
  const Area strip{area.lo, {area.hi.x, area.lo.y + px(k_tabs_height)}};
  begin_panel("##side_tabs", strip, colour::panel, false);
  ImDrawList* list = ImGui::GetWindowDrawList();
  // Tabs share what their labels leave.
  std::vector<float> ends{0};
  for (const Tab& tab : tabs)
    ends.push_back(ends.back() + text_width(capitals(tab.label), theme().fonts.caps));
  const float rest = (strip.width() - ends.back()) / static_cast<float>(tabs.size());
  const auto border = [&](size_t i) {
    return i == tabs.size() ? strip.hi.x : strip.lo.x + std::floor(ends[i] + rest * static_cast<float>(i));
  };
  for (size_t i = 0; i < tabs.size(); ++i) {
    const Tab& tab = tabs[i];
    const ImVec2 lo(border(i), strip.lo.y), hi(border(i + 1), strip.hi.y);
    const bool on = side == tab.side;
    ImGui::SetCursorScreenPos(lo);
    if (ImGui::InvisibleButton(("##" + tab.side).c_str(), {std::max(1.0f, hi.x - lo.x), hi.y - lo.y}))
      actions.act("window.side", tab.side);
    const bool hovered = ImGui::IsItemHovered();
    tooltip(tab.help);
    if (!on) list->AddRectFilled(lo, hi, colour::surround);
    draw_text(list, lo, hi, capitals(tab.label),
              on        ? colour::text
              : hovered ? colour::text_dim
                        : colour::text_faint,
              Align::centre, theme().fonts.caps);
    if (on)
      list->AddRectFilled({lo.x, lo.y}, {hi.x, lo.y + px(2)}, colour::accent);
    else
      list->AddRectFilled({lo.x, hi.y - 1}, hi, colour::hairline);
  }
  ImGui::End();
  return {{area.lo.x, strip.hi.y}, area.hi};
}

void draw_solver_panel(Controls& controls, const SolverInfo& solver, const Area& area) {
  begin_panel(("##solver_" + solver.name).c_str(), area, colour::panel, true);
  const bool used = controls.open.uses(solver);
  const Report* report = used && controls.open.scene ? controls.open.report(solver) : nullptr;
  if (!used) {
    block(controls, solver.label, "", [&] { unused(controls, solver); });
  } else if (!report) {
    block(controls, solver.label, "", [&] {
      paragraph(controls.open.scene ? "It has not been used yet." : "No scene is open.", colour::text_faint);
    });
  } else {
    Items draw(controls, solver);
    for (const PanelSection& section : report->sections)
      block(controls, section.title, section.note, [&] {
        for (const PanelItem& item : section.items) std::visit(draw, item);
      });
  }
  block(controls, "Options", "", [&] { options(controls, solver, report); });
  hairline();
  ImGui::End();
}

}  // namespace lucerna::ui
