#include "keys.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <set>

#include "solvers/registry.h"
#include "state.h"

namespace lucerna::ui {

bool Keys::pressed(int key, int mods) const {
  const int relevant = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
  return std::any_of(list.begin(), list.end(),
                     [&](const auto& k) { return k.first == key && (k.second & relevant) == mods; });
}

bool handle_window_keys(const Keys& keys, Actions& actions, const commands::History& history, bool panels,
                        bool dialog, bool picture) {
  const bool popup = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  if (keys.pressed(GLFW_KEY_F12)) actions.act("screenshot");
  if (keys.pressed(GLFW_KEY_F5)) actions.act("shaders.reload");
  if (dialog) return false;
  if (keys.pressed(GLFW_KEY_O, GLFW_MOD_CONTROL)) actions.act("dialog.open");
  for (const auto& [key, mods] : keys.list)
    if (key == GLFW_KEY_S && mods & GLFW_MOD_CONTROL && picture)
      actions.act(mods & GLFW_MOD_SHIFT ? "scene.save" : "dialog.save");
  if (keys.pressed(GLFW_KEY_L, GLFW_MOD_CONTROL)) actions.act("log.type");
  if (keys.pressed(GLFW_KEY_Q, GLFW_MOD_CONTROL)) actions.act("window.close");
  if (popup && keys.pressed(GLFW_KEY_ESCAPE)) ImGui::ClosePopupToLevel(0, true);
  if (popup) return false;
  // In an empty field, such as that of commands, there is nothing else to undo.
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  const ImGuiInputTextState& field = context.InputTextState;
  const bool typing = ImGui::GetIO().WantTextInput;
  const bool empty =
      field.ID == context.ActiveId && field.CurLenW == 0 && field.Stb.undostate.undo_point == 0;
  for (const auto& [pressed, mods] : keys.list) {
    const bool redoes = pressed == GLFW_KEY_Y;
    if (typing && !empty) break;
    if ((pressed == GLFW_KEY_Z || redoes) && mods & GLFW_MOD_CONTROL) {
      const bool again = redoes || mods & GLFW_MOD_SHIFT;
      if (again ? history.can_redo() : history.can_undo()) actions.act(again ? "redo" : "undo");
    }
  }
  if (typing) return false;
  if (keys.pressed(GLFW_KEY_F1)) actions.act("window.keys");
  if (keys.pressed(GLFW_KEY_TAB)) actions.act("window.panels", !panels), actions.wake(3);
  return true;
}

namespace {

/// Ends what is in progress, one thing at a time.
void escape(Viewport& v) {
  const commands::OpenScene& open = v.work.open;
  if (v.cancel_drag()) return;
  if (v.cards.welcome)
    v.cards.welcome = false;
  else if (v.give_up_click())
    return;
  else if (open.loading() || (open.moving_objects() && !open.snapshot->activity.empty()))
    v.controls.act("scene.cancel");
  else if (!v.cards.errors.empty())
    v.controls.act("dismiss");
  else if (v.work.camera.selection.kind != Kind::none)
    v.controls.act("select.none");
}

}  // namespace

void handle_picture_keys(const Keys& keys, Viewport& v) {
  Actions& actions = v.controls.actions;
  const commands::OpenScene& open = v.work.open;
  const commands::Navigation& camera = v.work.camera;
  if (keys.pressed(GLFW_KEY_ESCAPE)) escape(v);
  if (!open.snapshot) return;
  if (keys.pressed(GLFW_KEY_F) && camera.view) actions.act("camera.frame");
  if (keys.pressed(GLFW_KEY_H) && camera.view) actions.act("camera.walking", !camera.walking);
  if (keys.pressed(GLFW_KEY_B, GLFW_MOD_CONTROL) && camera.view) keep_view(actions, open, camera, v.cards);
  if (keys.pressed(GLFW_KEY_B) && camera.view) actions.act("exposure.dropper", !v.dropper);
  if (keys.pressed(GLFW_KEY_R)) actions.act("render.restart");
  if (keys.pressed(GLFW_KEY_R, GLFW_MOD_CONTROL) && open.scene) actions.act("region.pick", !v.region.picks);
  if (keys.pressed(GLFW_KEY_I) && open.scene) {
    if (v.held_pixel.reported && v.work.pixel)
      trace_pixel(actions, v.paths, v.work.pixel->at);
    else
      actions.act("paths.pick", v.paths.pick == PathsView::Pick::pixel ? "none" : "pixel");
  }
  if (keys.pressed(GLFW_KEY_Z) && camera.selection.kind == Kind::instance) {
    const int next = v.scene_view.gizmo == GizmoMode::size ? 1 : static_cast<int>(v.scene_view.gizmo) + 1;
    actions.act("view.gizmo", k_gizmo_names[static_cast<size_t>(next)]);
  }
  if (keys.pressed(GLFW_KEY_L)) actions.act("view.lamps", !v.light_marks);
  if (keys.pressed(GLFW_KEY_T)) actions.toggle("overlay.tiles");
  if (keys.pressed(GLFW_KEY_H, GLFW_MOD_CONTROL) && open.scene) {
    actions.act("compare.hold");
    actions.act("window.side", k_compare_side);
  }
  if (keys.pressed(GLFW_KEY_Y) && !v.work.compare.results.compared())
    v.cards.notice("No held result is chosen. Ctrl+H holds the picture.");
  if (keys.pressed(GLFW_KEY_U))
    actions.act("set", "preview.filter", open.setting("preview.filter") == "off" ? "auto" : "off");
  if (keys.pressed(GLFW_KEY_SPACE)) actions.act(open.snapshot->paused ? "render.resume" : "render.pause");
  for (int n = 0; n < 9; ++n)
    if (keys.pressed(GLFW_KEY_1 + n) && open.scene && n < static_cast<int>(open.scene->cameras.size()) &&
        camera.view)
      actions.act("camera.select", n + 1);
}

void handle_solver_keys(const Keys& keys, Controls& controls, CardsView& cards, const std::string& side) {
  std::vector<const solvers::SolverInfo*> used;
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (controls.open.uses(*solver)) used.insert(side == solver->name ? used.begin() : used.end(), solver);
  std::set<char> taken;
  const auto pressed = [&](char shortcut) {  // a letter is GLFW's name of its key
    return shortcut && keys.pressed(shortcut) && taken.insert(shortcut).second;
  };
  for (const solvers::SolverInfo* solver : used) {
    for (const solvers::ViewInfo& view : solver->views)
      if (pressed(view.shortcut)) controls.turn_view(view);
    for (const solvers::CommandInfo& command : solver->commands)
      if (pressed(command.shortcut)) controls.act(solver->name + "." + command.name);
  }
  if (!controls.open.scene) return;
  for (const solvers::SolverInfo* solver : solvers::registered())
    for (const solvers::ViewInfo& view : solver->views)
      if (!controls.open.uses(*solver) && pressed(view.shortcut))
        cards.notice(fmt::format("{}: no component is computed by {}. Choose it in the Light panel.",
                                 view.label, solver->title));
}

}  // namespace lucerna::ui
