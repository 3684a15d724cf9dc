// The panel on the right: cameras and navigation, environment, and the lists of lights, materials and
// objects.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/blackbody.h"
#include "base/color.h"
#include "commands/light_edit.h"
#include "emitters.h"
#include "light_rows.h"
#include "material_rows.h"
#include "object_rows.h"
#include "panel_block.h"
#include "scene/display_name.h"
#include "scene/lamp.h"
#include "scene/range.h"
#include "state.h"
#include "sun_rows.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using scene::display_name;

void lens_shift(Controls& controls, const scene::Camera& camera) {
  if (button("##upright", "Make upright", false, ImGui::CalcItemWidth())) controls.act("camera.upright");
  tooltip(
      "Levels the camera and shifts the lens so that the picture's middle stays: vertical lines become "
      "vertical.");
  if (camera.shift == vec2(0)) return;
  vec2 shift = camera.shift;
  const Slider how{.lo = -1,
                   .hi = 1,
                   .decimals = 3,
                   .bar = false,
                   .sign = true,
                   .typed_lo = -scene::k_max_shift,
                   .typed_hi = scene::k_max_shift};
  bool moved = slider("##shift_up", "Shift up", shift.y, how);
  tooltip("Heights of the picture by which its middle is above the view axis.");
  moved |= slider("##shift_right", "Shift right", shift.x, how);
  tooltip("Widths of the picture by which its middle is to the right of the view axis.");
  if (moved) controls.act("camera.shift", shift.x, shift.y);
  if (button("##no_shift", "Remove shift", false, ImGui::CalcItemWidth())) controls.act("camera.shift", 0, 0);
  tooltip("Puts the middle of the picture on the view axis again.");
}

void section_plane(Controls& controls, const Viewpoint& view) {
  const scene::Section& section = view.camera.section;
  if (button("##section_plane", "Section plane", section.cuts(), ImGui::CalcItemWidth())) {
    const vec3 ahead = commands::forward_of(view.camera);
    if (section.cuts())
      controls.act("camera.no_section");
    else
      controls.act("camera.section", commands::eye_of(view.camera) + 0.5f * view.distance * ahead, ahead);
  }
  tooltip("Cuts the view by a plane across it: the camera sees only what lies behind. Light is not cut.");
  if (!section.cuts()) return;
  float offset = section.offset;
  const float reach = 2 * view.extent;
  if (slider("##offset", "Plane at", offset,
             {.lo = -reach,
              .hi = reach,
              .decimals = 3,
              .unit = "m",
              .bar = false,
              .typed_lo = -1e6f,
              .typed_hi = 1e6f}))
    controls.act("camera.section", offset * section.normal, section.normal);
  tooltip("Distance of the plane from the scene's origin, along the view that it was placed in.");
}

/// `focusing`: the next click in the picture focuses.
void depth_of_field(Controls& controls, const scene::Lens& lens, bool focusing) {
  const bool on = lens.f_number > 0;
  if (button("##depth_of_field", "Depth of field", on, ImGui::CalcItemWidth())) {
    if (on)
      controls.act("camera.pinhole");
    else
      controls.act("camera.f_number", 2.8f);
  }
  tooltip("A lens instead of a pinhole: surfaces before and behind the plane of focus blur.");
  if (!on) return;
  float f_number = lens.f_number, focus = lens.focus_distance, rotation = lens.rotation * 180 / k_pi;
  auto blades = static_cast<float>(lens.blades);
  if (slider("##f_number", "f-number", f_number,
             {.lo = 0.5f,
              .hi = 32,
              .log = true,
              .decimals = 2,
              .typed_lo = scene::k_least_f_number,
              .typed_hi = scene::k_max_f_number}))
    controls.act("camera.f_number", f_number);
  tooltip("Focal length over the diameter of the lens, for film 36 mm wide. Smaller blurs more.");
  if (slider("##focus", "Focus", focus,
             {.lo = 0.05f,
              .hi = 100,
              .log = true,
              .decimals = 3,
              .unit = "m",
              .typed_lo = scene::k_least_focus,
              .typed_hi = 1e6f}))
    controls.act("camera.focus_distance", focus);
  tooltip("Distance of the plane of focus along the view axis.");
  const float half = 0.5f * (ImGui::CalcItemWidth() - px(4));
  if (button("##focusing", "Focus by a click", focusing, half)) controls.act("camera.focusing", !focusing);
  tooltip("The next click in the picture puts the plane of focus there.");
  ImGui::SameLine(0, px(4));
  if (button("##show_focus", "Show", controls.open.setting_on("overlay.focus"), half))
    controls.actions.toggle("overlay.focus");
  tooltip(plan::find_option("overlay.focus")->help);
  if (slider("##blades", "Blades", blades, {.lo = 0, .hi = 12, .decimals = 0, .step = 1, .at_zero = "round"}))
    controls.act("camera.blades", static_cast<int>(blades < 0.5f ? 0 : std::max(3.0f, blades)));
  tooltip("Corners of the aperture, which bright points out of focus take the shape of.");
  if (lens.blades > 0) {
    if (slider("##rotation", "Rotation", rotation,
               {.lo = -180, .hi = 180, .decimals = 0, .unit = "\xC2\xB0"}))
      controls.act("camera.blades", lens.blades, named("rotation", rotation));
    tooltip("Rotation of the aperture.");
  }
}

void projections(Controls& controls, const scene::Camera& camera) {
  static constexpr ChoiceButton k_buttons[] = {
      {scene::k_projection_names[0], "Plane", "Perspective: straight lines stay straight."},
      {scene::k_projection_names[1], "Panorama",
       "All directions, by longitude and latitude. Best in a picture twice as wide as high."},
      {scene::k_projection_names[2], "Fisheye",
       "180 degrees in a circle: the distance from its middle is the angle from the view axis."}};
  if (const ChoiceButton* pressed = choice_buttons("projection", k_buttons, size_t(camera.wide)))
    controls.act("camera.projection", pressed->name);
}

/// What few views need: shift, depth of field, section.
void lens_and_section(Controls& controls, const commands::Navigation& camera, bool focusing) {
  if (!camera.view) return;
  if (camera.view->camera.perspective()) {
    lens_shift(controls, camera.view->camera);
    depth_of_field(controls, camera.view->camera.lens, focusing);
  }
  section_plane(controls, *camera.view);
}

void cameras(Controls& controls, const commands::Navigation& camera, const std::function<void()>& keep_view) {
  const auto& list = controls.open.scene->cameras;
  if (list.empty()) quiet_line("The scene has no camera");
  for (size_t i = 0; i < list.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (list_row("##camera", camera.scene_camera == static_cast<int>(i),
                 display_name(list[i].name, "Camera", i), i < 9 ? fmt::format("{}", i + 1) : "", 0, 0))
      controls.act("camera.select", i + 1);
    tooltip(
        fmt::format("{}: {}.{}", display_name(list[i].name, "Camera", i),
                    list[i].orthographic ? "orthographic" : scene::k_projection_names[size_t(list[i].wide)],
                    i < 9 ? fmt::format(" Key {}.", i + 1) : ""));
    ImGui::PopID();
  }
  if (!camera.view) return;
  gap(4);
  const Viewpoint& view = *camera.view;
  if (view.camera.orthographic) {
    float height = 2 * view.camera.ymag;
    if (slider("##height", "Height", height,
               {.lo = 0.01f, .hi = 1000, .log = true, .decimals = 2, .unit = "m"}))
      controls.act("camera.height", height);
    tooltip("Height of an orthographic camera's view.");
  } else if (view.camera.perspective()) {
    // The command takes the angle, which has the same meaning in a window of any shape.
    float lens = commands::focal_length_mm(view.camera.yfov, camera.aspect);
    if (slider("##lens", "Lens", lens, {.lo = 8, .hi = 200, .log = true, .decimals = 1, .unit = "mm"}))
      controls.act("camera.fov", commands::yfov_from_focal_length(lens, camera.aspect) * 180 / k_pi);
    tooltip(fmt::format("Focal length for a frame 36 mm wide; the vertical field of view is {:.1f}\xC2\xB0.",
                        view.camera.yfov * 180 / k_pi));
  }
  if (!view.camera.orthographic) projections(controls, view.camera);
  float speed = camera.speed;
  if (slider("##speed", "Fly speed", speed,
             {.lo = 0.01f, .hi = 1000, .log = true, .decimals = 2, .unit = "m/s"}))
    controls.act("camera.speed", speed);
  tooltip(
      "Speed of flight with W A S D Q E while the pointer is over the picture; Shift flies four times as "
      "fast.");
  if (!view.camera.orthographic) {
    if (button("##walk", "Walk along the floor", camera.walking, ImGui::CalcItemWidth()))
      controls.act("camera.walking", !camera.walking);
    tooltip("W A S D walk at eye height, also on stairs. H.");
    float height = camera.eye_height;
    if (camera.walking) {
      if (slider("##eye_height", "Eye height", height,
                 {.lo = 0.1f, .hi = 10, .log = true, .decimals = 2, .unit = "m"}))
        controls.act("camera.eye_height", height);
      tooltip("Height of the eye above the floor. Q and E change it too.");
    }
  }
  const vec3 eye = commands::eye_of(view.camera);
  value_row("Position",
            fmt::format("{} {} {} m", padded(real_text(eye.x, 2), 6), padded(real_text(eye.y, 2), 6),
                        padded(real_text(eye.z, 2), 6)),
            "Position of the camera: x, y (up), z in metres.");
  std::string forgotten;
  int row = 0;
  for (const auto& [name, place] : camera.bookmarks_of(controls.open.scene.get())) {
    ImGui::PushID(row++);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (list_row("##bookmark", false, name, "bookmark", 0, 28)) controls.act("camera.go", name);
    tooltip(fmt::format("{}: restores this view.", name));
    if (row_sign(at, "##forget", Sign::close, false, "Deletes the bookmark.")) forgotten = name;
    ImGui::PopID();
  }
  if (!forgotten.empty()) controls.act("camera.forget", forgotten);
  if (button("##bookmark", "Bookmark this view", false, ImGui::CalcItemWidth())) keep_view();
  tooltip("Saves the view for this scene, also for later runs. Ctrl+B.");
}

void environment(Controls& controls) {
  const scene::Environment& e = controls.open.scene->environment;
  const bool image = e.image != scene::k_none;
  const bool dark = !image && strength_of(e.radiance) <= 0;
  value_row(
      "Light",
      controls.open.sky() ? "sky by formula"
      : image             ? (e.file.empty() ? "image" : e.file)
      : dark              ? "none"
                          : "even radiance",
      std::string(image ? "A latitude-longitude image around the scene." : "Radiance from every direction.") +
          " Drop an .exr or .hdr file on the window to replace it.");
  gap(4);
  ImGui::BeginDisabled(dark);
  float shown = std::max(controls.open.environment_scale(), 1e-3f);
  if (slider("##scale", "Strength", shown,
             {.lo = 1e-3f,
              .hi = 1000,
              .log = true,
              .decimals = 3,
              .unit = "\xC3\x97",
              .bar = false,
              .travel = 0.25f}))
    controls.act("environment.set", named("scale", shown));
  tooltip("Multiplies the radiance of the environment.");
  ImGui::BeginDisabled(!image);
  float turn = std::remainder(controls.open.environment_rotation(), 360.0f);
  if (slider("##rotation", "Rotation", turn, {.lo = -180, .hi = 180, .decimals = 1, .unit = "\xC2\xB0"}))
    controls.act("environment.set", named("rotation", turn));
  tooltip("Rotates the image counter-clockwise, seen from above. Ctrl + drag in the picture rotates it too.");
  ImGui::EndDisabled();
  ImGui::EndDisabled();
  if (button("##image", "Image\xE2\x80\xA6", false, ImGui::CalcItemWidth()))
    controls.act("dialog.environment");
  tooltip("Chooses a latitude-longitude image (.exr or .hdr) in place of the environment.");
  sky_rows(controls);
  option_control(controls, "film.background", "Background");
  if (!controls.open.environment_file().empty() || controls.open.sky_replaces()) {
    if (button("##own", "Restore scene environment", false, ImGui::CalcItemWidth()))
      controls.act("environment.own");
    tooltip("Uses the environment from the scene file.");
  }
}

}  // namespace

void draw_scene_panel(Controls& controls, const commands::Navigation& camera, SceneView& view,
                      const std::function<void()>& keep_view, const Area& area) {
  begin_panel("##scene", area, colour::panel, true);
  if (std::exchange(view.to_top, false)) ImGui::SetScrollY(0);
  if (!controls.open.scene) {
    bool open = true;
    section("Scene", open);
    begin_padded();
    gap(4);
    quiet_line("No scene is open");
    end_padded();
    ImGui::End();
    return;
  }
  const auto block = [&](const char* title, size_t count, bool fallback, auto&& draw) {
    panel_block(controls, title, fallback, count > 0 ? fmt::format("{}", count) : "", 10, [&] {
      ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(8), px(2)});
      draw();
      ImGui::PopStyleVar();
    });
  };
  // A selection made elsewhere, for example by a click in the picture, is scrolled into view.
  const bool reveal = view.reveals(camera.selection);
  if (reveal && camera.selection.kind == Kind::instance) controls.sections["Objects"] = true;
  if (reveal && camera.selection.kind == Kind::material) controls.sections["Materials"] = true;
  if (reveal && camera.selection.kind == Kind::light) controls.sections["Lights"] = true;
  block("Camera", controls.open.scene->cameras.size(), true, [&] { cameras(controls, camera, keep_view); });
  block("Lens and section", 0, false, [&] { lens_and_section(controls, camera, view.focusing); });
  block("Lights", controls.open.lights().size() + emitters(controls.open, camera).size(), true,
        [&] { draw_light_rows(controls, camera, view, reveal); });
  block("Environment", 0, true, [&] { environment(controls); });
  block("Materials", controls.open.scene->materials.size(), true,
        [&] { draw_material_rows(controls, camera.selection, view, reveal); });
  block("Objects", controls.open.scene->instances.size(), false,
        [&] { draw_object_rows(controls, camera, view, reveal); });
  hairline();
  ImGui::End();
}

}  // namespace lucerna::ui
