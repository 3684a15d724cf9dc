// The file dialogs: a field with completion, places, and the program's scenes as pictures.
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "assets.h"
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

/// The texts and the command of a dialog, by its purpose.
struct Question {
  std::string title, note;
  std::string command, answer;  ///< run with the file; label of its button
  std::vector<std::string> endings;
  bool reads = false;       ///< the file must exist
  bool thumbnails = false;  ///< its files are images
};

Question question(const Dialog& dialog) {
  using Purpose = Dialog::Purpose;
  switch (dialog.purpose) {
    case Purpose::none:
      break;
    case Purpose::open:
      return {.title = "Open a scene",
              .note = "A .gltf or .glb file. Tab completes; arrows choose.",
              .command = "window.open",
              .answer = "Open",
              .endings = {".gltf", ".glb"},
              .reads = true};
    case Purpose::save:
      return {
          .title = "Save the picture",
          .note =
              ".exr stores all layers as unprocessed floats; .png the picture with exposure and tone curve.",
          .command = "image.save",
          .answer = "Save",
          .endings = {".exr", ".png"}};
    case Purpose::scene:
      return {.title = "Save the scene",
              .note = "A .gltf or .glb file with the edits; all else in the scene's file is kept.",
              .command = "scene.save",
              .answer = "Save",
              .endings = {".gltf", ".glb"}};
    case Purpose::script:
      return {.title = "Save the session as a script",
              .note = "The commands of this session, one per line; lucerna --script FILE repeats them.",
              .command = "script.save",
              .answer = "Save",
              .endings = {".lucerna"}};
    case Purpose::test:
      return {
          .title = "Save the session as a test",
          .note =
              "A script that repeats this session and expects the present picture, which is saved beside it.",
          .command = "script.save_test",
          .answer = "Save",
          .endings = {".lucerna"}};
    case Purpose::reference:
      return {.title = "Load a reference",
              .note = "A converged .exr of this view and size, rendered with another seed.",
              .command = "reference.load",
              .answer = "Load",
              .endings = {".exr"},
              .reads = true};
    case Purpose::held:
      return {.title = "Hold the picture of a file",
              .note = "An .exr, .hdr or .png of this size, such as a saved picture or a reference.",
              .command = "compare.load",
              .answer = "Hold",
              .endings = {".exr", ".hdr", ".png"},
              .reads = true};
    case Purpose::environment:
      return {.title = "Light the scene by an image",
              .note = "A latitude-longitude image, twice as wide as high (.exr or .hdr).",
              .command = "environment.load",
              .answer = "Load",
              .endings = {".exr", ".hdr"},
              .reads = true,
              .thumbnails = true};
    case Purpose::value:
      return {.title = dialog.title,
              .note = fmt::format("A file that ends in {}.", fmt::join(dialog.endings, " or ")),
              .command = dialog.line,
              .answer = "Choose",
              .endings = dialog.endings,
              .reads = true,
              .thumbnails = dialog.endings.front() == ".png"};
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

/// Files of the kind, and folders, that begin with the typed text.
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

/// Tab inserts the marked entry, or the common beginning of all entries; arrows mark. Uses the current text,
/// which may be newer than the displayed list.
int complete_field(ImGuiInputTextCallbackData* data) {
  auto& dialog = *static_cast<Dialog*>(data->UserData);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackEdit) dialog.marked = -1, dialog.pictures = false;
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

/// The folder that a path names or lies in, absolute.
fs::path folder_of(const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path.empty() ? "." : path, error);
  return whole.has_filename() ? whole.parent_path() : whole.parent_path().lexically_normal();
}

/// As shown in the field: with a slash at the end.
std::string as_typed(const fs::path& folder) { return (folder / "").lexically_normal().string(); }

void go_to(Dialog& dialog, const fs::path& folder) {
  std::string rest;
  // A new file's name stays when another folder is chosen.
  if (!question(dialog).reads) rest = fs::path(dialog.path).filename().string();
  dialog.path = as_typed(folder) + rest;
  dialog.marked = -1, dialog.pictures = false, dialog.focus = true;
  ImGui::ClearActiveID();
}

/// One line of a list. Returns true if it was pressed.
bool row(const char* id, const std::string& text, bool on, ImU32 ink, const std::string& help = "") {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float w = ImGui::GetContentRegionAvail().x;
  const bool pressed = ImGui::Selectable(id, on, ImGuiSelectableFlags_DontClosePopups, {w, px(24)});
  tooltip(help);
  draw_text(ImGui::GetWindowDrawList(), {at.x + px(8), at.y}, {at.x + w, at.y + px(24)},
            elided(text, w - px(16)), ink);
  return pressed;
}

/// Places, on the left.
void places(const commands::OpenScene& open, const std::vector<std::string>& recent, Dialog& dialog,
            std::string& chosen) {
  const bool opens = dialog.purpose == Dialog::Purpose::open;
  const fs::path here = folder_of(expanded(dialog.path));
  std::error_code error;
  const auto place = [&](const char* id, const char* name, const fs::path& folder) {
    if (folder.empty() || !fs::is_directory(folder, error)) return;
    const bool on = !dialog.pictures && fs::equivalent(folder, here, error);
    if (row(id, name, on, on ? colour::text : colour::text_dim, folder.string())) go_to(dialog, folder);
  };
  if (opens && !gallery().empty() &&
      row("##scenes", "Lucerna's scenes", dialog.pictures, dialog.pictures ? colour::text : colour::text_dim,
          "Scenes that come with the program."))
    dialog.pictures = true;
  const char* home = std::getenv("HOME");
  place("##home", "Home", home ? home : "");
  place("##working", "Working folder", fs::current_path(error));
  if (open.scene && !open.scene->file.empty())
    place("##of_scene", "The scene's folder", folder_of(open.scene->file));
  place("##root", "Computer", "/");
  if (!opens || recent.empty()) return;
  gap(6);
  label("  Recent", colour::text_faint, theme().fonts.small);
  gap(2);
  const std::vector<std::string> files = recent;
  for (size_t i = 0; i < files.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (row("##recent", fs::path(files[i]).filename().string(), false, colour::text_dim, files[i]))
      chosen = files[i];
    ImGui::PopID();
  }
}

/// The program's scenes as pictures with their names.
void pictures(const PictureOf& picture_of, std::string& chosen) {
  const float space = px(8), all = ImGui::GetContentRegionAvail().x;
  const float across = std::max(1.0f, std::floor((all + space) / (px(150) + space)));
  const float w = std::floor((all + space) / across) - space, h = std::floor(w * 9 / 16);
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (size_t i = 0; i < gallery().size(); ++i) {
    const GalleryScene& scene = gallery()[i];
    const float column = static_cast<float>(i % static_cast<size_t>(across)),
                line = static_cast<float>(i / static_cast<size_t>(across));
    const ImVec2 lo(origin.x + column * (w + space), origin.y + line * (h + px(28)));
    const ImVec2 hi(lo.x + w, lo.y + h);
    ImGui::SetCursorScreenPos(lo);
    ImGui::PushID(scene.name.c_str());
    if (ImGui::InvisibleButton("##picture", {w, h + px(22)})) chosen = scene.file.string();
    const bool hovered = ImGui::IsItemHovered();
    tooltip(scene.file.string());
    ImGui::PopID();
    if (const unsigned texture = picture_of ? picture_of(scene.picture.string()) : 0)
      list->AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(texture)), lo, hi, {0, 0},
                            {1, 1}, IM_COL32_WHITE, px(3));
    else
      list->AddRectFilled(lo, hi, colour::field, px(3));
    if (hovered) list->AddRect(lo, hi, colour::accent, px(3), 0, px(1.5f));
    draw_text(list, {lo.x, hi.y}, {hi.x, hi.y + px(22)}, capitalised(scene.name),
              hovered ? colour::text : colour::text_dim);
  }
}

/// The images of a list as pictures with their names, below its folders.
void thumbnails(const std::vector<Completion>& list, int marked, const PictureOf& thumbnail_of,
                std::string& chosen) {
  const float space = px(8), all = ImGui::GetContentRegionAvail().x - px(8);
  const float across = std::max(1.0f, std::floor((all + space) / (px(120) + space)));
  const float w = std::floor((all + space) / across) - space, h = std::floor(0.6f * w);
  ImDrawList* draw = ImGui::GetWindowDrawList();
  int column = 0;
  for (int i = 0; i < static_cast<int>(list.size()); ++i) {
    const Completion& c = list[static_cast<size_t>(i)];
    if (c.folder) continue;
    if (column % int(across) != 0) ImGui::SameLine(0, space);
    ++column;
    const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + w, lo.y + h);
    ImGui::PushID(i);
    if (ImGui::InvisibleButton("##thumbnail", {w, h + px(24)})) chosen = c.path;
    const bool shown = ImGui::IsItemVisible(), hovered = ImGui::IsItemHovered();
    tooltip(c.path);
    if (i == marked) ImGui::SetScrollHereY(0.5f);
    ImGui::PopID();
    if (!shown) continue;
    if (const unsigned texture = thumbnail_of ? thumbnail_of(c.path) : 0)
      draw->AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(texture)), lo, hi, {0, 0},
                            {1, 1}, IM_COL32_WHITE, px(2));
    else
      draw->AddRectFilled(lo, hi, colour::field, px(2));
    if (hovered || i == marked) draw->AddRect(lo, hi, colour::accent, px(2), 0, px(1.5f));
    draw_text(draw, {lo.x, hi.y}, {hi.x, hi.y + px(22)}, elided(c.name, w),
              hovered || i == marked ? colour::text : colour::text_dim);
  }
}

/// Files and folders that begin with the typed text, below the parent folder.
void files(Dialog& dialog, const Question& asked, const std::vector<Completion>& list,
           const PictureOf& thumbnail_of, std::string& chosen) {
  const fs::path here = folder_of(expanded(dialog.path));
  std::error_code error;
  if (here.has_relative_path() &&
      row("##parent", "\xE2\x86\x91  Parent folder", false, colour::text_dim, here.parent_path().string()))
    go_to(dialog, here.parent_path());
  if (list.empty()) {
    const bool whole = dialog.path.empty() || dialog.path.back() == '/';
    const std::string text = !fs::is_directory(here, error) ? "There is no such folder"
                             : !asked.reads                 ? "A new file"
                             : whole
                                 ? fmt::format("No file here ends in {}", fmt::join(asked.endings, " or "))
                                 : "No file here begins with this";
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy({1, px(24)});
    draw_text(ImGui::GetWindowDrawList(), {at.x + px(8), at.y}, {at.x + px(400), at.y + px(24)}, text,
              colour::text_faint);
  }
  for (int i = 0; i < static_cast<int>(list.size()); ++i) {
    const Completion& c = list[static_cast<size_t>(i)];
    if (asked.thumbnails && !c.folder) continue;
    ImGui::PushID(i);
    if (row("##entry", c.name, i == dialog.marked, c.folder ? colour::text_dim : colour::text))
      chosen = c.path;
    if (i == dialog.marked) ImGui::SetScrollHereY(0.5f);
    ImGui::PopID();
  }
  if (asked.thumbnails) thumbnails(list, dialog.marked, thumbnail_of, chosen);
}

/// The way a PNG is saved.
void way_of_saving(Dialog& dialog) {
  if (dialog.purpose != Dialog::Purpose::save || fs::path(dialog.path).extension() != ".png") return;
  const float w = px(112);
  if (button("##shown", "As shown", dialog.as_shown, w)) dialog.as_shown = true;
  tooltip("As the window shows it: with few samples their noise is filtered.");
  ImGui::SameLine(0, px(4));
  if (button("##unfiltered", "Unfiltered", !dialog.as_shown, w)) dialog.as_shown = false;
  tooltip("The unfiltered samples.");
}

}  // namespace

void draw_file_dialog(Actions& actions, const commands::OpenScene& open,
                      const std::vector<std::string>& recent, std::map<std::string, std::string>& folders,
                      const PictureOf& picture_of, const PictureOf& thumbnail_of, Dialog& dialog,
                      bool escape) {
  if (dialog.purpose == Dialog::Purpose::none) return;
  const Question asked = question(dialog);
  // Each dialog has a separate field, so texts typed into one do not appear in another.
  const std::string title = "##" + asked.command;
  if (dialog.fresh) ImGui::OpenPopup(title.c_str()), dialog.fresh = false, dialog.focus = true;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float width = std::min(px(760), window.x - px(48));
  const float top = std::floor(std::min(0.18f * window.y, window.y - px(380)));
  ImGui::SetNextWindowPos({std::floor(0.5f * (window.x - width)), std::max(px(12), top)});
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
      label(dialog.purpose == Dialog::Purpose::script || dialog.purpose == Dialog::Purpose::test
                ? "A file of that name exists; it is replaced if it is of the same kind."
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
    // Focus selects the whole text; move the cursor behind the last slash instead.
    if (ImGuiInputTextState* field = ImGui::GetInputTextState(ImGui::GetItemID());
        field && dialog.to_end && ImGui::IsItemActive()) {
      field->Stb.cursor = field->Stb.select_start = field->Stb.select_end = field->CurLenW;
      dialog.to_end = false;
    }
    // The list takes the rest of the window's height.
    const float above = ImGui::GetCursorScreenPos().y, below = px(56);
    const float most = dialog.purpose == Dialog::Purpose::open || asked.thumbnails ? 13 : 9;
    const float rows = std::clamp(window.y - above - below - px(24), 3 * px(24), most * px(24));
    std::string chosen;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
    if (width > px(520)) {
      ImGui::BeginChild("##places", {px(176), rows});
      places(open, recent, dialog, chosen);
      ImGui::EndChild();
      ImGui::SameLine(0, px(12));
    }
    ImGui::BeginChild("##completions", {0, rows});
    if (dialog.pictures)
      pictures(picture_of, chosen);
    else
      files(dialog, asked, list, thumbnail_of, chosen);
    ImGui::EndChild();
    ImGui::PopStyleVar();
    gap(4);

    bool done = false, accept = entered;
    if (entered && dialog.marked >= 0 && dialog.marked < static_cast<int>(list.size()))
      chosen = list[static_cast<size_t>(dialog.marked)].path;
    if (!chosen.empty()) {
      dialog.path = chosen, dialog.marked = -1;
      accept = !is_folder(chosen);
      ImGui::ClearActiveID();
      dialog.focus = true;  // the field takes the focus again, with the new text
    }
    const float w = px(96), line = ImGui::GetCursorPosY();
    way_of_saving(dialog);
    ImGui::SetCursorPos({ImGui::GetWindowWidth() - 2 * w - px(24), line});
    if (button("##cancel", "Cancel", false, w)) done = true;
    ImGui::SameLine(0, px(8));
    if (button("##accept", asked.answer, true, w)) accept = true;
    if (escape) done = true;
    if (accept && !dialog.path.empty()) {
      const std::string file = expanded(dialog.path);
      if (is_folder(file)) {
        if (dialog.path.back() != '/') dialog.path += '/';
        dialog.focus = true;
        ImGui::ClearActiveID();
      } else {
        if (dialog.purpose == Dialog::Purpose::save && dialog.as_shown &&
            fs::path(file).extension() == ".png")
          actions.act(asked.command, file, named("as", "shown"));
        else if (dialog.purpose == Dialog::Purpose::scene)
          actions.act(asked.command, named("file", file),
                      named("replace", fs::is_regular_file(file, ignored)));
        else if (dialog.purpose == Dialog::Purpose::value)
          actions.act_line(dialog.line + commands::quote(fs::absolute(file, ignored).string()));
        else
          actions.act(asked.command, file);
        if (asked.thumbnails || dialog.purpose == Dialog::Purpose::value)
          folders[asked.endings.front()] = as_typed(folder_of(file));
        done = true;
      }
    }
    if (done) dialog = {}, ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (dialog.focus) actions.wake(3);
  } else {
    dialog = {};
  }
  ImGui::PopStyleVar(4);
}

void Ui::choose_file(const std::string& line, const std::string& what,
                     const std::vector<std::string>& endings) {
  start_dialog(Dialog::Purpose::value, nullptr, line, what, endings);
}

void Ui::start_dialog(Dialog::Purpose purpose, const solvers::SolverInfo* solver, const std::string& line,
                      const std::string& what, const std::vector<std::string>& endings) {
  dialog = {};
  dialog.purpose = purpose;
  dialog.solver = solver;
  dialog.fresh = true;
  std::error_code error;
  if (purpose == Dialog::Purpose::open) {
    // The program's scenes are shown while no other scene is open.
    const fs::path here =
        open.scene && !open.scene->file.empty() ? folder_of(open.scene->file) : fs::current_path(error);
    if (fs::is_directory(here, error)) dialog.path = as_typed(here);
    dialog.pictures =
        !gallery().empty() && (!open.scene || open.scene->file.empty() ||
                               std::any_of(gallery().begin(), gallery().end(), [&](const GalleryScene& own) {
                                 return fs::equivalent(own.file, open.scene->file, error);
                               }));
  } else if (purpose == Dialog::Purpose::environment || purpose == Dialog::Purpose::value) {
    dialog.line = line, dialog.title = what, dialog.endings = endings;
    const auto last = folders.find(question(dialog).endings.front());
    const fs::path own =
        open.scene && !open.scene->file.empty() ? folder_of(open.scene->file) : fs::current_path(error);
    dialog.path =
        as_typed(last != folders.end() && fs::is_directory(last->second, error) ? fs::path(last->second)
                                                                                : fs::absolute(own, error));
  } else if (purpose == Dialog::Purpose::reference || purpose == Dialog::Purpose::held ||
             purpose == Dialog::Purpose::solver_load) {
    dialog.path = fs::current_path(error).string() + "/";
  } else if (purpose == Dialog::Purpose::script || purpose == Dialog::Purpose::test) {
    dialog.path = (open.scene ? open.scene->name : "session") + ".lucerna";
  } else if (purpose == Dialog::Purpose::scene) {
    dialog.path = work.scene_file.file();
  } else if (open.scene) {
    dialog.path = open.scene->name + question(dialog).endings[0];
  }
  wake(4);
}

}  // namespace lucerna::ui
