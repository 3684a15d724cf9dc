// The strip at the bottom: device and timings, and the log.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// Greys of different lightness, so that neighbours in the stacked bar part without claiming a meaning.
ImU32 stage_colour(size_t index, bool host) {
  static constexpr int steps[] = {178, 126, 152, 104, 190, 138, 116, 164};
  const int v = steps[index % 8];
  return host ? IM_COL32(v * 2 / 3, v * 5 / 6, v, 255) : colour::grey(v);
}

void figure(const char* name, const std::string& value, const std::string& help, float width) {
  const ImVec2 lo = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, px(36)});
  tooltip(help);
  ImDrawList* list = ImGui::GetWindowDrawList();
  draw_text(list, lo, {lo.x + width, lo.y + px(16)}, name, colour::text_dim, Align::left,
            theme().fonts.small);
  draw_text(list, {lo.x, lo.y + px(16)}, {lo.x + width - px(8), lo.y + px(36)}, elided(value, width - px(8)),
            colour::text);
}

void figures(const session::Snapshot& s, float width) {
  // The device's name takes two columns.
  const int columns = width > px(660) ? 7 : width > px(440) ? 4 : 3;
  const float w = std::floor(width / static_cast<float>(columns));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  int n = 0;
  const auto put = [&](const char* name, const std::string& value, const std::string& help, int span = 1) {
    ImGui::SetCursorScreenPos(
        {at.x + static_cast<float>(n % columns) * w, at.y + static_cast<float>(n / columns) * px(40)});
    figure(name, value, help, w * static_cast<float>(span));
    n += span;
  };
  put("Device", s.device.empty() ? "\xE2\x80\x93" : s.device, s.device, 2);
  put("Tracer", s.tracer.empty() ? "\xE2\x80\x93" : s.tracer, "Who traces the rays.");
  put("Rays", fmt::format("{:.2f} Mray/s", s.mrays_per_second),
      fmt::format(
          "Rate of this picture; {} rays since it started.{}", count_text(static_cast<double>(s.rays)),
          s.dropped == 0
              ? ""
              : fmt::format(" {} contributions were refused because they were not finite.", s.dropped)));
  put("Size", s.width == 0 ? "\xE2\x80\x93" : fmt::format("{} \xC3\x97 {}", s.width, s.height),
      "Pixels of the picture.");
  put("Device memory", megabytes_text(s.device_mb), "Memory taken on the device.");
  put("Host memory", megabytes_text(s.host_mb), "Memory of this program.");
  ImGui::SetCursorScreenPos({at.x, at.y + static_cast<float>((n + columns - 1) / columns) * px(40) + px(2)});
}

void stage_rows(const std::vector<session::StageStatus>& stages, float width) {
  double total = 0, longest = 0;
  for (const auto& stage : stages) total += stage.ms, longest = std::max(longest, stage.ms);
  if (total <= 0) return label("No stage has run yet", colour::text_faint);
  std::vector<Part> parts;
  for (size_t i = 0; i < stages.size(); ++i)
    parts.push_back({static_cast<float>(stages[i].ms / total), stage_colour(i, stages[i].host)});
  stacked_bar(parts, 8, width);
  tooltip("Time of all stages since the picture started, in the order of the rows below.");
  gap(2);
  // As many columns as fit; rows are read downwards.
  const int columns = std::max(1, static_cast<int>((width + px(32)) / px(256)));
  const float between = px(32);
  const float w = std::floor((width + between) / static_cast<float>(columns));
  const size_t rows = (stages.size() + static_cast<size_t>(columns) - 1) / static_cast<size_t>(columns);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (size_t i = 0; i < stages.size(); ++i) {
    const auto& stage = stages[i];
    const ImVec2 lo(at.x + static_cast<float>(i / rows) * w, at.y + static_cast<float>(i % rows) * px(20));
    const float right = lo.x + w - between;
    list->AddRectFilled({lo.x, lo.y + px(6)}, {lo.x + px(8), lo.y + px(14)}, stage_colour(i, stage.host),
                        px(2));
    const float numbers = right - px(116);
    std::string name = stage.name;
    draw_text(list, {lo.x + px(16), lo.y}, {numbers, lo.y + px(20)}, elided(name, numbers - lo.x - px(16)),
              colour::text_dim);
    draw_text(list, {numbers, lo.y}, {right - px(52), lo.y + px(20)}, ms_text(stage.ms), colour::text,
              Align::right);
    draw_text(list, {right - px(52), lo.y}, {right, lo.y + px(20)},
              fmt::format("{:.1f} %", 100 * stage.ms / total), colour::text_dim, Align::right);
    ImGui::SetCursorScreenPos(lo);
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("##stage", {right - lo.x, px(20)});
    ImGui::PopID();
    tooltip(fmt::format("{}: {} {}since the picture started.", stage.name, ms_text(stage.ms),
                        stage.host ? "of wall time on the host " : "on the device "));
  }
  ImGui::SetCursorScreenPos({at.x, at.y + static_cast<float>(rows) * px(20)});
}

ImU32 level_colour(log::Level level) {
  switch (level) {
    case log::Level::error:
      return colour::error;
    case log::Level::warning:
      return colour::warning;
    case log::Level::info:
      return colour::text_dim;
    case log::Level::debug:
      return colour::text_faint;
  }
  return colour::text;
}

const char* const k_level_names[] = {"debug", "info", "warning", "error"};

/// Tab completes what is typed at the console, arrows go through what was typed before.
int edit_console(ImGuiInputTextCallbackData* data) {
  auto& ui = *static_cast<Ui*>(data->UserData);
  Console& console = ui.console;
  const auto put = [&](const std::string& text) {
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, text.c_str());
  };
  if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory) {
    const int last = static_cast<int>(console.history.size());
    if (last == 0) return 0;
    const int step = data->EventKey == ImGuiKey_UpArrow ? -1 : 1;
    console.at = std::clamp((console.at < 0 ? last : console.at) + step, 0, last);
    put(console.at < last ? console.history[static_cast<size_t>(console.at)] : "");
    return 0;
  }
  const std::string typed(data->Buf, static_cast<size_t>(data->CursorPos));
  const std::vector<std::string> words = ui.registry.complete(typed);
  if (words.empty()) return 0;
  std::string common = words[0];
  for (const std::string& word : words) {
    const auto differ = std::mismatch(common.begin(), common.end(), word.begin(), word.end());
    common.erase(differ.first, common.end());
  }
  // The last word is replaced; one that is complete is parted from the next, unless its value follows.
  const size_t begin = commands::last_word(typed);
  if (words.size() == 1 && common.back() != '=' && common.back() != '/') common += ' ';
  if (common.size() > typed.size() - begin || words.size() == 1)
    put(typed.substr(0, begin) + common + std::string(data->Buf + data->CursorPos));
  return 0;
}

/// What the console says to the right of what is typed: what may follow, or how the command goes on.
std::string console_hint(const Ui& ui) {
  const std::string& typed = ui.console.text;
  if (typed.empty()) return "";
  const std::vector<std::string> words = ui.registry.complete(typed);
  const std::string last = typed.substr(commands::last_word(typed));
  std::string hint;
  if (!words.empty() && !(words.size() == 1 && words[0] == last)) {
    for (size_t i = 0; i < std::min<size_t>(words.size(), 12); ++i) hint += (i ? "   " : "") + words[i];
    return hint + (words.size() > 12 ? "   \xE2\x80\xA6" : "");
  }
  if (const commands::Command* c = ui.registry.find(typed.substr(0, typed.find(' '))))
    return ui.registry.usage(*c).substr(c->name.size());
  return "";
}

void draw_console(Ui& ui, const Area& area) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddLine({area.lo.x, area.lo.y + 0.5f}, {area.hi.x, area.lo.y + 0.5f}, colour::hairline);
  Console& console = ui.console;
  ImFont* font = theme().fonts.regular;
  draw_text(list, {area.lo.x + px(12), area.lo.y}, {area.lo.x + px(24), area.hi.y}, "\xE2\x80\xBA",
            console.active ? colour::accent : colour::text_faint);
  const float pad = std::floor(0.5f * (area.height() - font->FontSize));
  ImGui::SetCursorScreenPos({area.lo.x + px(24), area.lo.y + 1});
  ImGui::SetNextItemWidth(area.width() - px(36));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, pad});
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, 0);
  if (console.focus) ImGui::SetKeyboardFocusHere(), console.focus = false;
  const bool entered =
      ImGui::InputText("##console", &console.text,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion |
                           ImGuiInputTextFlags_CallbackHistory,
                       edit_console, &ui);
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
  console.active = ImGui::IsItemActive();
  tooltip("Carries out a command. Tab completes, arrows go back, 'help' lists the commands. Ctrl+L.");
  const float used = px(24) + text_width(console.text) + px(14);
  const std::string hint = console.active ? console_hint(ui) : console.text.empty() ? "Command" : "";
  const ImVec2 lo(area.lo.x + (console.text.empty() ? px(26) : used), area.lo.y);
  draw_text(list, lo, {area.hi.x - px(12), area.hi.y}, elided(hint, area.hi.x - px(12) - lo.x),
            colour::text_faint);
  if (entered && !console.text.empty()) {
    if (console.history.empty() || console.history.back() != console.text)
      console.history.push_back(console.text);
    ui.typed.push_back(std::exchange(console.text, {}));
    console.at = -1;
    ui.log_follows = true;
    console.focus = true;
    ui.wake(3);
  }
}

/// The heading of a bottom panel; returns the x where its content at the right may start.
void heading(Ui& ui, const char* title, const Area& area, bool folds) {
  const ImVec2 lo = area.lo, hi(area.hi.x, area.lo.y + px(k_folded_bottom));
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImFont* font = theme().fonts.caps;
  ImVec2 at(lo.x + px(12), std::floor(lo.y + 0.5f * (hi.y - lo.y - font->FontSize)));
  for (const char* c = title; *c; ++c) {
    list->AddText(font, font->FontSize, at, colour::text_dim, c, c + 1);
    at.x += font->GetCharAdvance(static_cast<unsigned char>(*c)) + px(0.6f);
  }
  if (!folds) return;
  ImGui::SetCursorScreenPos({hi.x - px(28), lo.y + px(3)});
  if (sign_button("##fold", ui.layout.bottom_open ? Sign::chevron_down : Sign::chevron_up, true,
                  colour::text_faint))
    ui.act("window.fold", "bottom", ui.layout.bottom_open);
  tooltip(ui.layout.bottom_open ? "Folds the strip." : "Unfolds the strip.");
}

}  // namespace

void draw_timings(Ui& ui, const Area& area) {
  begin_panel("##timings", area, colour::panel, false);
  heading(ui, "DEVICE & TIMINGS", area, false);
  if (ui.layout.bottom_open) {
    ImGui::SetCursorScreenPos({area.lo.x, area.lo.y + px(30)});
    ImGui::BeginChild("##body", {area.width(), std::max(1.0f, area.hi.y - area.lo.y - px(30))});
    const float width = begin_padded();
    if (ui.snapshot)
      figures(*ui.snapshot, width), gap(4), stage_rows(ui.snapshot->stages, width);
    else
      label("No device yet", colour::text_faint);
    end_padded();
    gap(8);
    ImGui::EndChild();
  }
  ImGui::End();
}

void draw_log(Ui& ui, const Area& area) {
  begin_panel("##log", area, colour::panel, false);
  heading(ui, "LOG", area, true);
  static const char* names[] = {"Debug", "Info", "Warnings", "Errors"};
  std::array<size_t, 4> counts{};
  for (const LogLine& line : ui.log) ++counts[static_cast<size_t>(line.level)];
  if (ui.layout.bottom_open && area.width() > px(400)) {
    float right = area.hi.x - px(36);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const auto chip = [&](const char* id, const std::string& text, bool on, ImU32 ink, bool counted = false) {
      // Room for two digits, so that the first lines do not push the neighbours about.
      const std::string head = text.substr(0, text.find(' '));
      const float w = std::max(text_width(text, theme().fonts.small),
                               counted ? text_width(head + " 00", theme().fonts.small) : 0) +
                      px(14);
      right -= w;
      const ImVec2 lo(right, area.lo.y + px(4)), hi(right + w, area.lo.y + px(24));
      ImGui::SetCursorScreenPos(lo);
      const bool pressed = ImGui::InvisibleButton(id, {w, px(20)});
      if (on || ImGui::IsItemHovered())
        list->AddRectFilled(lo, hi, ImGui::IsItemHovered() ? colour::field_hover : colour::field, px(3));
      draw_text(list, lo, hi, text, on ? ink : colour::text_faint, Align::centre, theme().fonts.small);
      right -= px(4);
      return pressed;
    };
    if (chip("##clear", "Clear", false, colour::text)) ui.act("log.clear");
    tooltip("Empties the log.");
    if (chip("##copy", "Copy", false, colour::text)) ui.act("log.copy");
    tooltip("Copies the lines shown to the clipboard.");
    right -= px(8);
    for (int level = 3; level >= 0; --level) {
      const auto l = static_cast<size_t>(level);
      if (chip(names[l], counts[l] > 0 ? fmt::format("{} {}", names[l], counts[l]) : names[l],
               ui.log_levels[l],
               counts[l] > 0 ? level_colour(static_cast<log::Level>(level)) : colour::text_dim, true))
        ui.act("log.show", k_level_names[l], !ui.log_levels[l]);
      tooltip(fmt::format("{} lines of this level.", ui.log_levels[l] ? "Hides" : "Shows"));
    }
  }
  if (ui.layout.bottom_open) {
    ImGui::SetCursorScreenPos({area.lo.x, area.lo.y + px(30)});
    const float console = px(28);
    ImGui::BeginChild("##lines", {area.width(), std::max(1.0f, area.hi.y - area.lo.y - px(30) - console)});
    const float width = begin_padded();
    ImDrawList* list = ImGui::GetWindowDrawList();
    ImFont* font = theme().fonts.small;
    for (const LogLine& line : ui.log) {
      if (!ui.log_levels[static_cast<size_t>(line.level)]) continue;
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float text_x = at.x + px(64), room = std::max(px(80), at.x + width - text_x);
      const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9f, room, line.text.c_str());
      const float height = std::max(size.y, font->FontSize) + px(4);
      ImGui::Dummy({width, height - ImGui::GetStyle().ItemSpacing.y});
      if (!ImGui::IsRectVisible(at, {at.x + width, at.y + height})) continue;
      draw_text(list, {at.x, at.y}, {at.x + px(48), at.y + font->FontSize}, fmt::format("{:.1f}", line.time),
                colour::text_faint, Align::right, font);
      if (line.level >= log::Level::warning)
        list->AddRectFilled({at.x + px(55), at.y + px(1)}, {at.x + px(57), at.y + height - px(5)},
                            level_colour(line.level), px(1));
      list->AddText(font, font->FontSize, {text_x, at.y},
                    line.level == log::Level::error || line.level == log::Level::warning
                        ? colour::text
                        : level_colour(line.level),
                    line.text.c_str(), nullptr, room);
    }
    end_padded();
    // Stays at the newest line until somebody scrolls up.
    if (ImGui::GetIO().MouseWheel != 0 && ImGui::IsWindowHovered())
      ui.log_follows = ImGui::GetScrollY() >= ImGui::GetScrollMaxY() - 1;
    if (ui.log_follows) ImGui::SetScrollHereY(1);
    ImGui::EndChild();
    draw_console(ui, {{area.lo.x, area.hi.y - console}, area.hi});
  }
  ImGui::End();
}

}  // namespace lucerna::ui
