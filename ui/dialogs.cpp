// The page of keys, the frame of every panel, and the borders between panels.
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <set>
#include <utility>

#include "shown_lines.h"
#include "solvers/registry.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

constexpr float k_key_text = 400;  // width of the solvers' rows

/// Keys and their actions; rows without keys are gaps.
std::vector<std::pair<std::string, std::string>> key_rows() {
  std::vector<std::pair<std::string, std::string>> rows = {
      {"Left drag", "orbit around the point under the pointer"},
      {"Right drag", "look around"},
      {"Middle drag, Shift + left drag", "pan"},
      {"Wheel", "move towards the point under the pointer, or away"},
      {"W A S D, Q E", "fly; down and up; wheel for speed, Shift for four times as fast"},
      {"H", "walk along the floor instead; Q E set the eye's height"},
      {"Alt while moving", "pass through walls"},
      {"Ctrl + left drag", "rotate the environment, or the sun if there is none"},
      {"Click", "select the object; a second click selects its material"},
      {"Hold", "the left button still: values, noise and surface of the pixel"},
      {"I", "trace the paths of the pixel that is held, or of the next clicked one"},
      {"F", "frame the selection, or the scene"},
      {"Z", "handles of the selected object: move, turn, size; with Ctrl in steps"},
      {"Ctrl + Shift while dragging", "the object or lamp snaps to the surface under the pointer"},
      {"L", "mark lamps and emissive surfaces; click to select, drag to move a lamp"},
      {"Drag on a lamp's mark",
       "move it parallel to the picture, with Shift vertically; a spot's aim follows surfaces"},
      {"T", "show the state of tiles"},
      {"Ctrl + H", "hold the picture, to compare later ones with it"},
      {"Y", "while it is held down: the held result in place of the picture, or the reverse"},
      {"1 \xE2\x80\x93 9", "scene cameras"},
      {"Ctrl + B", "bookmark this view, see the Camera menu"},
      {"B", "pick middle grey for the exposure with a click"}};
  bool panels = false, inspects = false;
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    panels = panels || solver->has_panel();
    // All of a kind in as few rows as possible.
    std::string keys, what;
    const auto end_row = [&] {
      if (!keys.empty()) rows.emplace_back(std::exchange(keys, {}), std::exchange(what, {}));
    };
    const auto add = [&](char shortcut, const std::string& label) {
      if (!shortcut) return;
      const std::string more = ", " + uncapitalised(label);
      if (!what.empty() && text_width(what + more) > px(k_key_text)) end_row();
      keys += keys.empty() ? std::string{shortcut} : std::string(", ") + shortcut;
      what += what.empty() ? fmt::format("the {}: {}", uncapitalised(solver->label), more.substr(2)) : more;
    };
    for (const solvers::ViewInfo& view : solver->views) {
      add(view.shortcut, view.label);
      inspects = inspects || view.inspects_pointer;
    }
    end_row();
    for (const solvers::CommandInfo& command : solver->commands) add(command.shortcut, command.label);
    end_row();
  }
  if (inspects) rows.emplace_back("Pointer at rest", "details of that point, while these views are shown");
  if (panels) rows.emplace_back("K", "next panel: solvers in use, then the scene");
  for (const auto& row : std::initializer_list<std::pair<const char*, const char*>>{
           {"", ""},
           {"Space", "pause, resume"},
           {"R", "restart the picture"},
           {"Ctrl + R", "choose a rectangle that gets all samples"},
           {"U", "show unfiltered samples, or the preview"},
           {"Tab", "panels"},
           {"F5", "reload shaders"},
           {"F12", "screenshot of the window"},
           {"Ctrl + O, Ctrl + S", "open, save the picture"},
           {"Ctrl + Shift + S", "save the scene with its edits"},
           {"Ctrl + L", "type a command"},
           {"Ctrl + Z, Ctrl + Shift + Z", "undo, redo"},
           {"Esc", "end a drag, close a message, clear the selection, or cancel a load"},
           {"", ""},
           {"Double-click a number", "type a value"},
           {"Shift, Ctrl while dragging", "ten times finer, ten times coarser"}})
    rows.emplace_back(row.first, row.second);
  return rows;
}

}  // namespace

void draw_key_page(bool& wanted) {
  static bool open = false;
  if (wanted && !open) ImGui::OpenPopup("##keys");
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({std::floor(0.5f * window.x), std::floor(0.5f * window.y)}, 0, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {window.x, window.y - px(16)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(20), px(16)});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(8), 0});
  open = ImGui::BeginPopup("##keys", ImGuiWindowFlags_NoMove);
  if (open) {
    const std::vector<std::pair<std::string, std::string>> rows = key_rows();
    label("Keys and mouse", colour::text, theme().fonts.strong);
    gap(6);
    // Columns as wide as their texts if the window has room; longer texts wrap.
    float names = 0, texts = 0;
    for (const auto& [keys, what] : rows)
      names = std::max(names, text_width(keys)), texts = std::max(texts, text_width(what));
    names = std::min(names, 0.4f * window.x) + px(20);
    texts = std::clamp(window.x - names - px(40 + 32), px(120), texts + 1);
    ImFont* font = theme().fonts.regular;
    for (const auto& [keys, what] : rows) {
      if (keys.empty()) {
        gap(8);
        continue;
      }
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const auto lines = [&](const std::string& text, float width) {
        return font->CalcTextSizeA(font->FontSize, 1e9f, width, text.c_str()).y;
      };
      const float room = names - px(20);
      ImGui::Dummy({names + texts, std::max(lines(keys, room), lines(what, texts)) + px(3)});
      ImDrawList* list = ImGui::GetWindowDrawList();
      ShownLines::instance().note(keys), ShownLines::instance().note(what);
      list->AddText(font, font->FontSize, at, colour::text, keys.c_str(), nullptr, room);
      list->AddText(font, font->FontSize, {at.x + names, at.y}, colour::text_dim, what.c_str(), nullptr,
                    texts);
    }
    ImGui::EndPopup();
  }
  wanted = open;
  ImGui::PopStyleVar(2);
}

void begin_panel(const char* name, const Area& area, ImU32 background, bool scrolls) {
  ImGui::SetNextWindowPos(area.lo);
  ImGui::SetNextWindowSize({std::max(1.0f, area.width()), std::max(1.0f, area.height())});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, background);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                           ImGuiWindowFlags_NoNavFocus;
  if (scrolls)
    flags &= ~ImGuiWindowFlags_NoScrollbar;
  else
    flags |= ImGuiWindowFlags_NoScrollWithMouse;
  if (std::string_view(name) == "##bar") flags |= ImGuiWindowFlags_MenuBar;
  ImGui::Begin(name, nullptr, flags);
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

void draw_splitters(Actions& actions, const Areas& areas) {
  // A strip over each border, in a separate window so that it is above both neighbours.
  const auto strip = [&](const char* name, ImVec2 lo, ImVec2 hi, bool along_x, float direction,
                         float& value) {
    ImGui::SetNextWindowPos(lo);
    ImGui::SetNextWindowSize({hi.x - lo.x, hi.y - lo.y});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav);
    ImGui::PopStyleVar(2);
    const bool twice = splitter("##strip", lo, hi, along_x, direction, value);
    tooltip("Drag to resize; double-click to fold or unfold.");
    ImGui::End();
    return twice;
  };
  const float reach = px(3);
  const Layout& l = areas.shown;
  const float left = areas.left.hi.x, right = areas.right.lo.x, bottom = areas.accuracy.lo.y;
  const auto edge = [&](const char* name, const char* panel, ImVec2 lo, ImVec2 hi, bool along_x,
                        float direction, float size, bool open) {
    float wanted = size;
    if (strip(name, lo, hi, along_x, direction, wanted))
      actions.act("window.fold", panel, open);
    else if (wanted != size && open)
      actions.act("window.split", panel, std::max(0.0f, wanted));
  };
  edge("##split_left", "left", {left - reach, areas.left.lo.y}, {left + reach, bottom - reach}, true, 1,
       l.left, l.left_open);
  edge("##split_right", "right", {right - reach, areas.right.lo.y}, {right + reach, bottom - reach}, true, -1,
       l.right, l.right_open);
  edge("##split_bottom", "bottom", {0, bottom - reach}, {areas.log.hi.x, bottom + reach}, false, -1, l.bottom,
       l.bottom_open);
  const auto inner = [&](const char* name, const char* command, const Area& area, float share) {
    const float before = share * areas.log.hi.x / theme().scale;
    float width = before;
    strip(name, {area.lo.x - reach, bottom + reach}, {area.lo.x + reach, area.hi.y}, true, -1, width);
    if (width != before)
      actions.act(command, std::clamp(width * theme().scale / std::max(1.0f, areas.log.hi.x), 0.0f, 1.0f));
  };
  inner("##split_log", "window.log_share", areas.log, l.log_share);
  inner("##split_passes", "window.passes_share", areas.passes, l.passes_share);
}

}  // namespace lucerna::ui
