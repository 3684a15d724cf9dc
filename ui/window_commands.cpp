// Commands that need a window: panels, dialogs, the log, marks over the picture.
#include <GLFW/glfw3.h>

#include <algorithm>

#include "base/error.h"
#include "scene/display_name.h"
#include "solvers/registry.h"
#include "state.h"

namespace lucerna::ui {
namespace {

const std::vector<std::string> k_levels{"debug", "info", "warning", "error"};

/// The panels that the right side can show.
std::vector<std::string> sides() {
  std::vector<std::string> names{k_scene_side, k_paths_side, k_compare_side};
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->has_panel()) names.push_back(solver->name);
  return names;
}

std::vector<std::string> section_names(const Ui& ui) {
  std::vector<std::string> names{"Light",   "Light mix",        "Render",          "Camera",
                                 "Lights",  "Environment",      "Materials",       "Objects",
                                 "Options", "Paths of a pixel", "Brightest paths", "Followed path",
                                 "Noise",   "Held results",     "Comparison",      "Accuracy in time"};
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (solver->has_panel()) add(solver->label);
  if (ui.open.snapshot)
    for (const auto& report : ui.open.snapshot->reports)
      for (const solvers::PanelSection& section : report->sections) add(section.title);
  return names;
}

float& size_of(Layout& layout, const std::string& panel) {
  return panel == "left" ? layout.left : panel == "right" ? layout.right : layout.bottom;
}
void keep_arranged(Layout& layout, const std::string& panel) {
  (panel == "left"    ? layout.left_arranged
   : panel == "right" ? layout.right_arranged
                      : layout.bottom_arranged) = true;
}
void set_open(Layout& layout, const std::string& panel, bool open) {
  const Panel which = panel == "left" ? Panel::left : panel == "right" ? Panel::right : Panel::bottom;
  keep_arranged(layout, panel);
  (which == Panel::left    ? layout.left_open
   : which == Panel::right ? layout.right_open
                           : layout.bottom_open) = open;
  if (open)
    layout.opened_last = which;
  else if (layout.opened_last == which)
    layout.opened_last.reset();
}

using commands::Arguments;
using commands::Parameter;
using commands::Type;

/// Registers a command: name, help, parameters, action, whether scripts record it.
struct Add {
  Ui& ui;
  void operator()(const std::string& name, std::string help, std::vector<Parameter> parameters,
                  std::function<void(const Arguments&)> run, bool recorded = true) const {
    ui.work.registry.add({.name = name,
                          .help = std::move(help),
                          .parameters = std::move(parameters),
                          .run =
                              [&ui = ui, run = std::move(run)](const Arguments& a) {
                                run(a);
                                ui.frames_to_settle = 2, ui.camera.resizing = true;
                                ui.wake(3);
                              },
                          .recorded = recorded,
                          .needs_window = needs_window(name)});
  }

  /// Dialogs and the clipboard exist only in a window.
  static std::function<bool(const Arguments&)> needs_window(const std::string& name) {
    if (!name.starts_with("dialog.") && name != "log.copy") return {};
    return [](const Arguments&) { return true; };
  }
};

Parameter on() { return {.name = "on", .type = Type::boolean}; }

/// Selection and sizes of the panels.
void add_panel_commands(Ui& ui, const Add& add) {
  const Parameter panel{
      .name = "panel", .type = Type::choice, .choices = {"left", "right", "bottom"}, .which = true};

  add("window.panels", "Shows or hides all panels.", {on()},
      [&ui](const Arguments& a) { ui.layout.panels = a.boolean("on"); });
  add("window.fold", "Folds a panel, or unfolds it.", {panel, {.name = "folded", .type = Type::boolean}},
      [&ui](const Arguments& a) { set_open(ui.layout, a.text("panel"), !a.boolean("folded")); });
  add("window.side", "Selects the content of the right panel, and unfolds it.",
      {{.name = "what", .type = Type::choice, .choices = sides()}}, [&ui](const Arguments& a) {
        ui.side = a.text("what");
        set_open(ui.layout, "right", true);
      });
  add("window.split", "Sets the width of a side panel, or the height of the strip at the bottom.",
      {panel, {.name = "size", .type = Type::real, .lo = 0, .hi = 10000, .unit = "design pixels"}},
      [&ui](const Arguments& a) {
        size_of(ui.layout, a.text("panel")) = a.number("size");
        keep_arranged(ui.layout, a.text("panel"));
      });
  add("window.log_share", "Sets how much of the strip at the bottom is the log.",
      {{.name = "share", .type = Type::real, .lo = 0, .hi = 1}},
      [&ui](const Arguments& a) { ui.layout.log_share = a.number("share"); });
  add("window.passes_share", "Sets the Passes panel's share of the strip at the bottom.",
      {{.name = "share", .type = Type::real, .lo = 0, .hi = 1}},
      [&ui](const Arguments& a) { ui.layout.passes_share = a.number("share"); });
  add("window.section", "Opens or closes a section of a panel.",
      {{.name = "section",
        .which = true,
        .names = [&ui](const std::vector<std::string>&) { return section_names(ui); }},
       {.name = "open", .type = Type::boolean}},
      [&ui](const Arguments& a) { ui.sections[a.text("section")] = a.boolean("open"); });
}

void add_accuracy_commands(Ui& ui, const Add& add) {
  add("accuracy.what_if",
      "In uniform sampling: shows the cost of this error as seen. In adaptive sampling sampling.target_error "
      "is used instead; it starts with the last value given here.",
      {{.name = "error", .type = Type::real, .lo = 0.0001, .hi = 10}},
      [&ui](const Arguments& a) { ui.accuracy.set_what_if(a.real("error")); });
  add("accuracy.clear_runs", "Removes the lines of earlier renders from the Accuracy plot.", {},
      [&ui](const Arguments&) { ui.accuracy.runs.clear(); });
}

/// The window as a whole, and its cards of explanation.
void add_frame_commands(Ui& ui, const Add& add) {
  add("window.size", "Resizes the window.",
      {{.name = "width", .type = Type::integer, .lo = 640, .hi = 16384, .unit = "pixels"},
       {.name = "height", .type = Type::integer, .lo = 400, .hi = 16384, .unit = "pixels"}},
      [&ui](const Arguments& a) {
        ui.requests.size = {static_cast<int>(a.integer("width")), static_cast<int>(a.integer("height"))};
      });
  add("window.scale", "Sets the scale of text and controls; 0: the desktop's.",
      {{.name = "scale", .type = Type::real, .lo = 0, .hi = 4}},
      [&ui](const Arguments& a) { ui.requests.scale = a.number("scale"); });
  add(
      "window.keys", "Shows the page of keys and mouse.", {}, [&ui](const Arguments&) { ui.help = true; },
      false);

  add(
      "window.welcome", "Shows the first steps.", {}, [&ui](const Arguments&) { ui.cards.welcome = true; },
      false);
}

/// The picture's size, and its marks.
void add_picture_commands(Ui& ui, const Add& add) {
  add(
      "exposure.dropper", "Makes the next click in the picture set the exposure from the clicked point.",
      {on()},
      [&ui](const Arguments& a) {
        ui.viewport.take_click();
        ui.viewport.dropper = a.boolean("on");
        if (ui.viewport.dropper)
          ui.cards.click_notice("Click a grey point to show it as middle grey. Esc cancels.");
      },
      false);
  add(
      "camera.focusing", "Makes the next click in the picture focus on the clicked point.", {on()},
      [&ui](const Arguments& a) {
        ui.viewport.take_click();
        ui.scene_view.focusing = a.boolean("on");
        if (ui.scene_view.focusing) ui.cards.click_notice("Click a surface to focus on it. Esc cancels.");
      },
      false);
  add(
      "light.highlighting",
      "Makes the next click in the picture move the selected light so that its highlight is there.", {on()},
      [&ui](const Arguments& a) {
        const bool light = ui.work.camera.selection.kind == commands::Kind::light;
        if (a.boolean("on") && !light) throw Error("", "select a light first");
        ui.viewport.take_click();
        ui.scene_view.highlighting = a.boolean("on");
        if (ui.scene_view.highlighting)
          ui.cards.click_notice("Click where the light's highlight shall be. Esc cancels.");
      },
      false);
  add(
      "paths.pick",
      "Makes the next click in the picture trace the paths of a pixel, or the next drag explain the noise of "
      "a "
      "rectangle; shows the panel of paths.",
      {{.name = "what", .type = Type::choice, .choices = {"none", "pixel", "area"}}},
      [&ui](const Arguments& a) {
        using Pick = PathsView::Pick;
        const std::string& what = a.text("what");
        ui.viewport.take_click();
        ui.paths.pick = what == "pixel" ? Pick::pixel : what == "area" ? Pick::area : Pick::none;
        if (ui.paths.pick == Pick::none) return;
        ui.side = k_paths_side;
        set_open(ui.layout, "right", true);
        ui.cards.click_notice(ui.paths.pick == Pick::pixel
                                  ? "Click a pixel to trace its paths. Esc cancels."
                                  : "Drag a rectangle to explain its noise. Esc cancels.");
      },
      false);
  add(
      "region.pick", "Makes the next drag in the picture choose the region that gets all samples.", {on()},
      [&ui](const Arguments& a) {
        ui.viewport.take_click();
        ui.region.picks = a.boolean("on");
        if (ui.region.picks) ui.cards.click_notice("Drag a rectangle: it gets all samples. Esc cancels.");
      },
      false);
  add("view.histogram",
      "Shows a histogram of the picture as displayed, with its overlays, and the shares of black and clipped "
      "pixels.",
      {on()}, [&ui](const Arguments& a) { ui.viewport.histogram.on = a.boolean("on"); });
  add("view.frame",
      "Shows a frame with the camera's aspect ratio, or another one, in the picture: what a picture of that "
      "ratio "
      "shows.",
      {on(),
       {.name = "aspect",
        .type = Type::real,
        .help = "width over height",
        .lo = 0.01,
        .hi = 100,
        .optional = true}},
      [&ui](const Arguments& a) {
        ui.viewport.frame_guide = {a.boolean("on"), a.has("aspect") ? a.number("aspect") : 0};
      });
  add(
      "camera.turntable", "Turns the camera about what it looks at, until it is moved by hand; 0: stops.",
      {{.name = "seconds", .type = Type::real, .help = "for a turn", .lo = 0, .hi = 3600, .unit = "s"}},
      [&ui](const Arguments& a) {
        if (a.number("seconds") > 0) ui.camera.needs_view();
        ui.moves.start_turntable(a.number("seconds"));
      },
      false);
  add("view.divisor", "Sets the pixels of the window per pixel of the picture, along a side.",
      {{.name = "divisor", .type = Type::choice, .choices = {"1", "2", "4"}}},
      [&ui](const Arguments& a) { ui.viewport.divisor = static_cast<int>(a.integer("divisor")); });
  add("view.size",
      "Sets a fixed picture size, such as that of a reference; 0 0: as large as the window allows.",
      {{.name = "width", .type = Type::integer, .lo = 0, .hi = 16384, .unit = "pixels"},
       {.name = "height", .type = Type::integer, .lo = 0, .hi = 16384, .unit = "pixels"}},
      [&ui](const Arguments& a) {
        ui.picture_size.reset();
        if (a.integer("width") == 0 || a.integer("height") == 0) return;
        ui.picture_size.emplace(static_cast<uint32_t>(a.integer("width")),
                                static_cast<uint32_t>(a.integer("height")));
        ui.camera.set_size(ui.picture_size->first, ui.picture_size->second);
      });
  add("view.selection", "Shows the box and the handles of the selected object in the picture.", {on()},
      [&ui](const Arguments& a) { ui.viewport.brackets = a.boolean("on"); });
  add("view.gizmo", "Sets what the handles of the selected object do.",
      {{.name = "mode", .type = Type::choice, .choices = {k_gizmo_names.begin(), k_gizmo_names.end()}}},
      [&ui](const Arguments& a) {
        ui.scene_view.gizmo = GizmoMode(
            std::find(k_gizmo_names.begin(), k_gizmo_names.end(), a.text("mode")) - k_gizmo_names.begin());
      });
  add("view.lamps", "Marks lamps and emissive surfaces in the picture.", {on()},
      [&ui](const Arguments& a) { ui.viewport.light_marks = a.boolean("on"); });
}

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

void add_dialog_commands(Ui& ui, const Add& add) {
  using Purpose = Dialog::Purpose;
  const auto opens = [&](const std::string& name, const std::string& what, Purpose purpose,
                         const solvers::SolverInfo* solver = nullptr) {
    add(
        "dialog." + name, fmt::format("Opens the dialog to {}.", what), {},
        [&ui, purpose, solver](const Arguments&) {
          if (purpose == Purpose::scene || purpose == Purpose::environment) ui.open.needs_scene();
          ui.start_dialog(purpose, solver);
        },
        false);
  };
  opens("open", "open a scene", Purpose::open);
  opens("save", "save the picture", Purpose::save);
  opens("scene", "save the scene", Purpose::scene);
  opens("environment", "light the scene by an image", Purpose::environment);
  opens("reference", "load a reference", Purpose::reference);
  opens("held", "hold the picture of a file", Purpose::held);
  opens("script", "save the session as a script", Purpose::script);
  opens("test", "save the session as a test", Purpose::test);
  for (const solvers::SolverInfo* solver : solvers::registered()) {
    if (!solver->file) continue;
    opens(solver->name + "_load", "load " + solver->file->content, Purpose::solver_load, solver);
    opens(solver->name + "_save", "save " + solver->file->content, Purpose::solver_save, solver);
  }
  add(
      "window.close", "Closes the window; asks what to do with edits that are not saved.", {},
      [&ui](const Arguments&) { ui.leave(""); }, false);
  add(
      "window.open",
      "Opens a scene, as scene.open does; asks first what to do with edits that are not saved.", {{"file"}},
      [&ui](const Arguments& a) { ui.leave(a.text("file")); }, false);
  std::vector<std::string> slots;
  for (const scene::TextureSlot& slot : scene::k_texture_slots) slots.emplace_back(slot.name);
  add(
      "dialog.texture", "Opens the dialog to choose a file for a texture of a material.",
      {{.name = "material", .help = "its name, or its number from 1"},
       {.name = "slot", .type = Type::choice, .help = "what the image is for", .choices = slots}},
      [&ui](const Arguments& a) {
        const uint32_t index = ui.open.material_index(a.text("material"));
        const std::string slot = a.text("slot");
        ui.choose_file(
            fmt::format("material.set {} {}_texture=", index + 1, slot),
            fmt::format("A texture for '{}': {}",
                        scene::display_name(ui.open.scene->materials[index].name, "Material", index),
                        spaced(slot)),
            {".png", ".jpg", ".jpeg"});
      },
      false);
  add(
      "dialog.light_file",
      "Opens the dialog to choose a measured distribution for a light, or a picture that a spot projects.",
      {{.name = "light", .help = "its name, or its number from 1"},
       {.name = "kind", .type = Type::choice, .choices = {"profile", "picture"}}},
      [&ui](const Arguments& a) {
        const uint32_t index = ui.open.light_index(a.text("light"));
        const bool profile = a.text("kind") == "profile";
        ui.choose_file(
            fmt::format("light.set {} {}=", index + 1, a.text("kind")),
            profile ? "A measured distribution (IES or EULUMDAT)" : "A picture for the spot to project",
            profile ? std::vector<std::string>{".ies", ".ldt"}
                    : std::vector<std::string>{".png", ".jpg", ".jpeg", ".exr", ".hdr"});
      },
      false);
  add(
      "dismiss", "Closes the dialog, or otherwise the newest message over the picture.", {},
      [&ui](const Arguments&) {
        if (ui.dialog.purpose != Dialog::Purpose::none)
          ui.dialog = {};
        else if (!ui.cards.errors.empty())
          ui.cards.errors.pop_back();
      },
      false);
}

void add_log_commands(Ui& ui, const Add& add) {
  add(
      "log.copy", "Copies the displayed lines to the clipboard.", {},
      [&ui](const Arguments&) {
        std::string all;
        for (const LogLine& line : ui.log.lines) {
          const auto level = static_cast<size_t>(line.level);
          if (ui.log.levels[level])
            all += fmt::format("{:.2f} {} {}\n", line.time, k_levels[level], line.text);
        }
        ImGui::SetClipboardText(all.c_str());
      },
      false);
  add(
      "log.type", "Moves the keyboard focus to the console.", {},
      [&ui](const Arguments&) {
        ui.layout.panels = true;
        set_open(ui.layout, "bottom", true);
        ui.log.console.focus = true;
      },
      false);
  add(
      "log.clear", "Clears the log.", {}, [&ui](const Arguments&) { ui.log.lines.clear(); }, false);
  add("log.show", "Shows or hides the lines of a level.",
      {{.name = "level", .type = Type::choice, .choices = k_levels, .which = true}, on()},
      [&ui](const Arguments& a) {
        const auto level = std::find(k_levels.begin(), k_levels.end(), a.text("level")) - k_levels.begin();
        ui.log.levels[static_cast<size_t>(level)] = a.boolean("on");
      });
}

}  // namespace

std::pair<int, int> key_of(const std::string& name) {
  static const std::vector<std::pair<std::string, int>> keys{
      {"tab", GLFW_KEY_TAB},     {"enter", GLFW_KEY_ENTER},   {"escape", GLFW_KEY_ESCAPE},
      {"space", GLFW_KEY_SPACE}, {"up", GLFW_KEY_UP},         {"down", GLFW_KEY_DOWN},
      {"left", GLFW_KEY_LEFT},   {"right", GLFW_KEY_RIGHT},   {"home", GLFW_KEY_HOME},
      {"end", GLFW_KEY_END},     {"delete", GLFW_KEY_DELETE}, {"backspace", GLFW_KEY_BACKSPACE}};
  static const std::vector<std::pair<std::string, int>> modifiers{
      {"ctrl+", GLFW_MOD_CONTROL}, {"shift+", GLFW_MOD_SHIFT}, {"alt+", GLFW_MOD_ALT}};
  std::string rest = name;
  for (char& c : rest) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  int mods = 0;
  for (bool again = true; again;) {
    again = false;
    for (const auto& [head, bit] : modifiers)
      if (rest.starts_with(head)) rest = rest.substr(head.size()), mods |= bit, again = true;
  }
  double number = 0;
  if (rest.size() == 1 && std::isalnum(static_cast<unsigned char>(rest[0])))
    return {std::toupper(static_cast<unsigned char>(rest[0])), mods};  // GLFW's keys are their capitals
  if (rest.size() > 1 && rest[0] == 'f' && commands::read_number(rest.substr(1), number) && number >= 1 &&
      number <= 12)
    return {GLFW_KEY_F1 + static_cast<int>(number) - 1, mods};
  for (const auto& [known, key] : keys)
    if (rest == known) return {key, mods};
  throw Error("", fmt::format("there is no key '{}'; expected a letter, a digit, f1 to f12, tab, enter, "
                              "escape, space, an arrow, home, end, delete or backspace, behind ctrl+, shift+ "
                              "or alt+",
                              name));
}

void add_window_commands(Ui& ui) {
  const Add add{ui};
  add_panel_commands(ui, add);
  add_accuracy_commands(ui, add);
  add_frame_commands(ui, add);
  add_picture_commands(ui, add);
  add_dialog_commands(ui, add);
  add_log_commands(ui, add);
}

}  // namespace lucerna::ui
