// The log and the console below it.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

#include "shown_lines.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

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

/// The edited text, and what completes it.
struct Edited {
  Console& console;
  const commands::Registry& registry;
};

/// Tab completes the text typed at the console, arrows browse its history.
int edit_console(ImGuiInputTextCallbackData* data) {
  const Edited& edited = *static_cast<Edited*>(data->UserData);
  Console& console = edited.console;
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
  const std::vector<std::string> words = edited.registry.complete(typed);
  if (words.empty()) return 0;
  std::string common = words[0];
  for (const std::string& word : words) {
    const auto differ = std::mismatch(common.begin(), common.end(), word.begin(), word.end());
    common.erase(differ.first, common.end());
  }
  // The last word is replaced; a space follows a complete word, unless its value follows.
  const size_t begin = commands::last_word(typed);
  if (words.size() == 1 && common.back() != '=' && common.back() != '/') common += ' ';
  if (common.size() > typed.size() - begin || words.size() == 1)
    put(typed.substr(0, begin) + common + std::string(data->Buf + data->CursorPos));
  return 0;
}

/// The console's hint to the right of the typed text: possible continuations.
std::string console_hint(const commands::Registry& registry, const std::string& typed) {
  if (typed.empty()) return "";
  const std::vector<std::string> words = registry.complete(typed);
  const std::string last = typed.substr(commands::last_word(typed));
  std::string hint;
  if (!words.empty() && !(words.size() == 1 && words[0] == last)) {
    for (size_t i = 0; i < std::min<size_t>(words.size(), 12); ++i) hint += (i ? "   " : "") + words[i];
    return hint + (words.size() > 12 ? "   \xE2\x80\xA6" : "");
  }
  if (const commands::Command* c = registry.find(typed.substr(0, typed.find(' '))))
    return registry.usage(*c).substr(c->name.size());
  return "";
}

/// Empties the last text field and keeps the keyboard there. ImGui leaves a field at Enter; taking it back a
/// frame later would lose what is typed meanwhile, and letters would act as shortcuts.
void stay_in_field() {
  ImGuiContext& context = *ImGui::GetCurrentContext();
  ImGuiInputTextState& field = context.InputTextState;
  field.ClearText();
  field.Stb.undostate.undo_point = 0, field.Stb.undostate.undo_char_point = 0;
  field.InitialTextA.resize(1);
  field.InitialTextA[0] = 0;
  ImGui::SetActiveID(context.LastItemData.ID, context.CurrentWindow);
}

void draw_console(Actions& actions, const commands::Registry& registry, LogView& log, const Area& area) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddLine({area.lo.x, area.lo.y}, {area.hi.x, area.lo.y}, colour::hairline);
  Console& console = log.console;
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
  Edited edited{console, registry};
  const bool entered =
      ImGui::InputText("##console", &console.text,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion |
                           ImGuiInputTextFlags_CallbackHistory,
                       edit_console, &edited);
  const bool typed = entered && !console.text.empty();
  if (typed) stay_in_field();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
  console.active = ImGui::IsItemActive();
  if (!console.active)  // it would cover the answer
    tooltip("Runs a command. Tab completes, arrows browse the history, 'help' lists the commands. Ctrl+L.");
  const float used = px(24) + text_width(console.text) + px(14);
  const std::string hint = console.active         ? console_hint(registry, console.text)
                           : console.text.empty() ? "Command"
                                                  : "";
  const ImVec2 lo(area.lo.x + (console.text.empty() ? px(26) : used), area.lo.y);
  draw_text(list, lo, {area.hi.x - px(12), area.hi.y}, elided(hint, area.hi.x - px(12) - lo.x),
            colour::text_faint);
  if (typed) {
    if (console.history.empty() || console.history.back() != console.text)
      console.history.push_back(console.text);
    log.typed.push_back(std::exchange(console.text, {}));
    console.at = -1;
    log.follows = true;
    actions.wake(3);
  }
}

}  // namespace

float panel_heading(const char* title, const Area& area) {
  const ImVec2 lo = area.lo, hi(area.hi.x, area.lo.y + px(k_folded_bottom));
  ImDrawList* list = ImGui::GetWindowDrawList();
  ImFont* font = theme().fonts.caps;
  ImVec2 at(lo.x + px(12), std::floor(lo.y + 0.5f * (hi.y - lo.y - font->FontSize)));
  for (const char* c = title; *c; ++c) {
    list->AddText(font, font->FontSize, at, colour::text_dim, c, c + 1);
    at.x += font->GetCharAdvance(static_cast<unsigned char>(*c)) + px(0.6f);
  }
  return at.x + px(8);
}

void draw_log(Actions& actions, const commands::Registry& registry, LogView& log, bool expanded,
              const Area& area) {
  begin_panel("##log", area, colour::panel, false);
  panel_heading("LOG", area);
  ImGui::SetCursorScreenPos({area.hi.x - px(28), area.lo.y + px(3)});
  if (sign_button("##fold", expanded ? Sign::chevron_down : Sign::chevron_up, true, colour::text_faint))
    actions.act("window.fold", "bottom", expanded);
  tooltip(expanded ? "Folds the strip." : "Unfolds the strip.");
  static const char* names[] = {"Debug", "Info", "Warnings", "Errors"};
  std::array<size_t, 4> counts{};
  for (const LogLine& line : log.lines) ++counts[static_cast<size_t>(line.level)];
  if (expanded && area.width() > px(460)) {
    float right = area.hi.x - px(36);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const auto chip = [&](const char* id, const std::string& text, bool on, ImU32 ink, bool counted = false) {
      // Room for two digits, so the first lines do not move the neighbours.
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
    if (chip("##clear", "Clear", false, colour::text)) actions.act("log.clear");
    tooltip("Clears the log.");
    if (chip("##copy", "Copy", false, colour::text)) actions.act("log.copy");
    tooltip("Copies the displayed lines to the clipboard.");
    right -= px(8);
    for (int level = 3; level >= 0; --level) {
      const auto l = static_cast<size_t>(level);
      if (chip(names[l], counts[l] > 0 ? fmt::format("{} {}", names[l], counts[l]) : names[l], log.levels[l],
               counts[l] > 0 ? level_colour(static_cast<log::Level>(level)) : colour::text_dim, true))
        actions.act("log.show", k_level_names[l], !log.levels[l]);
      tooltip(fmt::format("{} lines of this level.", log.levels[l] ? "Hides" : "Shows"));
    }
  }
  if (expanded) {
    ImGui::SetCursorScreenPos({area.lo.x, area.lo.y + px(30)});
    const float console = px(28);
    ImGui::BeginChild("##lines", {area.width(), std::max(1.0f, area.hi.y - area.lo.y - px(30) - console)});
    const float width = begin_padded();
    ImDrawList* list = ImGui::GetWindowDrawList();
    ImFont* font = theme().fonts.small;
    for (const LogLine& line : log.lines) {
      if (!log.levels[static_cast<size_t>(line.level)]) continue;
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
      ShownLines::instance().note(line.text);
      list->AddText(font, font->FontSize, {text_x, at.y},
                    line.level == log::Level::error || line.level == log::Level::warning
                        ? colour::text
                        : level_colour(line.level),
                    line.text.c_str(), nullptr, room);
    }
    end_padded();
    // Follows the newest line until the user scrolls up.
    if (ImGui::GetIO().MouseWheel != 0 && ImGui::IsWindowHovered())
      log.follows = ImGui::GetScrollY() >= ImGui::GetScrollMaxY() - 1;
    if (log.follows) ImGui::SetScrollHereY(1);
    ImGui::EndChild();
    draw_console(actions, registry, log, {{area.lo.x, area.hi.y - console}, area.hi});
  }
  ImGui::End();
}

}  // namespace lucerna::ui
