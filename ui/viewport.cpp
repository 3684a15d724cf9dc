// The middle of the window: the view toolbar, the picture, and navigation in it.
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/figures.h"
#include "commands/light_edit.h"
#include "lamp_handles.h"
#include "pixel_card.h"
#include "scene/projection.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {

void Ui::cancel_object_drag() {
  const uint64_t before = work.session.commands();
  actions.cancel_gesture();
  if (work.session.commands() > before) rebuild.begin(work.session.commands(), work.now);
  drag.object.reset(), drag.over = true;
}

void Ui::cancel_lamp_drag() {
  actions.cancel_gesture();
  drag.lamp.reset(), drag.over = true;
}

namespace {

ImU32 layer_mark(const std::string& layer) {
  for (size_t c = 0; c < session::k_components; ++c)
    if (layer == session::k_component_names[c]) return colour::component[c];
  return 0;
}

std::string layer_help(const std::string& layer) {
  if (layer == "beauty") return "Shows the sum of the components whose eye is on.";
  if (layer_mark(layer)) return fmt::format("Shows the {} component.", layer);
  if (layer == "albedo") return "Shows the reflectance of the first surface.";
  if (layer == "normal") return "Shows the shading normal of the first surface.";
  if (layer == "depth") return "Shows the distance to the first surface.";
  if (layer == "samples") return "Shows the samples taken in each pixel.";
  if (layer == "error") return "Shows the estimated error as seen: relative to the surrounding light.";
  if (layer == "cost") return "Shows the device time of each pixel's paths.";
  return fmt::format("Shows the layer {}.", layer);
}

/// Layers as buttons; those that do not fit are in a list.
void layer_buttons(Actions& actions, const commands::OpenScene& open, float room) {
  const OptionInfo* option = plan::find_option("film.layer");
  if (!option) return;
  const std::vector<std::string>& layers = option->choices;
  const std::string& current = open.setting("film.layer");
  const float between = px(4);
  float list_width = px(96);
  const auto width_of = [&](const std::string& layer) { return text_width(capitalised(layer)) + px(18); };
  const float all =
      std::accumulate(layers.begin(), layers.end(), -between,
                      [&](float sum, const std::string& l) { return sum + width_of(l) + between; });
  size_t fitting = layers.size();
  bool letters = false;
  if (all > room) {
    // Components stay together: beauty and the four, by name or by first letters, or the list only.
    constexpr size_t k_together = 1 + session::k_components;
    const auto need = [&](bool short_names) {
      float sum = width_of(layers[0]) + between + (short_names ? px(76) : list_width);
      for (size_t i = 1; i < k_together; ++i) sum += between + (short_names ? px(26) : width_of(layers[i]));
      return sum;
    };
    fitting = need(true) <= room ? k_together : 0;
    letters = need(false) > room;
    if (letters) list_width = px(76);
  }
  for (size_t i = 0; i < fitting; ++i) {
    const bool letter = letters && i > 0;
    const std::string name = capitalised(layers[i]);
    if (button(("##layer" + layers[i]).c_str(), letter ? name.substr(0, 1) : name, layers[i] == current,
               letter ? px(26) : width_of(layers[i]), layer_mark(layers[i])))
      actions.act("set", "film.layer", layers[i]);
    tooltip(layer_help(layers[i]));
    ImGui::SameLine(0, between);
  }
  if (fitting < layers.size()) {
    std::vector<std::string> rest(layers.begin() + static_cast<std::ptrdiff_t>(fitting), layers.end()), names;
    std::transform(rest.begin(), rest.end(), std::back_inserter(names), capitalised);
    int chosen = static_cast<int>(std::find(rest.begin(), rest.end(), current) - rest.begin());
    if (chosen == static_cast<int>(rest.size())) chosen = -1;
    const bool none = chosen < 0;
    if (choice("##layers", none ? "More" : "", names, chosen, list_width))
      actions.act("set", "film.layer", rest[static_cast<size_t>(chosen)]);
    tooltip("More layers.");
  }
}

constexpr float k_drag = 3;  // design pixels that distinguish a drag from a click

bool dragging() {
  for (int button = 0; button < 3; ++button)
    if (ImGui::GetIO().MouseDown[button] && ImGui::IsMouseDragging(button, px(k_drag))) return true;
  return false;
}

/// The point of the scene under the pointer, if any.
std::optional<vec3> under_pointer(commands::Navigation& camera, const Area& shown) {
  const ImVec2 at = ImGui::GetIO().MousePos;
  const float x = (at.x - shown.lo.x) / std::max(1.0f, shown.width());
  const float y = (at.y - shown.lo.y) / std::max(1.0f, shown.height());
  if (!camera.view || x < 0 || x > 1 || y < 0 || y > 1) return std::nullopt;
  const auto hit = surface_at(camera, shown, at);
  return hit ? std::optional(hit->position) : std::nullopt;
}

/// The sun that a drag rotates if there is no environment image: the first one that is on.
std::optional<uint32_t> first_sun(const commands::OpenScene& open) {
  for (uint32_t i = 0; i < open.lights().size(); ++i)
    if (open.light(i).kind == scene::LightKind::directional && open.light(i).enabled) return i;
  return std::nullopt;
}
bool has_environment_image(const commands::OpenScene& open) {
  return open.scene &&
         (open.scene->environment.image != scene::k_none || !open.environment_file().empty() || open.sky());
}

/// Rotates the sky with the pointer: points at infinity stay under it.
void turn_sky(Ui& ui, float pixels, float width) {
  const scene::Camera& camera = ui.camera.view->camera;
  const float half_width = scene::half_extent(camera, ui.camera.aspect).x;
  const float across =
      camera.orthographic ? k_pi : 2 * (camera.perspective() ? std::atan(half_width) : half_width);
  const float degrees = pixels * across / std::max(1.0f, width) * 180 / k_pi;
  // To the right is clockwise seen from above: along the compass, against the image's rotation.
  if (has_environment_image(ui.open))
    ui.act("environment.set", named("rotation", std::remainder(ui.drag.azimuth - degrees, 360.0f)));
  else if (const auto sun = first_sun(ui.open))
    ui.act("light.set", *sun + 1, named("azimuth", std::remainder(ui.drag.azimuth + degrees, 360.0f)));
  else
    ui.notice("There is no environment image and no sun to turn.", 3);
}

/// Stores the start of a drag.
void begin_drag(Ui& ui, const Area& shown) {
  ui.drag.point = under_pointer(ui.camera, shown);
  ui.drag.lamp.reset(), ui.drag.object.reset();
  ui.drag.over = false;
  const ImVec2 at = ImGui::GetIO().MousePos;
  if (!ui.click_taken() && ui.brackets && ImGui::GetIO().MouseDown[0])
    if (const auto part = object_handle_at(ui.marked(), ui.scene_view.gizmo, shown, at)) {
      ui.drag.object = begin_object_drag(ui.marked(), ui.scene_view.gizmo, *part, shown, at, ui.work.now);
      return;
    }
  if (!ui.click_taken() && drag_snap() != DragSnap::steps && ImGui::GetIO().MouseDown[0])
    ui.drag.lamp = lamp_handle_at(ui.marked(), shown, ImGui::GetIO().MousePos);
  if (ui.drag.lamp && ui.drag.lamp->part == LampHandle::Part::surface) ui.drag.lamp.reset();
  ui.drag.azimuth = ui.open.environment_rotation();
  if (const auto sun = first_sun(ui.open); sun && !has_environment_image(ui.open))
    ui.drag.azimuth = commands::bearing_of(ui.open.light(*sun).direction).azimuth;
}

/// Moves to a view unless a surface is in the way.
void go(Ui& ui, const Viewpoint& to, bool through, bool by_wheel) {
  Viewpoint view = to;
  const vec3 from = commands::eye_of(ui.camera.view->camera), step = commands::eye_of(to.camera) - from;
  if (!through && !to.camera.orthographic && glm::length(step) > 0) {
    bool blocked = false;
    // Closer than a walker, for close-ups of small objects.
    const float clear = 0.25f * commands::clearance(to.extent);
    const vec3 end = commands::step_straight(ui.camera.look(), from, step, clear, &blocked);
    if (blocked) {
      ui.say_blocked();
      if (!by_wheel) return;
      view.camera.to_world[3] = vec4(end, 1);
    }
  }
  if (by_wheel)
    ui.place_by_wheel(view);
  else
    ui.place(view);
}

/// Flies or walks by `metres` to the right, upwards and forwards.
void advance_view(Ui& ui, const vec3& metres, bool through) {
  Viewpoint view = *ui.camera.view;
  bool blocked = false;
  if (ui.camera.walking && !view.camera.orthographic) {
    if (metres.y != 0)
      ui.act("camera.eye_height", std::clamp(ui.camera.eye_height + metres.y, 0.05f, 100.0f));
    if (metres.x == 0 && metres.z == 0) return;
    view = *ui.camera.view;
    blocked = commands::walk(view, ui.camera.look(), {metres.x, metres.z}, ui.camera.eye_height, through);
  } else if (through || view.camera.orthographic) {
    commands::fly(view, metres);
  } else {
    const vec3 step = metres.x * commands::right_of(view.camera) + metres.y * commands::up_of(view.camera) +
                      metres.z * commands::forward_of(view.camera);
    view.camera.to_world[3] = vec4(commands::step_among(ui.camera.look(), commands::eye_of(view.camera), step,
                                                        commands::clearance(view.extent), &blocked),
                                   1);
  }
  if (blocked) ui.say_blocked();
  ui.place(view);
}

/// Keys and mouse over the picture.
void navigate(Ui& ui, const Area& shown, bool hovered, bool active) {
  ImGuiIO& io = ImGui::GetIO();
  if (!ui.camera.view) return;
  const float height = std::max(1.0f, shown.height());
  const vec2 drag(io.MouseDelta.x, io.MouseDelta.y);
  const bool typing = io.WantTextInput ||
                      ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  const bool through = io.KeyAlt;

  // Flight: while the pointer is over the picture.
  vec3 wish(0);
  // A key pressed with Ctrl is a command until it is released, even if Ctrl is released before it.
  for (const auto& [key, mods] : ui.keys)
    if (mods & (GLFW_MOD_CONTROL | GLFW_MOD_SUPER))
      ui.chorded.insert(key);
    else
      ui.chorded.erase(key);
  if ((hovered || active) && !typing && !io.KeyCtrl) {
    const auto down = [&](int key) { return io.KeysDown[key] && !ui.chorded.contains(key) ? 1.0f : 0.0f; };
    wish = {down(GLFW_KEY_D) - down(GLFW_KEY_A), down(GLFW_KEY_E) - down(GLFW_KEY_Q),
            down(GLFW_KEY_W) - down(GLFW_KEY_S)};
  }
  const bool flying = wish != vec3(0);
  if (flying || ui.flight.moving()) {
    const float seconds = std::min(io.DeltaTime, 0.1f);
    const vec3 metres = advance(ui.flight, wish, ui.camera.speed * (io.KeyShift ? 4.0f : 1.0f), seconds);
    if (flying) ui.actions.follow_gesture();  // the first move belongs to the flight already
    advance_view(ui, metres, through);
    ui.moving = true;
  }
  if (active || flying || io.MouseWheel != 0) ui.turntable = 0;
  if (ui.turntable > 0) {
    Viewpoint view = *ui.camera.view;
    commands::orbit(view, {2 * k_pi * std::min(io.DeltaTime, 0.1f) / ui.turntable, 0});
    ui.turn(view);
    ui.moving = true;
  }
  // A press that hardly moves is a click; it becomes a drag after three pixels.
  if (active && (drag.x != 0 || drag.y != 0) && (flying || dragging())) {
    // Half a turn across the height of the picture.
    const vec2 angles = -drag * (k_pi / height);
    Viewpoint view = *ui.camera.view;
    if (ui.drag.object) {
      follow_pointer(*ui.drag.object, ui.marked(), shown, io.MousePos, drag_snap(), ui.work.now);
    } else if (ui.drag.over) {
    } else if (io.MouseDown[0] && ui.drag.lamp) {
      if (ui.camera.selection != Selection{Kind::light, ui.drag.lamp->light})
        ui.act("select", "light", ui.drag.lamp->light + 1);
      drag_lamp(ui.actions, ui.marked(), *ui.drag.lamp, shown);
    } else if (io.MouseDown[0] && io.KeyCtrl) {
      turn_sky(ui, io.MousePos.x - io.MouseClickedPos[0].x, shown.width());
    } else if (io.MouseDown[1] || (flying && io.MouseDown[0])) {
      commands::look(view, 0.5f * angles);
      ui.place(view);
    } else if (io.MouseDown[2] || io.KeyShift) {
      commands::pan(view, drag, height);
      go(ui, view, through, false);
    } else if (io.MouseDown[0]) {
      if (ui.drag.point && !view.camera.orthographic)
        commands::orbit_about(view, *ui.drag.point, {angles.x, -angles.y});
      else
        commands::orbit(view, {angles.x, -angles.y});
      go(ui, view, through, false);
    }
  }
  if (hovered && io.MouseWheel != 0) {
    if (flying) {
      ui.act("camera.speed", std::clamp(ui.camera.speed * std::pow(1.2f, io.MouseWheel), 0.01f, 1000.0f));
      return;
    }
    Viewpoint view = *ui.camera.view;
    if (const auto point = under_pointer(ui.camera, shown))
      commands::dolly_towards(view, *point, io.MouseWheel);
    else
      commands::dolly(view, io.MouseWheel);
    go(ui, view, through, true);
  }
}

/// Sends a place given in numbers, when its control rests or is let go.
void follow_typed_place(Ui& ui) {
  if (!ui.scene_view.typed) return;
  TypedPlace& typed = *ui.scene_view.typed;
  if (typed.changed_at == 0) typed.changed_at = ui.work.now;
  const bool held = ImGui::GetActiveID() == typed.control && typed.control != 0;
  if (!typed.line.empty()) {
    ui.wake(2);
    if (held ? !ui.rebuild.follows(ui.work.now - typed.changed_at) : ui.rebuild.command != 0) return;
    const uint64_t before = ui.work.session.commands();
    ui.actions.act_in(typed.gesture, std::exchange(typed.line, {}));
    if (ui.work.session.commands() > before) ui.rebuild.begin(ui.work.session.commands(), ui.work.now);
  }
  if (!held) ui.scene_view.typed.reset();
}

/// Sends where an object is dragged to, when the pointer rests or is let go.
void follow_object_drag(Ui& ui, bool active) {
  ui.rebuild.follow(ui.work.session.commands_done(), ui.work.now);
  follow_typed_place(ui);
  if (!ui.drag.object) return;
  ObjectDrag& drag = *ui.drag.object;
  if (!active) {
    send_place(ui.actions, ui.open, drag, ui.rebuild, ui.work.now);
    ui.drag.object.reset();
    return;
  }
  if (drag.place == drag.sent) return;
  ui.wake(2);
  if (ui.rebuild.follows(ui.work.now - drag.moved_at))
    send_place(ui.actions, ui.open, drag, ui.rebuild, ui.work.now);
}

/// A click selects the light whose mark is under it, otherwise the object. With the dropper it sets the
/// exposure, and while focusing the plane of focus.
void click(Ui& ui, const Area& shown) {
  const ImVec2 at = ImGui::GetIO().MousePos;
  if (closes_region(ui.open, shown, at)) return ui.act("region.clear");
  if (!ui.click_taken())
    if (const auto lamp = lamp_handle_at(ui.marked(), shown, at))
      return ui.act("select", lamp->part == LampHandle::Part::surface ? "material" : "light",
                    lamp->light + 1);
  const float x = (at.x - shown.lo.x) / std::max(1.0f, shown.width());
  const float y = (at.y - shown.lo.y) / std::max(1.0f, shown.height());
  if (x < 0 || x > 1 || y < 0 || y > 1) return;
  if (ui.dropper) {
    ui.act("exposure.dropper", false);
    ui.act("exposure.at", x, y);
  } else if (ui.scene_view.focusing) {
    ui.act("camera.focusing", false);
    ui.act("camera.focus", x, y);
  } else if (ui.paths.pick == PathsView::Pick::pixel) {
    ui.act("paths.pick", "none");
    trace_pixel(ui, {x, y});
  } else if (!ui.click_taken()) {
    ui.act("pick", x, y);
  }
}

std::string help_of(Ui& ui, const LampHandle& handle) {
  switch (handle.part) {
    case LampHandle::Part::size:
      return "Drag it to change the lamp's size, or the angle of its cone. A lamp with a shape keeps its "
             "power.";
    case LampHandle::Part::aim:
      return "Aim of the light: drag it over surfaces.";
    case LampHandle::Part::surface:
      return fmt::format(
          "{}. Emissive surface: click to select its material, which can be edited under Lights.",
          ui.open.material(handle.light).name);
    case LampHandle::Part::place:
      break;
  }
  return fmt::format(
      "{}. Drag to move it parallel to the picture, with Shift vertically, with Ctrl and "
      "Shift along surfaces.",
      ui.open.light(handle.light).name);
}

std::string help_of(GizmoMode mode, GizmoPart part) {
  if (mode == GizmoMode::turn)
    return "Drag to turn the object about this axis, with Ctrl in steps of 15\xC2\xB0.";
  if (mode == GizmoMode::size)
    return part == GizmoPart::middle ? "Drag to the right or up to size the object."
                                     : "Drag to size the object along this axis, with Ctrl in steps of 0.1.";
  return part == GizmoPart::middle
             ? "Drag to move the object parallel to the picture, with Ctrl in steps of 0.1 m, with Ctrl and "
               "Shift onto surfaces."
         : part <= GizmoPart::z ? "Drag to move the object along this axis, with Ctrl in steps of 0.1 m."
                                : "Drag to move the object in this plane, with Ctrl in steps of 0.1 m.";
}

constexpr double k_rest = 0.15;  // seconds

/// While a solver's view with inspection is shown, a pointer at rest inspects the point under it. Only at
/// rest, because each inspection interrupts rendering.
void inspect_at_rest(Ui& ui, const Area& shown, bool active) {
  static ImVec2 last;
  static double since = 0;
  const ImVec2 at = ImGui::GetIO().MousePos;
  if (at.x != last.x || at.y != last.y) last = at, since = ui.work.now, ui.script_inspects = false;
  if (std::exchange(ui.inspections_known, ui.work.inspections) != ui.work.inspections) {
    ui.script_inspects = true;
    ui.inspected_place.reset();
  }
  if (ui.script_inspects) return;
  const vec2 place((at.x - shown.lo.x) / std::max(1.0f, shown.width()),
                   (at.y - shown.lo.y) / std::max(1.0f, shown.height()));
  const bool inside = place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1;
  // During a load the renderer refuses inspections.
  const bool still = !(active && dragging()) && !ui.flight.moving() && !ui.open.loading();
  if (ui.inspects_pointer() && ui.picture_hovered && inside && still) {
    if (active || ui.inspected_place == place || ui.work.now - since < k_rest) return;
    ui.inspected_place = place;
    ++ui.inspections_known;
    ui.act("inspect.at", place.x, place.y);
  } else if (ui.inspected_place) {
    ui.inspected_place.reset();
    ui.act("inspect.none");
  }
}

}  // namespace

void trace_pixel(Ui& ui, const vec2& at) {
  ui.act("inspect.trace", at.x, at.y, ui.paths.count);
  ui.act("window.side", k_paths_side);
}

void keep_view(Ui& ui) {
  const commands::Navigation::Bookmarks before = ui.camera.bookmarks_of(ui.open.scene.get());
  ui.act("camera.bookmark");
  for (const auto& [name, line] : ui.camera.bookmarks_of(ui.open.scene.get()))
    if (!before.contains(name)) ui.notice(fmt::format("Saved as '{}' in the Camera menu.", name), 4);
}

void draw_toolbar(Ui& ui, const Area& area) {
  begin_panel("##toolbar", area, colour::bar, false);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled({area.lo.x, area.hi.y - 1}, area.hi, colour::hairline);
  const float pad = px(8), y = area.lo.y + px(6);
  const float tone_width = px(88), ev_width = px(92), grey_width = px(46), tiles_width = px(46);
  float right = area.hi.x - pad;
  // In a narrow picture the layers have priority; everything else is in the menus too.
  const bool narrow = area.width() < 2 * pad + tone_width + ev_width + grey_width + tiles_width + px(96);
  const OptionInfo* tone = plan::find_option("film.tone_curve");
  if (tone) {
    right -= tone_width;
    ImGui::SetCursorScreenPos({right, y});
    std::vector<std::string> names;
    for (const std::string& name : tone->choices) names.push_back(name == "agx" ? "AgX" : capitalised(name));
    int chosen = static_cast<int>(
        std::find(tone->choices.begin(), tone->choices.end(), ui.open.setting("film.tone_curve")) -
        tone->choices.begin());
    const std::string& ocio = ui.open.setting("film.ocio");
    if (!ocio.empty()) {
      chosen = static_cast<int>(names.size());
      names.emplace_back("OCIO");
    }
    if (choice("##tone", "", names, chosen, tone_width) && static_cast<size_t>(chosen) < tone->choices.size())
      ui.act("set", "film.tone_curve", tone->choices[static_cast<size_t>(chosen)]);
    tooltip(ocio.empty() ? tone->help : ocio + ", of the configuration that $OCIO names; see the View menu.");
    right -= px(4);
  }
  if (const OptionInfo* ev = plan::find_option("film.ev")) {
    right -= ev_width;
    ImGui::SetCursorScreenPos({right, y});
    auto value = static_cast<float>(ui.open.setting_real("film.ev"));
    // Dragging covers the usual range of exposures; typing reaches the rest.
    const Slider how{.lo = std::max(-10.0f, static_cast<float>(ev->lo)),
                     .hi = std::min(10.0f, static_cast<float>(ev->hi)),
                     .decimals = 2,
                     .unit = "EV",
                     .bar = false,
                     .sign = true,
                     .travel = 0.2f,
                     .typed_lo = static_cast<float>(ev->lo),
                     .typed_hi = static_cast<float>(ev->hi)};
    if (slider("##ev", "", value, how, ev_width)) ui.act("set", "film.ev", fmt::format("{:.4g}", value));
    tooltip(ev->help + " Double-click to type.");
    right -= px(4);
  }
  if (!narrow) {
    right -= grey_width;
    ImGui::SetCursorScreenPos({right, y});
    if (button("##grey", "Grey", ui.dropper, grey_width)) ui.act("exposure.dropper", !ui.dropper);
    tooltip("The next click in the picture sets the exposure so that the clicked point is middle grey. B.");
    right -= px(4) + tiles_width;
    ImGui::SetCursorScreenPos({right, y});
    if (button("##tiles", "Tiles", ui.open.setting_on("overlay.tiles"), tiles_width))
      ui.toggle("overlay.tiles");
    tooltip(plan::find_option("overlay.tiles")->help + " T.");
  }
  right -= px(8);
  ImGui::SetCursorScreenPos({area.lo.x + pad, y});
  layer_buttons(ui.actions, ui.open, right - area.lo.x - pad);
  ImGui::End();
}

void draw_picture(Ui& ui, const Area& area) {
  begin_panel("##picture", area, colour::surround, false);
  ui.picture = area;
  ImDrawList* list = ImGui::GetWindowDrawList();
  const bool shown = ui.has_picture() && ui.texture != 0;
  Area frame = area;  // of the picture itself
  std::optional<LampHandle> hot;
  std::optional<GizmoPart> hot_part;
  if (shown) {
    // One picture pixel per window pixel; while the sizes differ the picture is centred and scaled down if
    // necessary.
    float w = static_cast<float>(ui.texture_width) * static_cast<float>(ui.picture_divisor);
    float h = static_cast<float>(ui.texture_height) * static_cast<float>(ui.picture_divisor);
    if (w > area.width() + static_cast<float>(ui.picture_divisor) ||
        h > area.height() + static_cast<float>(ui.picture_divisor)) {
      const float fit = std::min(area.width() / w, area.height() / h);
      w = std::floor(w * fit), h = std::floor(h * fit);
    }
    const ImVec2 lo(std::floor(area.lo.x + 0.5f * (area.width() - w)),
                    std::floor(area.lo.y + 0.5f * (area.height() - h)));
    list->AddImage(reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(ui.texture)), lo,
                   {lo.x + w, lo.y + h});
    frame = {lo, {lo.x + w, lo.y + h}};
    draw_comparison(ui.work, ui.compare, frame);
    if (ImGui::IsMouseDown(0))
      hot = ui.drag.lamp;
    else if (ui.picture_hovered && !ui.click_taken()) {
      if (ui.brackets)
        hot_part = object_handle_at(ui.marked(), ui.scene_view.gizmo, frame, ImGui::GetIO().MousePos);
      if (!hot_part) hot = lamp_handle_at(ui.marked(), frame, ImGui::GetIO().MousePos);
    }
    draw_lamp_handles(ui.marked(), frame, hot);
    if (ui.brackets)
      draw_object(ui.marked(), ui.scene_view.gizmo, frame, hot_part,
                  ui.drag.object ? &*ui.drag.object : nullptr,
                  ui.scene_view.typed ? &*ui.scene_view.typed : nullptr);
    draw_region(ui.open, frame);
    draw_frame_guide(ui.frame_guide, ui.open.snapshot->camera, frame);
  }
  if (!shown) draw_empty_state(ui.actions, ui.open, ui.recent, area);
  Area legend;
  if (ui.open.snapshot) {
    legend = draw_legend(ui.open, ui.light_marks, frame, ui.picture);
    draw_inspection(*ui.open.snapshot, frame, legend);
    draw_pixel_card(ui.work, frame);
    ui.histogram.draw(*ui.open.snapshot, frame, ui.picture);
  }
  draw_cards(ui.actions, ui.open, ui.cards, ui.work.now, area, legend);

  bool active = false;
  ui.picture_hovered = false;
  if (shown) {
    ImGui::SetCursorScreenPos(area.lo);
    ImGui::InvisibleButton("##view", {std::max(1.0f, area.width()), std::max(1.0f, area.height())},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    ui.picture_hovered = ImGui::IsItemHovered();
    active = ImGui::IsItemActive();
    if (drag_wipe(ui.actions, ui.work, ui.compare, frame, active)) {
      ui.wake(2);
      ImGui::End();
      return;
    }
    if (ImGui::IsItemActivated()) begin_drag(ui, frame);
    if (hot && ui.picture_hovered && !active) tooltip(help_of(ui, *hot));
    if (hot_part && ui.picture_hovered && !active) tooltip(help_of(ui.scene_view.gizmo, *hot_part));
    if ((ui.click_taken() || hot || hot_part) && ui.picture_hovered)
      ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    const bool inspected = inspect_while_held(ui, frame, active);
    // A click on the middle means what is under it; the other handles take theirs.
    const bool kept = ui.drag.object && ui.drag.object->part != GizmoPart::middle;
    if (!inspected && !kept && ui.picture_hovered && ImGui::IsMouseReleased(0) &&
        ImGui::IsItemDeactivated() && ImGui::GetIO().MouseDragMaxDistanceSqr[0] < px(k_drag) * px(k_drag))
      click(ui, frame);
  }
  if (shown && ui.side == k_paths_side) draw_paths_marks(ui.work, frame);
  if (shown && (drag_noise_area(ui.actions, ui.paths, frame, active) ||
                drag_region(ui.actions, ui.region, frame, active))) {
    ui.wake(2);
    ImGui::End();
    return;
  }
  inspect_at_rest(ui, frame, active);
  navigate(ui, frame, ui.picture_hovered, active);
  follow_object_drag(ui, active);
  ImGui::End();
}

}  // namespace lucerna::ui
