// The bar on top: menus, the scene's name, the device and the state of the picture.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "chart.h"
#include "film/io/ocio.h"
#include "plan/views.h"
#include "shown_text.h"
#include "solvers/registry.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// Smaller in a low window.
float entry_height() { return px(ImGui::GetIO().DisplaySize.y < px(560) ? 22 : 26); }

/// One entry of a menu with its keys and a tooltip; a tick on the left if it is on.
bool entry(const char* name, const char* keys, const char* help, bool on = false, bool enabled = true) {
  const float width = std::max(px(232), ImGui::GetContentRegionAvail().x), height = entry_height();
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + height);
  ImGui::BeginDisabled(!enabled);
  ImGui::PushID(name);
  const bool pressed = ImGui::Selectable("##entry", false, 0, {width, height});
  ImGui::PopID();
  ImGui::EndDisabled();
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (on) draw_sign(list, {lo.x + px(13), 0.5f * (lo.y + hi.y)}, px(10), Sign::tick, true, colour::accent);
  draw_text(list, {lo.x + px(26), lo.y}, hi, name, enabled ? colour::text : colour::text_faint);
  if (keys) draw_text(list, lo, {hi.x - px(10), hi.y}, keys, colour::text_faint, Align::right);
  tooltip(help);
  return pressed;
}

/// A line between groups.
void divide() {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = std::max(px(232), ImGui::GetContentRegionAvail().x);
  ImGui::Dummy({width, px(9)});
  ImGui::GetWindowDrawList()->AddLine({at.x, at.y + px(4)}, {at.x + width, at.y + px(4)}, colour::grey(58));
}

bool begin_menu(const char* name) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(4), px(4)});
  const bool open = ImGui::BeginMenu(name);
  if (open)
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
  else
    ImGui::PopStyleVar();
  return open;
}

/// A submenu in place of an entry; end_submenu() if it is open.
bool begin_submenu(const char* name, const char* help, bool enabled = true) {
  const float space = ImGui::GetFontSize(), height = entry_height();
  // ImGui makes room for the text and extends its row by half of the spacing on both sides.
  const float above = std::floor(0.5f * (height - space));
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() + above);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, height - space});
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 at(ImGui::GetCursorScreenPos().x + px(26), ImGui::GetCursorScreenPos().y);
  const bool open = ImGui::BeginMenu((std::string("##") + name).c_str(), enabled);
  ImGui::PopStyleVar();
  draw_text(list, at, {at.x + px(206), at.y + space}, name, enabled ? colour::text : colour::text_faint);
  if (!open) {
    tooltip(help);
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() - above);
  }
  return open;
}

void end_submenu() {
  ImGui::EndMenu();
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() - std::floor(0.5f * (entry_height() - ImGui::GetFontSize())));
}

void end_menu() {
  ImGui::PopStyleVar();
  ImGui::EndMenu();
  ImGui::PopStyleVar();
}

/// A key's name for a menu; valid until the next call.
const char* key_name(char shortcut) {
  static char name[2];
  name[0] = shortcut, name[1] = 0;
  return shortcut ? name : nullptr;
}

/// The displays and views of $OCIO, with the tone curve; nothing if it is not set.
void ocio_menu(Actions& actions, const commands::OpenScene& open) {
  static const bool has_ocio = [] {
    const char* file = std::getenv("OCIO");
    return file && *file;
  }();
  if (!has_ocio ||
      !begin_submenu("OCIO display", "Displays and views of the configuration that $OCIO names."))
    return;
  const std::string& chosen = open.setting("film.ocio");
  if (entry("Tone curve", nullptr, "The picture by its tone curve, without OCIO.", chosen.empty()))
    actions.act("view.ocio", "off");
  try {
    const auto config = film::ocio_config();
    for (const film::OcioDisplay& display : config->displays()) {
      divide();
      for (const std::string& view : display.views) {
        const std::string text = film::ocio_text(display.name, view);
        const bool on = chosen == text || (chosen == display.name && view == display.views.front());
        if (entry(elided(text, px(240)).c_str(), nullptr, config->file().c_str(), on))
          actions.act("view.ocio", display.name, view);
      }
    }
  } catch (const Error& e) {
    entry("No configuration", nullptr, e.what(), false, false);
  }
  end_submenu();
}

/// Loading and saving the work of solvers that can store it in files.
void solver_files(Actions& actions, const commands::OpenScene& open, bool picture) {
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    if (!solver->file) continue;
    const bool used = open.uses(*solver) && picture;
    const solvers::Report* report = open.report(*solver);
    const bool complete = used && report && report->ready;
    const std::string unused = fmt::format("No component is computed by {}.", solver->name);
    const std::string name = uncapitalised(solver->label);
    ImGui::PushID(solver->name.c_str());
    if (entry(("Load " + name + "\xE2\x80\xA6").c_str(), nullptr,
              used
                  ? fmt::format("Loads {} from a file {}.", solver->file->content, solver->file->fits).c_str()
                  : unused.c_str(),
              false, used))
      actions.act("dialog." + solver->name + "_load");
    if (entry(("Save " + name + "\xE2\x80\xA6").c_str(), nullptr,
              complete
                  ? fmt::format("Saves {}, so this scene need not compute them again.", solver->file->content)
                        .c_str()
              : used ? fmt::format("{} is not complete yet.", capitalised(solver->title)).c_str()
                     : unused.c_str(),
              false, complete))
      actions.act("dialog." + solver->name + "_save");
    ImGui::PopID();
    divide();
  }
}

void file_menu(Actions& actions, const commands::OpenScene& open, const commands::SceneFile& file,
               const std::vector<std::string>& recent, bool picture) {
  if (!begin_menu("File")) return;
  if (entry("Open\xE2\x80\xA6", "Ctrl+O",
            "Opens a glTF scene (.gltf or .glb). A file dropped on the window opens too."))
    actions.act("dialog.open");
  const std::vector<std::string> files = recent;
  if (!files.empty()) divide();
  for (size_t i = 0; i < std::min<size_t>(files.size(), 5); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const std::string name = std::filesystem::path(files[i]).filename().string();
    if (entry(elided(name, px(240)).c_str(), nullptr, files[i].c_str())) actions.act("window.open", files[i]);
    ImGui::PopID();
  }
  divide();
  if (entry(
          "Save scene", "Ctrl+Shift+S",
          file.unsaved() ? ("Saves the edits in " + file.file() + ".").c_str() : "There is nothing to save.",
          false, picture))
    actions.act("scene.save");
  if (entry("Save scene as\xE2\x80\xA6", nullptr,
            "Saves the scene with its edits as another .gltf or .glb file.", false, picture))
    actions.act("dialog.scene");
  divide();
  if (entry("Save picture\xE2\x80\xA6", "Ctrl+S",
            "Saves the present picture: all layers as EXR, or the displayed one as PNG.", false, picture))
    actions.act("dialog.save");
  if (entry("Screenshot", "F12", "Saves the window with its panels as a PNG in the working folder."))
    actions.act("screenshot");
  const std::string viewer = open.snapshot ? open.snapshot->tev : "";
  if (entry("Send to tev", nullptr,
            viewer.empty()
                ? "Sends all layers to a running tev (127.0.0.1:14158) while the picture is rendered."
                : ("Sends all layers to " + viewer + "; select it again to end this.").c_str(),
            !viewer.empty(), picture))
    actions.act(viewer.empty() ? "tev.send" : "tev.stop");
  divide();
  const session::Accuracy* accuracy = open.snapshot ? open.snapshot->accuracy.get() : nullptr;
  const bool reference = accuracy && !accuracy->reference.empty();
  if (entry("Load reference\xE2\x80\xA6", nullptr,
            "Loads a converged EXR of this view and size, rendered with another seed. The Accuracy plot then "
            "shows the true error too.",
            false, picture))
    actions.act("dialog.reference");
  if (entry("Clear reference", nullptr,
            reference ? ("Removes " + accuracy->reference + ".").c_str() : "No reference is loaded.", false,
            reference))
    actions.act("reference.clear");
  divide();
  solver_files(actions, open, picture);
  if (entry("Save session as script\xE2\x80\xA6", nullptr,
            "Saves the commands of this session, one per line; lucerna --script repeats them."))
    actions.act("dialog.script");
  if (entry(
          "Save session as test\xE2\x80\xA6", nullptr,
          "Saves a script that repeats this session and expects the present picture; lucerna script runs it.",
          false, picture))
    actions.act("dialog.test");
  divide();
  if (entry("Quit", "Ctrl+Q", "Closes the window and ends the render.")) actions.act("window.close");
  end_menu();
}

void edit_menu(Actions& actions, const commands::History& history, const Selection& selection) {
  if (!begin_menu("Edit")) return;
  if (entry("Undo", "Ctrl+Z",
            history.can_undo() ? ("Undoes: " + history.undo_text()).c_str() : "Nothing to undo.", false,
            history.can_undo()))
    actions.act("undo");
  if (entry("Redo", "Ctrl+Shift+Z",
            history.can_redo() ? ("Redoes: " + history.redo_text()).c_str() : "Nothing to redo.", false,
            history.can_redo()))
    actions.act("redo");
  divide();
  if (entry("Deselect", nullptr, "Clears the selection. A click in the picture selects an object.", false,
            selection.kind != Kind::none))
    actions.act("select.none");
  end_menu();
}

/// Views of a solver that can be drawn over the picture.
void solver_views(Controls& controls, const solvers::SolverInfo& solver) {
  for (size_t i = 0; i < solver.views.size(); ++i) {
    const solvers::ViewInfo& view = solver.views[i];
    const OptionInfo* option = plan::find_option(view.option);
    const std::string name = capitalised(view.label);
    if (option->type == OptionType::choice && view.ring.empty()) {
      // One entry per value; the key cycles through them, from the first.
      for (size_t k = 1; k < option->choices.size(); ++k) {
        const std::string& value = option->choices[k];
        const bool on = controls.open.setting(option->key) == value;
        if (entry(fmt::format("{}: {}", name, value).c_str(), k == 1 ? key_name(view.shortcut) : nullptr,
                  option->help.c_str(), on))
          controls.act("set", option->key, on ? option->choices.front() : value);
      }
    } else if (entry(name.c_str(), key_name(view.shortcut), option->help.c_str(), controls.view_on(view))) {
      controls.turn_view(view);
    }
    for (const std::string& key : view.refined_by) {
      // Behind the last of the views that it refines, if any of them is on.
      bool on = false, last = true;
      for (size_t k = 0; k < solver.views.size(); ++k) {
        const std::vector<std::string>& keys = solver.views[k].refined_by;
        if (std::find(keys.begin(), keys.end(), key) == keys.end()) continue;
        on = on || controls.view_on(solver.views[k]);
        last = last && k <= i;
      }
      const OptionInfo* by = plan::find_option(key);
      if (!on || !last || !by) continue;
      for (const std::string& choice : by->choices)
        if (entry(fmt::format("   {} {}", uncapitalised(option_label(*by)), choice).c_str(), nullptr,
                  by->help.c_str(), controls.open.setting(key) == choice))
          controls.act("set", key, choice);
    }
  }
}

/// "Irradiance cache" from "the irradiance cache".
std::string title_of(const solvers::SolverInfo& solver) {
  const std::string& title = solver.title;
  return capitalised(title.starts_with("the ") ? title.substr(4) : title);
}

/// `layout`: as chosen. `shown`: as it fits. `side`: content of the right panel. `earlier`: the plot has
/// earlier renders.
void view_menu(Controls& controls, const Viewport& view, const Layout& layout, const Layout& shown,
               const std::string& shown_side, bool earlier) {
  if (!begin_menu("View")) return;
  if (entry("Panels", "Tab", "Shows or hides all panels.", layout.panels))
    controls.act("window.panels", !layout.panels);
  if (entry("Components and options", nullptr,
            "The panel on the left: the four components of light and the options of the render.",
            shown.left_open))
    controls.act("window.fold", "left", shown.left_open);
  // Panels on the right; selecting the displayed one folds it.
  const auto side = [&](const std::string& name, const char* key, const std::string& help,
                        const std::string& what) {
    const bool on = shown.right_open && shown_side == what;
    ImGui::PushID(what.c_str());  // a solver may have the name of a panel
    const bool pressed = entry(name.c_str(), key, help.c_str(), on);
    ImGui::PopID();
    if (!pressed) return;
    if (on)
      controls.act("window.fold", "right", true);
    else
      controls.act("window.side", what);
  };
  side("Scene", nullptr, "Cameras, lights, environment, materials.", k_scene_side);
  side("Paths", nullptr, "Paths of a pixel, and what the noise comes from.", k_paths_side);
  side("Compare", nullptr, "Held results, and the picture against them.", k_compare_side);
  const std::string next = next_side(controls.open, shown_side, shown.right_open);
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->has_panel())
      side(title_of(*solver), next == solver->name || shown_side == solver->name ? "K" : nullptr,
           panel_help(*solver), solver->name);
  if (entry("Accuracy, passes and log", nullptr, "The strip at the bottom.", shown.bottom_open))
    controls.act("window.fold", "bottom", shown.bottom_open);
  divide();
  if (entry("Selection", nullptr, "Shows the box and the handles of the selected object.", view.brackets))
    controls.act("view.selection", !view.brackets);
  if (entry(
          "Lights", "L",
          "Marks lamps and emissive surfaces in the picture. Click a mark to select, drag it to move a lamp.",
          view.light_marks))
    controls.act("view.lamps", !view.light_marks);
  if (entry("Histogram", nullptr, "Shows how many pixels have which display value, and how many are clipped.",
            view.histogram.on))
    controls.act("view.histogram", !view.histogram.on);
  if (entry("Camera frame", nullptr,
            "Shows a frame with the camera's aspect ratio in the picture (command view.frame for another "
            "ratio).",
            view.frame_guide.on))
    controls.act("view.frame", !view.frame_guide.on);
  if (const OptionInfo* tiles = plan::find_option("overlay.tiles");
      entry("Tiles", "T", tiles->help.c_str(), controls.open.setting_on(tiles->key)))
    controls.actions.toggle(tiles->key);
  for (const solvers::ViewInfo& drawn : plan::views())
    if (entry(drawn.label.c_str(), nullptr, plan::find_option(drawn.option)->help.c_str(),
              controls.view_on(drawn)))
      controls.turn_view(drawn);
  if (const OptionInfo* former = plan::find_option("overlay.former"); entry(
          "Light from before the edit", nullptr, former->help.c_str(), controls.open.setting_on(former->key)))
    controls.actions.toggle(former->key);
  if (entry("Unfiltered samples", "U",
            "Shows samples only: no filter for noise, and no light from before an edit.",
            controls.open.setting("preview.filter") == "off"))
    controls.act("set", "preview.filter", controls.open.setting("preview.filter") == "off" ? "auto" : "off");
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    if (solver->views.empty()) continue;
    const bool used = controls.open.uses(*solver);
    ImGui::PushID(solver->name.c_str());
    if (begin_submenu((title_of(*solver) + ": views").c_str(),
                      fmt::format("No component is computed by {}.", solver->title).c_str(), used)) {
      solver_views(controls, *solver);
      end_submenu();
    }
    ImGui::PopID();
  }
  ocio_menu(controls.actions, controls.open);
  if (entry("Clear earlier renders", nullptr, "Removes the lines of earlier renders from the Accuracy plot.",
            false, earlier))
    controls.act("accuracy.clear_runs");
  divide();
  if (begin_submenu("Resolution", "Pixels of the picture per pixel of the window.")) {
    for (const auto& [divisor, name] : {std::pair{1, "Full"}, {2, "Half"}, {4, "Quarter"}})
      if (entry(name, nullptr, "Pixels of the picture per pixel of the window; fewer converge faster.",
                view.divisor == divisor))
        controls.act("view.divisor", divisor);
    end_submenu();
  }
  end_menu();
}

void camera_menu(Actions& actions, const commands::OpenScene& open, const commands::Navigation& camera,
                 Viewport& viewport) {
  if (!begin_menu("Camera")) return;
  const bool view = camera.view.has_value();
  if (entry("Frame selection", "F",
            "Moves the camera so that the selection, or otherwise the whole scene, fills the picture. The "
            "camera stays in front of walls.",
            false, view))
    actions.act("camera.frame");
  if (entry("Walk along the floor", "H", "W A S D walk at eye height instead of flying.", camera.walking,
            view))
    actions.act("camera.walking", !camera.walking);
  const bool lens = view && camera.view->camera.perspective();
  if (entry("Focus by a click", nullptr, "The next click in the picture puts the plane of focus there.",
            viewport.scene_view.focusing, lens))
    actions.act("camera.focusing", !viewport.scene_view.focusing);
  if (entry("Turntable", nullptr,
            viewport.moves.turntable() > 0 ? "Stops the camera."
                                           : "Turns the camera about what it looks at, in 20 seconds.",
            viewport.moves.turntable() > 0, view))
    actions.act("camera.turntable", viewport.moves.turntable() > 0 ? 0 : 20);
  if (entry("Make upright", nullptr,
            "Levels the camera and shifts the lens so that the picture's middle stays: vertical lines become "
            "vertical.",
            false, lens))
    actions.act("camera.upright");
  divide();
  if (entry("Bookmark this view", "Ctrl+B", "Saves the view for this scene, also for later runs.", false,
            view))
    keep_view(actions, open, camera, viewport.cards);
  int row = 0;
  for (const auto& [name, line] : camera.bookmarks_of(open.scene.get())) {
    ImGui::PushID(row++);
    if (entry(elided(name, px(180)).c_str(), nullptr, (name + ": restores this view.").c_str()))
      actions.act("camera.go", name);
    ImGui::PopID();
  }
  divide();
  if (entry("Find exposure", nullptr, "Sets the exposure for the picture as a whole.", false, view))
    actions.act("exposure.find");
  if (entry("Pick middle grey", "B",
            "The next click in the picture sets the exposure so that the clicked point is middle grey.",
            viewport.dropper, view))
    actions.act("exposure.dropper", !viewport.dropper);
  end_menu();
}

void render_menu(Actions& actions, const commands::OpenScene& open, bool picks_region) {
  if (!begin_menu("Render")) return;
  const bool paused = open.snapshot && open.snapshot->paused;
  if (entry(paused ? "Resume" : "Pause", "Space",
            "Pauses sampling; Resume continues with the present samples.", false, open.snapshot != nullptr))
    actions.act(paused ? "render.resume" : "render.pause");
  if (entry("Restart", "R", "Discards all samples and restarts the picture.", false,
            open.snapshot != nullptr))
    actions.act("render.restart");
  if (entry("Region", "Ctrl+R",
            "The next drag in the picture chooses a rectangle that gets all samples; the rest keeps those it "
            "has.",
            picks_region, open.scene != nullptr))
    actions.act("region.pick", !picks_region);
  const bool region = !open.setting("sampling.region").empty();
  if (entry("Clear region", nullptr,
            region ? "Gives samples to the whole picture again." : "There is no region.", false, region))
    actions.act("region.clear");
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const solvers::CommandInfo& command : solver->commands)
      if (entry(fmt::format("{}: {}", solver->label, uncapitalised(command.label)).c_str(),
                key_name(command.shortcut), command.help.c_str(), false, open.uses(*solver)))
        actions.act(solver->name + "." + command.name);
  if (entry("Reload shaders", "F5", "Compiles the shaders again; if that fails the present ones stay."))
    actions.act("shaders.reload");
  divide();
  if (entry("Cancel loading", "Esc", "Cancels the load; the present scene stays.", false, open.loading()))
    actions.act("scene.cancel");
  end_menu();
}

void help_menu(Actions& actions, LogView& log) {
  if (!begin_menu("Help")) return;
  if (entry("Keys and mouse", "F1", "Navigation and keys.")) actions.act("window.keys");
  if (entry("First steps", nullptr, "The introduction of the first start.")) actions.act("window.welcome");
  if (entry("Commands", nullptr, "Lists the commands of the console and of scripts in the log."))
    log.typed.push_back("help");
  end_menu();
}

/// "rendering   142 / 256 samples · 1.82 % · 12.3 s", each number as wide as its maximum; then shorter texts
/// for less room.
std::array<std::string, 3> state_texts(const session::Snapshot& s) {
  const bool adaptive = s.accuracy && s.accuracy->adaptive;
  const size_t digits = fmt::format("{}", s.max_samples).size();
  const std::string state = s.finished           ? "finished"
                            : s.paused           ? "paused"
                            : s.coarse           ? "first pass"
                            : s.refining.empty() ? "rendering"
                                                 : s.refining;
  if (!s.preparing.empty() && !s.paused) {
    const std::string text =
        fmt::format("{}{}", s.preparing,
                    s.preparing_left ? fmt::format(" · {} left", about_text(*s.preparing_left)) : "");
    return {fmt::format("{} · {}", text, padded(seconds_text(s.seconds), 7)), text, s.preparing};
  }
  // In adaptive sampling pixels differ: their mean.
  const std::string count =
      padded(fmt::format("{:.0f}", adaptive ? s.mean_samples : static_cast<double>(s.samples)), digits);
  const std::string samples = adaptive ? fmt::format("{} samples on average", count)
                                       : fmt::format("{} / {} samples", count, s.max_samples);
  // The error of the displayed picture stands beside this text; that of the samples is another.
  if (!shown_texts(s).empty())
    return {fmt::format("{}   {} · {}", state, samples, padded(seconds_text(s.seconds), 7)),
            fmt::format("{} · {}", state, count), count};
  const double error = s.accuracy ? s.accuracy->error()[0] : 0;
  const std::string noise = padded(error > 0 ? percent_text(error) : "–", 6);
  return {fmt::format("{}   {} · {} · {}", state, samples, noise, padded(seconds_text(s.seconds), 7)),
          fmt::format("{} · {}", count, noise), noise};
}

/// The completed part of the work, 0..1: of preparation, of the samples, or in adaptive sampling of the
/// forecast rays.
float done_part(const session::Snapshot& s) {
  if (!s.preparing.empty()) return static_cast<float>(std::max(0.0, s.preparing_done));
  if (s.accuracy && s.accuracy->adaptive) {
    const auto& lines = s.accuracy->ledger.entries();
    const double all = !lines.empty() && lines.back().total_rays ? lines.back().total_rays->middle : 0;
    return all > 0 ? static_cast<float>(std::min(1.0, static_cast<double>(s.rays) / all)) : 0;
  }
  return static_cast<float>(s.samples) / static_cast<float>(s.max_samples);
}

}  // namespace

void draw_menu_bar(Viewport& view, AccuracyView& accuracy, LogView& log,
                   const std::vector<std::string>& recent, const Layout& chosen, const std::string& side,
                   const Areas& areas) {
  Actions& actions = view.controls.actions;
  commands::Workspace& work = view.work;
  const Area& area = areas.bar;
  const Layout& shown = areas.shown;
  begin_panel("##bar", area, colour::bar, false);
  ImDrawList* list = ImGui::GetWindowDrawList();
  // Menus. The bar is drawn here, so it can hold more than menus.
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {px(8), 0.5f * (px(k_bar_height) - ImGui::GetFontSize())});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(16), 0});
  float menus_end = area.lo.x;
  if (ImGui::BeginMenuBar()) {
    file_menu(actions, work.open, work.scene_file, recent, view.has_picture());
    edit_menu(actions, work.history, work.camera.selection);
    view_menu(view.controls, view, chosen, shown, side, !accuracy.runs.earlier().empty());
    camera_menu(actions, work.open, work.camera, view);
    render_menu(actions, work.open, view.region.picks);
    help_menu(actions, log);
    menus_end = ImGui::GetCursorScreenPos().x;
    ImGui::EndMenuBar();
  }
  ImGui::PopStyleVar(2);

  // The rest is drawn over the whole bar; after its menus ImGui clips to the area below them.
  ImGui::PushClipRect(area.lo, area.hi, false);
  const session::Snapshot* s = work.open.snapshot.get();
  // The scene's name is above the picture, or behind the menus if they extend further.
  const float left = std::max(menus_end + px(8), area.lo.x + px((shown.left_open ? shown.left : 0) + 8));
  float right = area.hi.x - px(16), state_left = right;
  if (s && work.open.scene && s->max_samples > 0) {
    const std::array<std::string, 3> states = state_texts(*s);
    // The numbers stay in place: the field is as wide as its longest text.
    const std::array<std::string, 3> longest = state_texts([&] {
      session::Snapshot widest;
      widest.samples = s->max_samples, widest.max_samples = s->max_samples, widest.seconds = 99.9,
      widest.mean_samples = s->max_samples, widest.accuracy = s->accuracy, widest.coarse = true;
      return widest;
    }());
    // The longest text that fits behind the menus.
    const auto width_of = [&](size_t i) { return std::max(text_width(longest[i]), text_width(states[i])); };
    size_t which = 0;
    while (which + 1 < states.size() && right - width_of(which) < menus_end + px(8)) ++which;
    state_left = std::max(right - width_of(which), menus_end + px(8));
    draw_text(list, {state_left, area.lo.y}, {right, area.hi.y}, elided(states[which], right - state_left),
              colour::text, Align::right);
    const float preview_end = state_left - px(16),
                preview_begin = preview_end - text_width("88.8 % off, 100 % from before the edit");
    const std::vector<std::string> previews = shown_texts(*s);
    const auto preview = std::find_if(previews.begin(), previews.end(), [&](const std::string& text) {
      return preview_end - text_width(text) > menus_end;
    });
    if (preview != previews.end()) {
      const float begin = preview_end - text_width(*preview);
      draw_text(list, {begin, area.lo.y}, {preview_end, area.hi.y}, *preview, colour::accent, Align::right);
      ImGui::SetCursorScreenPos({begin, area.lo.y});
      if (ImGui::InvisibleButton("##preview", {preview_end - begin, area.hi.y - area.lo.y - px(2)}))
        actions.toggle("overlay.former");
      tooltip(
          (s->shown_error
               ? fmt::format("Estimated error of the displayed picture, of the median tile and of the worst "
                             "tenth of the tiles: {} and {}{}. ",
                             percent_text(s->shown_error->median), percent_text(s->shown_error->worst_tenth),
                             usable_text(*s))
               : "") +
          "Light from before the last edit stays until the new light is better, and the noise of few samples "
          "is "
          "filtered. EXR files store the samples; a PNG can be saved either way. U shows the unfiltered "
          "samples. Click to tint light from before the edit.");
    }
    ImGui::SetCursorScreenPos({state_left, area.lo.y});
    ImGui::InvisibleButton("##state", {std::max(1.0f, right - state_left), area.hi.y - area.lo.y - px(2)});
    tooltip((which > 0 ? states[0] + ". " : "") +
            "Samples per pixel, their noise as seen while they are shown unfiltered (the Accuracy panel "
            "plots it), "
            "and the time since this picture was started, without pauses.");
    // Room for shown_texts(), so nothing moves when it disappears.
    right = preview_begin - px(24);
  }
  if (s && !s->device.empty()) {
    const float room = std::max(0.0f, right - left - px(160));
    const std::string device = elided(s->device, std::min(room, px(260)));
    if (room > px(60)) {
      draw_text(list, {right - text_width(device), area.lo.y}, {right, area.hi.y}, device, colour::text_dim);
      right -= text_width(device) + px(24);
    }
  }
  if (work.open.scene) {
    const std::string name = elided((work.scene_file.unsaved() ? "*" : "") + work.open.scene->name,
                                    std::max(0.0f, right - left), theme().fonts.strong);
    draw_text(list, {left, area.lo.y}, {right, area.hi.y}, name, colour::text, Align::left,
              theme().fonts.strong);
  }
  // Progress of the picture as a thin line under its state.
  list->AddRectFilled({area.lo.x, area.hi.y - 1}, area.hi, colour::hairline);
  if (s && work.open.scene && s->max_samples > 0 && !s->finished) {
    const float done = done_part(*s);
    list->AddRectFilled({state_left, area.hi.y - px(2)},
                        {state_left + done * (area.hi.x - px(16) - state_left), area.hi.y},
                        s->paused ? colour::text_dim : colour::accent);
  }
  ImGui::PopClipRect();
  ImGui::End();
}

}  // namespace lucerna::ui
