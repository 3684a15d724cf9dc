#include "object_rows.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>

#include "list_rows.h"
#include "scene/display_name.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using commands::Kind;
using commands::named;
using scene::display_name;

void mode_buttons(Controls& controls, GizmoMode mode) {
  static constexpr ChoiceButton k_buttons[] = {
      {k_gizmo_names[1], "Move",
       "Arrows and squares in the picture move the object. Z shows the next handles."},
      {k_gizmo_names[2], "Turn",
       "Rings in the picture turn the object about the middle of its box. Z shows the next handles."},
      {k_gizmo_names[3], "Size",
       "Arms in the picture size the object along its axes, the middle in all. Z shows the next handles."}};
  static_assert(GizmoMode::move == GizmoMode(1) && std::size(k_buttons) + 1 == k_gizmo_names.size());
  const size_t on = mode == GizmoMode::off ? std::size(k_buttons) : size_t(mode) - 1;
  if (const ChoiceButton* pressed = choice_buttons("gizmo", k_buttons, on))
    controls.act("view.gizmo", pressed == k_buttons + on ? k_gizmo_names[0] : pressed->name);
}

/// Notes a place that a control gives; the picture's part of the window sends it.
void note_place(Controls& controls, SceneView& view, uint32_t index, const scene::ObjectPlace& place,
                std::string line) {
  try {
    controls.open.object_matrix(index, place);
  } catch (const Error&) {
    return;  // the last one that can be
  }
  const unsigned control = ImGui::GetActiveID();
  if (!view.typed || view.typed->object != index || view.typed->control != control)
    view.typed = {.object = index, .control = control, .gesture = controls.actions.new_gesture()};
  view.typed->place = place, view.typed->line = std::move(line), view.typed->changed_at = 0;
  controls.actions.wake(2);
}

void place_fields(Controls& controls, const commands::Navigation& camera, SceneView& view, uint32_t index,
                  const scene::ObjectPlace& place) {
  const auto set = [&](const scene::ObjectPlace& to, const char* key, const vec3& value) {
    note_place(controls, view, index, to, commands::line("object.set", index + 1, named(key, value)));
  };
  const Box& box = controls.open.object_box(index);
  const vec3 loaded = scene::middle_of(box, controls.open.loaded->instances[index].to_world);
  vec3 position = loaded + place.moved;
  if (position_row(camera.core, position))
    set({position - loaded, place.turned, place.scaled}, "position", position);
  tooltip("Where the middle of its box is: x, y (up), z in metres.");
  vec3 turned = place.turned;
  if (slider_row("##turned", "Rotation", turned,
                 {.lo = -180, .hi = 180, .decimals = 1, .bar = false, .typed_lo = -3600, .typed_hi = 3600}) >=
      0)
    set({place.moved, turned, place.scaled}, "rotation", turned);
  tooltip("Degrees about x, y (up) and z, relative to the file: z first, y last.");
  vec3 scaled = place.scaled;
  if (slider_row("##scaled", "Scale", scaled,
                 {.lo = -4,
                  .hi = 4,
                  .decimals = 3,
                  .bar = false,
                  .travel = 0.5f,
                  .typed_lo = -1e4f,
                  .typed_hi = 1e4f}) >= 0)
    set({place.moved, place.turned, scaled}, "scale", scaled);
  tooltip("Factors along its own axes, relative to the file. A negative one mirrors.");
  float size = std::abs(scaled.x);
  if (slider("##size", "Size", size,
             {.lo = 0.01f,
              .hi = 100,
              .log = true,
              .decimals = 3,
              .unit = "\xC3\x97",
              .bar = false,
              .travel = 0.25f,
              .typed_lo = scene::k_least_factor,
              .typed_hi = scene::k_most_factor})) {
    scaled = place.scaled * (size / std::abs(place.scaled.x));
    set({place.moved, place.turned, scaled}, "scale", scaled);
  }
  tooltip("Sizes the object along all axes alike.");
}

void object_buttons(Controls& controls, uint32_t index, const scene::ObjectPlace& place) {
  const float third = (ImGui::CalcItemWidth() - px(8)) / 3;
  if (button("##drop", "Drop", false, third)) controls.act("object.drop", index + 1);
  tooltip("Lowers the object onto the surface below it.");
  ImGui::SameLine(0, px(4));
  if (button("##hide", place.hidden ? "Show" : "Hide", place.hidden, third))
    controls.act("object.set", index + 1, named("visible", place.hidden));
  tooltip(place.hidden ? "Shows the object again."
                       : "Hides the object: it has no surface until it is shown.");
  ImGui::SameLine(0, px(4));
  ImGui::BeginDisabled(!controls.open.is_edited(index));
  if (button("##reset", "Reset", false, third)) controls.act("object.reset", index + 1);
  ImGui::EndDisabled();
  tooltip("Puts the object back as its file has it.");
}

}  // namespace

void draw_object_rows(Controls& controls, const commands::Navigation& camera, SceneView& view, bool reveal) {
  if (!controls.open.loaded) return;
  const auto& list = controls.open.loaded->instances;
  const commands::Selection& selection = camera.selection;
  if (selection.kind == Kind::instance && selection.index < list.size()) {
    const uint32_t index = selection.index;
    scene::ObjectPlace place = controls.open.object(index);
    if (view.typed && view.typed->object == index) place = view.typed->place;
    if (reveal) show_row(ImGui::GetCursorScreenPos().y + px(150));
    ImGui::PushID("selected");
    value_row("Object", display_name(list[index].name, "Object", index), "The selected object.");
    mode_buttons(controls, view.gizmo);
    ImGui::BeginDisabled(place.hidden);
    place_fields(controls, camera, view, index, place);
    ImGui::EndDisabled();
    object_buttons(controls, index, place);
    ImGui::PopID();
    gap(6);
    hairline();
    gap(4);
  }
  // Long lists draw only the visible rows.
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(list.size()), px(24));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const auto index = static_cast<uint32_t>(i);
      const bool chosen = selection.kind == Kind::instance && selection.index == index;
      const bool hidden = controls.open.object(index).hidden;
      ImGui::PushID(i);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      if (list_row("##object", chosen, display_name(list[index].name, "Object", index),
                   hidden                           ? "hidden"
                   : controls.open.is_edited(index) ? "moved"
                                                    : "",
                   0, 28))
        choose(controls.actions, view, chosen, "object", index);
      tooltip("Press to select the object; F frames it.");
      if (row_sign(at, "##visible", Sign::eye, !hidden, hidden ? "Shows the object." : "Hides the object."))
        controls.act("object.set", index + 1, named("visible", hidden));
      ImGui::PopID();
    }
}

}  // namespace lucerna::ui
