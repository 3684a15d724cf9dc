// What lies above the panels: file dialogs, the page of keys; and the keys themselves. Also the frame of
// every panel.
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "solvers/registry.h"
#include "state.h"
#include "widgets.h"

namespace fs = std::filesystem;

namespace lucerna::ui {
namespace {

struct Completion {
  std::string path, name;
  bool folder;
};

/// What a dialog asks for, by its purpose.
struct Question {
  std::string title, note;
  std::string command, answer;  ///< that is run with the file; the button's word for it
  std::vector<std::string> endings;
  bool reads = false;  ///< the file is there already
};

Question question(const Dialog& dialog) {
  using Purpose = Dialog::Purpose;
  switch (dialog.purpose) {
    case Purpose::none:
      break;
    case Purpose::open:
      return {.title = "Open a scene",
              .note = "A .gltf or .glb file. Tab completes; arrows choose.",
              .command = "scene.open",
              .answer = "Open",
              .endings = {".gltf", ".glb"},
              .reads = true};
    case Purpose::save:
      return {.title = "Save the picture",
              .note = ".exr holds all layers as floats; .png what is shown, through exposure and tone curve.",
              .command = "image.save",
              .answer = "Save",
              .endings = {".exr", ".png"}};
    case Purpose::script:
      return {.title = "Save the session as a script",
              .note = "What was done, one command a line; lucerna --script FILE does it again.",
              .command = "script.save",
              .answer = "Save",
              .endings = {".lucerna"}};
    case Purpose::reference:
      return {.title = "Load a reference",
              .note = "An .exr of this view and size, rendered long and with another seed.",
              .command = "reference.load",
              .answer = "Load",
              .endings = {".exr"},
              .reads = true};
    case Purpose::solver_load:
      return {.title = "Load a " + uncapitalised(dialog.solver->label),
              .note = fmt::format("A {} file {}.", dialog.solver->file->extension, dialog.solver->file->fits),
              .command = dialog.solver->name + ".load",
              .answer = "Load",
              .endings = {dialog.solver->file->extension},
              .reads = true};
    case Purpose::solver_save:
      return {.title = "Save the " + uncapitalised(dialog.solver->label),
              .note = capitalised(dialog.solver->file->content) + ", for this scene as it is lit now.",
              .command = dialog.solver->name + ".save",
              .answer = "Save",
              .endings = {dialog.solver->file->extension}};
  }
  return {};
}

/// Files of a kind and folders that begin with what is typed.
std::vector<Completion> completions(const std::string& typed, const Dialog& dialog) {
  std::vector<Completion> list;
  for (const std::string& path : commands::paths_starting(typed, question(dialog).endings)) {
    const bool folder = path.back() == '/';
    const size_t slash = path.rfind('/', path.size() - 2);
    list.push_back({path, slash == std::string::npos ? path : path.substr(slash + 1), folder});
  }
  return list;
}

std::string expanded(const std::string& path) {
  if (path.rfind("~/", 0) == 0)
    if (const char* home = std::getenv("HOME")) return home + path.substr(1);
  return path;
}

bool is_folder(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

/// Tab puts the marked entry into the field, or what all entries share; arrows mark. Works on the text as it
/// is at this moment, which may be newer than the list on the screen.
int complete_field(ImGuiInputTextCallbackData* data) {
  auto& dialog = *static_cast<Dialog*>(data->UserData);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackEdit) dialog.marked = -1;
  const auto list = completions(expanded(data->Buf), dialog);
  if (list.empty()) return 0;
  const int last = static_cast<int>(list.size()) - 1;
  if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory)
    dialog.marked = std::clamp(dialog.marked + (data->EventKey == ImGuiKey_DownArrow ? 1 : -1), 0, last);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
    std::string common = list[static_cast<size_t>(std::clamp(dialog.marked, 0, last))].path;
    if (dialog.marked < 0)
      for (const Completion& c : list) {
        const auto differ = std::mismatch(common.begin(), common.end(), c.path.begin(), c.path.end());
        common.erase(differ.first, common.end());
      }
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, common.c_str());
    dialog.marked = -1;
  }
  return 0;
}

void file_dialog(Ui& ui) {
  Dialog& dialog = ui.dialog;
  if (dialog.purpose == Dialog::Purpose::none) return;
  const Question asked = question(dialog);
  // Each has a field of its own, so that none begins with what was typed into another.
  const std::string title = "##" + asked.command;
  if (dialog.fresh) ImGui::OpenPopup(title.c_str()), dialog.fresh = false, dialog.focus = true;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float width = std::min(px(560), window.x - px(48));
  ImGui::SetNextWindowPos({std::floor(0.5f * (window.x - width)), std::floor(0.18f * window.y)});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(16), px(14)});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(8), px(8)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(3));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  if (ImGui::BeginPopupModal(
          title.c_str(), nullptr,
          ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize)) {
    label(asked.title, colour::text, theme().fonts.strong);
    std::error_code ignored;
    if (!asked.reads && fs::is_regular_file(expanded(dialog.path), ignored))
      label(dialog.purpose == Dialog::Purpose::script
                ? "A file of that name exists; it is replaced if it is a saved session."
                : "A file of that name exists and will be replaced.",
            colour::warning, theme().fonts.small);
    else
      label(asked.note, colour::text_dim, theme().fonts.small);
    ImGui::SetNextItemWidth(-1);
    if (dialog.focus) ImGui::SetKeyboardFocusHere(), dialog.to_end = true;
    dialog.focus = false;
    const std::vector<Completion> list = completions(expanded(dialog.path), dialog);
    const bool entered =
        ImGui::InputText("##path", &dialog.path,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion |
                             ImGuiInputTextFlags_CallbackHistory | ImGuiInputTextFlags_CallbackEdit,
                         complete_field, &dialog);
    // Focus selects all; one wants to go on typing behind the last slash.
    if (ImGuiInputTextState* field = ImGui::GetInputTextState(ImGui::GetItemID());
        field && dialog.to_end && ImGui::IsItemActive()) {
      field->Stb.cursor = field->Stb.select_start = field->Stb.select_end = field->CurLenW;
      dialog.to_end = false;
    }
    const float rows = 7 * px(24);
    std::string chosen;
    ImGui::BeginChild("##completions", {0, rows});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
    if (list.empty())
      label(asked.reads ? "No such file or folder starts like that" : "A new file", colour::text_faint);
    for (int i = 0; i < static_cast<int>(list.size()); ++i) {
      const Completion& c = list[static_cast<size_t>(i)];
      ImGui::PushID(i);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float w = ImGui::GetContentRegionAvail().x;
      if (ImGui::Selectable("##entry", i == dialog.marked, ImGuiSelectableFlags_DontClosePopups, {w, px(24)}))
        chosen = c.path;
      if (i == dialog.marked) ImGui::SetScrollHereY(0.5f);
      draw_text(ImGui::GetWindowDrawList(), {at.x + px(8), at.y}, {at.x + w, at.y + px(24)},
                elided(c.name, w - px(16)), c.folder ? colour::text_dim : colour::text);
      ImGui::PopID();
    }
    ImGui::PopStyleVar();
    ImGui::EndChild();

    bool done = false, accept = entered;
    if (entered && dialog.marked >= 0 && dialog.marked < static_cast<int>(list.size()))
      chosen = list[static_cast<size_t>(dialog.marked)].path;
    if (!chosen.empty()) {
      dialog.path = chosen, dialog.marked = -1;
      accept = !is_folder(chosen);
      ImGui::ClearActiveID();
      dialog.focus = true;  // the field takes the focus again, with the new text
    }
    const float w = px(96);
    ImGui::SetCursorPosX(ImGui::GetWindowWidth() - 2 * w - px(24));
    if (button("##cancel", "Cancel", false, w)) done = true;
    ImGui::SameLine(0, px(8));
    if (button("##accept", asked.answer, true, w)) accept = true;
    if (ui.pressed(GLFW_KEY_ESCAPE)) done = true;
    if (accept && !dialog.path.empty()) {
      const std::string file = expanded(dialog.path);
      if (is_folder(file)) {
        if (dialog.path.back() != '/') dialog.path += '/';
        dialog.focus = true;
        ImGui::ClearActiveID();
      } else {
        ui.act(asked.command, file);
        done = true;
      }
    }
    if (done) dialog = {}, ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (dialog.focus) ui.wake(3);
  } else {
    dialog = {};
  }
  ImGui::PopStyleVar(4);
}

constexpr float k_key_text = 400;  // of the solvers' rows

/// Keys and what they do; rows without keys are gaps.
std::vector<std::pair<std::string, std::string>> key_rows() {
  std::vector<std::pair<std::string, std::string>> rows = {
      {"Left drag", "orbit about what the pointer is on"},
      {"Right drag", "look about"},
      {"Middle drag, Shift + left drag", "pan"},
      {"Wheel", "come closer to what the pointer is on, go away"},
      {"W A S D, Q E", "fly; down and up; wheel for speed, Shift for four times as fast"},
      {"H", "walk along the floor instead; Q E set the eye's height"},
      {"Alt while moving", "pass through walls"},
      {"Ctrl + left drag", "turn the environment, or else the sun"},
      {"Click", "select the object, its material with a second click"},
      {"F", "frame the selection, or the scene"},
      {"L", "mark lamps and surfaces that emit, to click on them; lamps are dragged"},
      {"Drag on a lamp's mark",
       "move it along the picture; with Shift up and down; a spot's aim over surfaces"},
      {"T", "show the tiles at work"},
      {"1 \xE2\x80\x93 9", "scene cameras"},
      {"Ctrl + B", "bookmark this view; they are in the menu Camera"},
      {"B", "exposure by a click on something grey"}};
  bool panels = false, asks = false;
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    panels = panels || solver->has_panel();
    // All of a kind in one row, or in as many as they take.
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
      asks = asks || view.asks_pointer;
    }
    end_row();
    for (const solvers::CommandInfo& command : solver->commands) add(command.shortcut, command.label);
    end_row();
  }
  if (asks) rows.emplace_back("Pointer at rest", "while these views are shown: what lies there");
  if (panels) rows.emplace_back("K", "the panels of solvers in use, the scene's");
  for (const auto& row : std::initializer_list<std::pair<const char*, const char*>>{
           {"", ""},
           {"Space", "pause, resume"},
           {"R", "start the picture again"},
           {"U", "the samples as they are, without the preview"},
           {"Tab", "panels"},
           {"F5", "reload shaders"},
           {"F12", "screenshot of the window"},
           {"Ctrl + O, Ctrl + S", "open, save"},
           {"Ctrl + L", "type a command"},
           {"Ctrl + Z, Ctrl + Shift + Z", "undo, redo"},
           {"Esc", "take away a message or the selection, give up a load"},
           {"", ""},
           {"Double-click a number", "type it"},
           {"Shift, Ctrl while dragging", "ten times finer, coarser"}})
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
    // Columns as wide as their texts, as far as the window has room; longer texts take more lines.
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

bool panel_section(Ui& ui, const char* title, bool fallback, const std::string& note) {
  const auto found = ui.sections.find(title);
  const bool open = found == ui.sections.end() ? fallback : found->second;
  bool wanted = open;
  section(title, wanted, note);
  if (wanted != open) ui.act("window.section", title, wanted);
  return open;
}

void Ui::start_dialog(Dialog::Purpose purpose, const solvers::SolverInfo* solver) {
  dialog = {};
  dialog.purpose = purpose;
  dialog.solver = solver;
  dialog.fresh = true;
  std::error_code error;
  if (purpose == Dialog::Purpose::open) {
    const fs::path here =
        scene && !scene->file.empty() ? fs::path(scene->file).parent_path() : fs::path("scenes");
    if (fs::is_directory(here, error)) dialog.path = (here / "").string();
  } else if (purpose == Dialog::Purpose::reference || purpose == Dialog::Purpose::solver_load) {
    dialog.path = fs::current_path(error).string() + "/";
  } else if (purpose == Dialog::Purpose::script) {
    dialog.path = (scene ? scene->name : "session") + ".lucerna";
  } else if (scene) {
    dialog.path = scene->name + question(dialog).endings[0];
  }
  wake(4);
}

void draw_dialogs(Ui& ui) {
  file_dialog(ui);
  key_page(ui);
}

bool Ui::pressed(int key, int mods) const {
  const int heeded = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
  return std::any_of(keys.begin(), keys.end(),
                     [&](const auto& k) { return k.first == key && (k.second & heeded) == mods; });
}

namespace {

/// Views and commands of the solvers in use. Where two have the same key it is that of the one whose panel is
/// shown, or else of the first.
void solver_keys(Ui& ui) {
  std::vector<const solvers::SolverInfo*> used;
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (ui.uses(*solver)) used.insert(ui.side == solver->name ? used.begin() : used.end(), solver);
  std::set<char> taken;
  const auto pressed = [&](char shortcut) {  // letters are GLFW's names of their keys
    return shortcut && ui.pressed(shortcut) && taken.insert(shortcut).second;
  };
  for (const solvers::SolverInfo* solver : used) {
    for (const solvers::ViewInfo& view : solver->views)
      if (pressed(view.shortcut)) ui.turn_view(view);
    for (const solvers::CommandInfo& command : solver->commands)
      if (pressed(command.shortcut)) ui.act(solver->name + "." + command.name);
  }
}

}  // namespace

void handle_keys(Ui& ui) {
  const bool popup = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  if (ui.pressed(GLFW_KEY_F12)) ui.act("screenshot");
  if (ui.pressed(GLFW_KEY_F5)) ui.act("shaders.reload");
  if (ui.dialog.purpose != Dialog::Purpose::none) return;
  if (ui.pressed(GLFW_KEY_O, GLFW_MOD_CONTROL)) ui.act("dialog.open");
  if (ui.pressed(GLFW_KEY_S, GLFW_MOD_CONTROL) && ui.has_picture()) ui.act("dialog.save");
  if (ui.pressed(GLFW_KEY_L, GLFW_MOD_CONTROL)) ui.act("log.type");
  if (ui.pressed(GLFW_KEY_Q, GLFW_MOD_CONTROL)) ui.act("quit");
  if (popup && ui.pressed(GLFW_KEY_ESCAPE)) ImGui::ClosePopupToLevel(0, true);
  if (ImGui::GetIO().WantTextInput || popup) return;
  for (const auto& [key, mods] : ui.keys)
    if (key == GLFW_KEY_Z && mods & GLFW_MOD_CONTROL) {
      const bool again = mods & GLFW_MOD_SHIFT;
      if (again ? ui.can_redo() : ui.can_undo()) ui.act(again ? "redo" : "undo");
    }
  if (ui.pressed(GLFW_KEY_F1)) ui.act("window.keys");
  if (ui.pressed(GLFW_KEY_TAB)) ui.act("window.panels", !ui.layout.panels), ui.wake(3);
  if (ui.pressed(GLFW_KEY_ESCAPE)) {
    if (ui.welcome)
      ui.welcome = false;
    else if (ui.dropper)
      ui.act("exposure.dropper", false);
    else if (ui.loading())
      ui.act("scene.cancel");
    else if (!ui.errors.empty())
      ui.act("dismiss");
    else if (ui.selection.kind != Kind::none)
      ui.act("select.none");
  }
  if (!ui.snapshot) return;
  if (ui.pressed(GLFW_KEY_F) && ui.view) ui.act("camera.frame");
  if (ui.pressed(GLFW_KEY_H) && ui.view) ui.act("camera.walking", !ui.walking);
  if (ui.pressed(GLFW_KEY_B, GLFW_MOD_CONTROL) && ui.view) keep_view(ui);
  if (ui.pressed(GLFW_KEY_B) && ui.view) ui.act("exposure.dropper", !ui.dropper);
  if (ui.pressed(GLFW_KEY_R)) ui.act("render.restart");
  if (ui.pressed(GLFW_KEY_L)) ui.act("view.lamps", !ui.light_marks);
  if (ui.pressed(GLFW_KEY_T)) ui.toggle("overlay.tiles");
  if (ui.pressed(GLFW_KEY_U))
    ui.act("set", "preview.filter", ui.setting("preview.filter") == "off" ? "auto" : "off");
  solver_keys(ui);
  if (ui.pressed(GLFW_KEY_K)) ui.act("window.side", ui.next_side());
  if (ui.pressed(GLFW_KEY_SPACE)) ui.act(ui.snapshot->paused ? "render.resume" : "render.pause");
  for (int n = 0; n < 9; ++n)
    if (ui.pressed(GLFW_KEY_1 + n) && ui.scene && n < static_cast<int>(ui.scene->cameras.size()) && ui.view)
      ui.act("camera.select", n + 1);
}

void draw_splitters(Ui& ui, const Areas& areas) {
  // A strip over each border, in a window of its own so that it lies above both neighbours.
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
