// The page of keys, the handling of keys, and the frame of every panel.
#include <GLFW/glfw3.h>
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

void key_page(Ui& ui) {
  static bool open = false;
  if (ui.help && !open) ImGui::OpenPopup("##keys");
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
  ui.help = open;
  ImGui::PopStyleVar(2);
}

}  // namespace

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

void draw_dialogs(Ui& ui) {
  draw_file_dialog(ui.actions, ui.open, ui.recent, ui.picture_of, ui.dialog, ui.pressed(GLFW_KEY_ESCAPE));
  draw_leaving_dialog(ui);
  key_page(ui);
}

bool Ui::pressed(int key, int mods) const {
  const int relevant = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
  return std::any_of(keys.begin(), keys.end(),
                     [&](const auto& k) { return k.first == key && (k.second & relevant) == mods; });
}

namespace {

/// Keys of views and commands of the solvers in use. If two share a key, the one whose panel is shown has it,
/// otherwise the first. Keys of views that no solver in use has say so.
void solver_keys(Ui& ui) {
  std::vector<const solvers::SolverInfo*> used;
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (ui.open.uses(*solver)) used.insert(ui.side == solver->name ? used.begin() : used.end(), solver);
  std::set<char> taken;
  const auto pressed = [&](char shortcut) {  // a letter is GLFW's name of its key
    return shortcut && ui.pressed(shortcut) && taken.insert(shortcut).second;
  };
  for (const solvers::SolverInfo* solver : used) {
    for (const solvers::ViewInfo& view : solver->views)
      if (pressed(view.shortcut)) ui.controls.turn_view(view);
    for (const solvers::CommandInfo& command : solver->commands)
      if (pressed(command.shortcut)) ui.act(solver->name + "." + command.name);
  }
  if (!ui.open.scene) return;
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const solvers::ViewInfo& view : solver->views)
      if (!ui.open.uses(*solver) && pressed(view.shortcut))
        ui.notice(fmt::format("{}: no component is computed by {}. Choose it in the Light panel.", view.label,
                              solver->title));
}

/// Holds the picture, and shows the panel of held results.
void hold_picture(Ui& ui) {
  ui.act("compare.hold");
  ui.act("window.side", k_compare_side);
}

}  // namespace

void handle_keys(Ui& ui) {
  ui.compare.flipped = ImGui::GetIO().KeysDown[GLFW_KEY_Y] && !ImGui::GetIO().WantTextInput;
  if (ui.compare.flipped) ui.wake(2);
  const bool popup = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  if (ui.pressed(GLFW_KEY_F12)) ui.act("screenshot");
  if (ui.pressed(GLFW_KEY_F5)) ui.act("shaders.reload");
  if (ui.dialog.purpose != Dialog::Purpose::none) return;
  if (ui.pressed(GLFW_KEY_O, GLFW_MOD_CONTROL)) ui.act("dialog.open");
  for (const auto& [key, mods] : ui.keys)
    if (key == GLFW_KEY_S && mods & GLFW_MOD_CONTROL && ui.has_picture())
      ui.act(mods & GLFW_MOD_SHIFT ? "scene.save" : "dialog.save");
  if (ui.pressed(GLFW_KEY_L, GLFW_MOD_CONTROL)) ui.act("log.type");
  if (ui.pressed(GLFW_KEY_Q, GLFW_MOD_CONTROL)) ui.act("window.close");
  if (popup && ui.pressed(GLFW_KEY_ESCAPE)) ImGui::ClosePopupToLevel(0, true);
  if (ImGui::GetIO().WantTextInput || popup) return;
  for (const auto& [key, mods] : ui.keys)
    if (key == GLFW_KEY_Z && mods & GLFW_MOD_CONTROL) {
      const bool again = mods & GLFW_MOD_SHIFT;
      if (again ? ui.history.can_redo() : ui.history.can_undo()) ui.act(again ? "redo" : "undo");
    }
  if (ui.pressed(GLFW_KEY_F1)) ui.act("window.keys");
  if (ui.pressed(GLFW_KEY_TAB)) ui.act("window.panels", !ui.layout.panels), ui.wake(3);
  if (ui.pressed(GLFW_KEY_ESCAPE)) {
    if (ui.drag.object)
      ui.cancel_object_drag();
    else if (ui.drag.lamp && ImGui::IsMouseDragging(0))
      ui.cancel_lamp_drag();
    else if (ui.cards.welcome)
      ui.cards.welcome = false;
    else if (ui.dropper)
      ui.act("exposure.dropper", false);
    else if (ui.scene_view.focusing)
      ui.act("camera.focusing", false);
    else if (ui.paths.pick != PathsView::Pick::none)
      ui.act("paths.pick", "none");
    else if (ui.region.picks)
      ui.act("region.pick", false);
    else if (ui.open.loading() || (ui.open.moving_objects() && !ui.open.snapshot->activity.empty()))
      ui.act("scene.cancel");
    else if (!ui.cards.errors.empty())
      ui.act("dismiss");
    else if (ui.camera.selection.kind != Kind::none)
      ui.act("select.none");
  }
  if (!ui.open.snapshot) return;
  if (ui.pressed(GLFW_KEY_F) && ui.camera.view) ui.act("camera.frame");
  if (ui.pressed(GLFW_KEY_H) && ui.camera.view) ui.act("camera.walking", !ui.camera.walking);
  if (ui.pressed(GLFW_KEY_B, GLFW_MOD_CONTROL) && ui.camera.view) keep_view(ui);
  if (ui.pressed(GLFW_KEY_B) && ui.camera.view) ui.act("exposure.dropper", !ui.dropper);
  if (ui.pressed(GLFW_KEY_R)) ui.act("render.restart");
  if (ui.pressed(GLFW_KEY_R, GLFW_MOD_CONTROL) && ui.open.scene) ui.act("region.pick", !ui.region.picks);
  if (ui.pressed(GLFW_KEY_I) && ui.open.scene) {
    if (ui.held_pixel.reported && ui.work.pixel)
      trace_pixel(ui, ui.work.pixel->at);
    else
      ui.act("paths.pick", ui.paths.pick == PathsView::Pick::pixel ? "none" : "pixel");
  }
  if (ui.pressed(GLFW_KEY_Z) && ui.camera.selection.kind == Kind::instance) {
    const int next = ui.scene_view.gizmo == GizmoMode::size ? 1 : static_cast<int>(ui.scene_view.gizmo) + 1;
    ui.act("view.gizmo", k_gizmo_names[static_cast<size_t>(next)]);
  }
  if (ui.pressed(GLFW_KEY_L)) ui.act("view.lamps", !ui.light_marks);
  if (ui.pressed(GLFW_KEY_T)) ui.toggle("overlay.tiles");
  if (ui.pressed(GLFW_KEY_H, GLFW_MOD_CONTROL) && ui.open.scene) hold_picture(ui);
  if (ui.pressed(GLFW_KEY_Y) && !ui.work.compare.results.compared())
    ui.notice("No held result is chosen. Ctrl+H holds the picture.");
  if (ui.pressed(GLFW_KEY_U))
    ui.act("set", "preview.filter", ui.open.setting("preview.filter") == "off" ? "auto" : "off");
  solver_keys(ui);
  if (ui.pressed(GLFW_KEY_K)) ui.act("window.side", ui.next_side());
  if (ui.pressed(GLFW_KEY_SPACE)) ui.act(ui.open.snapshot->paused ? "render.resume" : "render.pause");
  for (int n = 0; n < 9; ++n)
    if (ui.pressed(GLFW_KEY_1 + n) && ui.open.scene && n < static_cast<int>(ui.open.scene->cameras.size()) &&
        ui.camera.view)
      ui.act("camera.select", n + 1);
}

void draw_splitters(Ui& ui, const Areas& areas) {
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
  const Layout& l = ui.shown;
  const float left = areas.left.hi.x, right = areas.right.lo.x, bottom = areas.accuracy.lo.y;
  const auto edge = [&](const char* name, const char* panel, ImVec2 lo, ImVec2 hi, bool along_x,
                        float direction, float size, bool open) {
    float wanted = size;
    if (strip(name, lo, hi, along_x, direction, wanted))
      ui.act("window.fold", panel, open);
    else if (wanted != size && open)
      ui.act("window.split", panel, std::max(0.0f, wanted));
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
      ui.act(command, std::clamp(width * theme().scale / std::max(1.0f, areas.log.hi.x), 0.0f, 1.0f));
  };
  inner("##split_log", "window.log_share", areas.log, l.log_share);
  inner("##split_passes", "window.passes_share", areas.passes, l.passes_share);
}

}  // namespace lucerna::ui
