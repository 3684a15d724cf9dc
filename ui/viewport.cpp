// The middle of the window: the view toolbar, the picture, and navigation in it.
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "base/figures.h"
#include "commands/light_edit.h"
#include "lamp_handles.h"
#include "pixel_card.h"
#include "plan/views.h"
#include "scene/projection.h"
#include "solvers/registry.h"
#include "state.h"
#include "widgets.h"

namespace lucerna::ui {

bool Viewport::cancel_drag() {
  if (!drag.object && !(drag.lamp && ImGui::IsMouseDragging(0))) return false;
  const uint64_t before = work.session.commands();
  controls.actions.cancel_gesture();
  if (drag.object && work.session.commands() > before) rebuild.begin(work.session.commands(), work.now);
  if (drag.object)
    drag.object.reset();
  else
    drag.lamp.reset();
  drag.over = true;
  return true;
}

void Viewport::take_click() {
  cards.end_click_notice();
  dropper = scene_view.focusing = scene_view.highlighting = region.picks = false;
  paths.pick = PathsView::Pick::none;
  paths.marquee.reset(), region.marquee.reset();
}

bool Viewport::give_up_click() {
  if (dropper)
    controls.act("exposure.dropper", false);
  else if (scene_view.focusing)
    controls.act("camera.focusing", false);
  else if (scene_view.highlighting)
    controls.act("light.highlighting", false);
  else if (paths.pick != PathsView::Pick::none)
    controls.act("paths.pick", "none");
  else if (region.picks)
    controls.act("region.pick", false);
  else
    return false;
  return true;
}

namespace {

ImU32 layer_mark(const std::string& layer) {
  for (const size_t c : k_components)
    if (layer == session::k_component_names[c]) return colour::component[c];
  return 0;
}

const std::vector<session::LayerStatus> k_no_layers;

std::string layer_help(const commands::OpenScene& open, const std::string& layer) {
  if (layer == "beauty") return "Shows the sum of the components whose eye is on.";
  if (layer_mark(layer)) return fmt::format("Shows the {} component.", layer);
  if (layer == "albedo") return "Shows the reflectance of the first surface.";
  if (layer == "normal") return "Shows the shading normal of the first surface.";
  if (layer == "depth") return "Shows the distance to the first surface.";
  if (layer == "samples") return "Shows the samples taken in each pixel.";
  if (layer == "error") return "Shows the estimated error as seen: relative to the surrounding light.";
  if (layer == "cost") return "Shows the device time of each pixel's paths.";
  for (const session::LayerStatus& own : open.snapshot ? open.snapshot->layers : k_no_layers)
    if (own.name == layer)
      return fmt::format("Shows the light of the paths {}: {:.1f} % of the picture's.{}", own.expression,
                         100 * own.share,
                         own.lacks.empty() ? "" : " Part of its " + own.lacks + " light is not known.");
  return fmt::format("Shows the layer {}.", layer);
}

/// Layers as buttons; those that do not fit are in a list.
void layer_buttons(Actions& actions, const commands::OpenScene& open, float room) {
  const OptionInfo* option = plan::find_option("film.layer");
  if (!option) return;
  std::vector<std::string> layers = option->choices;
  if (open.snapshot)
    for (const session::LayerStatus& own : open.snapshot->layers) layers.push_back(own.name);
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
    constexpr size_t k_together = 1 + k_components.size();
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
    tooltip(layer_help(open, layers[i]));
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
  if (!camera.view || !shown.contains(at)) return std::nullopt;
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
void turn_sky(Viewport& v, float pixels, float width) {
  const scene::Camera& camera = v.work.camera.view->camera;
  const float half_width = scene::half_extent(camera, v.work.camera.aspect).x;
  const float across =
      camera.orthographic ? k_pi : 2 * (camera.perspective() ? std::atan(half_width) : half_width);
  const float degrees = pixels * across / std::max(1.0f, width) * 180 / k_pi;
  // To the right is clockwise seen from above: along the compass, against the image's rotation.
  if (has_environment_image(v.work.open))
    v.controls.act("environment.set", named("rotation", std::remainder(v.drag.azimuth - degrees, 360.0f)));
  else if (const auto sun = first_sun(v.work.open))
    v.controls.act("light.set", *sun + 1, named("azimuth", std::remainder(v.drag.azimuth + degrees, 360.0f)));
  else
    v.cards.notice("There is no environment image and no sun to turn.", 3);
}

/// Stores the start of a drag.
void begin_drag(Viewport& v, const Area& shown) {
  v.drag.point = under_pointer(v.work.camera, shown);
  v.drag.lamp.reset(), v.drag.object.reset();
  v.drag.over = false;
  const ImVec2 at = ImGui::GetIO().MousePos;
  if (!v.click_taken() && v.brackets && ImGui::GetIO().MouseDown[0])
    if (const auto part = object_handle_at(v.marked(), v.scene_view.gizmo, shown, at)) {
      v.drag.object = begin_object_drag(v.marked(), v.scene_view.gizmo, *part, shown, at, v.work.now);
      return;
    }
  if (!v.click_taken() && drag_snap() != DragSnap::steps && ImGui::GetIO().MouseDown[0])
    v.drag.lamp = lamp_handle_at(v.marked(), shown, ImGui::GetIO().MousePos);
  if (v.drag.lamp && v.drag.lamp->part == LampHandle::Part::surface) v.drag.lamp.reset();
  v.drag.azimuth = v.work.open.environment_rotation();
  if (const auto sun = first_sun(v.work.open); sun && !has_environment_image(v.work.open))
    v.drag.azimuth = commands::bearing_of(v.work.open.light(*sun).direction).azimuth;
}

/// Keys and mouse over the picture.
void navigate(Viewport& v, const Keys& keys, const Area& shown, bool active) {
  const ImGuiIO& io = ImGui::GetIO();
  commands::Navigation& camera = v.work.camera;
  if (!camera.view) return;
  const float height = std::max(1.0f, shown.height());
  const vec2 drag(io.MouseDelta.x, io.MouseDelta.y);
  const bool typing = io.WantTextInput ||
                      ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  // Flight: while the pointer is over the picture.
  v.moves.follow(keys, (v.hovered || active) && !typing, active || io.MouseWheel != 0);
  const bool flying = v.moves.steered();
  // A press that hardly moves is a click; it becomes a drag after three pixels.
  if (active && (drag.x != 0 || drag.y != 0) && (flying || dragging())) {
    // Half a turn across the height of the picture.
    const vec2 angles = -drag * (k_pi / height);
    Viewpoint view = *camera.view;
    if (v.drag.object) {
      follow_pointer(*v.drag.object, v.marked(), shown, io.MousePos, drag_snap(), v.work.now);
    } else if (v.drag.over) {
    } else if (io.MouseDown[0] && v.drag.lamp) {
      if (camera.selection != Selection{Kind::light, v.drag.lamp->light})
        v.controls.act("select", "light", v.drag.lamp->light + 1);
      drag_lamp(v.controls.actions, v.marked(), *v.drag.lamp, shown);
    } else if (io.MouseDown[0] && io.KeyCtrl) {
      turn_sky(v, io.MousePos.x - io.MouseClickedPos[0].x, shown.width());
    } else if (io.MouseDown[1] || (flying && io.MouseDown[0])) {
      commands::look(view, 0.5f * angles);
      v.moves.place(view);
    } else if (io.MouseDown[2] || io.KeyShift) {
      commands::pan(view, drag, height);
      v.moves.go(view, false);
    } else if (io.MouseDown[0]) {
      if (v.drag.point && !view.camera.orthographic)
        commands::orbit_about(view, *v.drag.point, {angles.x, -angles.y});
      else
        commands::orbit(view, {angles.x, -angles.y});
      v.moves.go(view, false);
    }
  }
  if (v.hovered && io.MouseWheel != 0) {
    if (flying) {
      v.controls.act("camera.speed",
                     std::clamp(camera.speed * std::pow(1.2f, io.MouseWheel), 0.01f, 1000.0f));
      return;
    }
    Viewpoint view = *camera.view;
    if (const auto point = under_pointer(camera, shown))
      commands::dolly_towards(view, *point, io.MouseWheel);
    else
      commands::dolly(view, io.MouseWheel);
    v.moves.go(view, true);
  }
}

/// Sends a place given in numbers, when its control rests or is let go.
void follow_typed_place(Viewport& v) {
  if (!v.scene_view.typed) return;
  TypedPlace& typed = *v.scene_view.typed;
  if (typed.changed_at == 0) typed.changed_at = v.work.now;
  const bool held = ImGui::GetActiveID() == typed.control && typed.control != 0;
  if (!typed.line.empty()) {
    v.controls.actions.wake(2);
    if (held ? !v.rebuild.follows(v.work.now - typed.changed_at) : v.rebuild.command != 0) return;
    const uint64_t before = v.work.session.commands();
    v.controls.actions.act_in(typed.gesture, std::exchange(typed.line, {}));
    if (v.work.session.commands() > before) v.rebuild.begin(v.work.session.commands(), v.work.now);
  }
  if (!held) v.scene_view.typed.reset();
}

/// Sends where an object is dragged to, when the pointer rests or is let go.
void follow_object_drag(Viewport& v, bool active) {
  v.rebuild.follow(v.work.session.commands_done(), v.work.now);
  follow_typed_place(v);
  if (!v.drag.object) return;
  ObjectDrag& drag = *v.drag.object;
  if (!active) {
    send_place(v.controls.actions, v.work.open, drag, v.rebuild, v.work.now);
    v.drag.object.reset();
    return;
  }
  if (drag.place == drag.sent) return;
  v.controls.actions.wake(2);
  if (v.rebuild.follows(v.work.now - drag.moved_at))
    send_place(v.controls.actions, v.work.open, drag, v.rebuild, v.work.now);
}

/// A click selects the light whose mark or highlight is under it, otherwise the object. With the dropper it
/// sets the exposure, while focusing the plane of focus, while highlighting the place of a highlight.
void click(Viewport& v, const Area& shown) {
  const ImVec2 at = ImGui::GetIO().MousePos;
  if (closes_region(v.work.open, shown, at)) return v.controls.act("region.clear");
  if (!v.click_taken())
    if (const auto lamp = lamp_handle_at(v.marked(), shown, at))
      return v.controls.act("select", lamp->part == LampHandle::Part::surface ? "material" : "light",
                            lamp->light + 1);
  if (!shown.contains(at)) return;
  const vec2 place = shown.place_of(at);
  if (v.dropper) {
    v.controls.act("exposure.dropper", false);
    v.controls.act("exposure.at", place.x, place.y);
  } else if (v.scene_view.focusing) {
    v.controls.act("camera.focusing", false);
    v.controls.act("camera.focus", place.x, place.y);
  } else if (v.scene_view.highlighting) {
    v.controls.act("light.highlighting", false);
    if (v.work.camera.selection.kind == commands::Kind::light)
      v.controls.act("light.highlight", v.work.camera.selection.index + 1, place.x, place.y);
  } else if (v.paths.pick == PathsView::Pick::pixel) {
    v.controls.act("paths.pick", "none");
    trace_pixel(v.controls.actions, v.paths, place);
  } else if (!v.click_taken()) {
    v.controls.act("pick", place.x, place.y);
  }
}

std::string help_of(Viewport& v, const LampHandle& handle) {
  switch (handle.part) {
    case LampHandle::Part::size:
      return "Drag it to change the lamp's size, or the angle of its cone. A lamp with a shape keeps its "
             "power.";
    case LampHandle::Part::aim:
      return "Aim of the light: drag it over surfaces.";
    case LampHandle::Part::surface:
      return fmt::format(
          "{}. Emissive surface: click to select its material, which can be edited under Lights.",
          v.work.open.material(handle.light).name);
    case LampHandle::Part::place:
      break;
  }
  return fmt::format(
      "{}. Drag to move it parallel to the picture, with Shift vertically, with Ctrl and "
      "Shift along surfaces.",
      v.work.open.light(handle.light).name);
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

/// True if a view is on that inspects the place under the pointer.
bool inspects_pointer(const Controls& controls) {
  const auto inspects = [&](const solvers::ViewInfo& view) {
    return view.inspects_pointer && controls.view_on(view);
  };
  const std::span<const solvers::ViewInfo> views = plan::views();
  if (std::any_of(views.begin(), views.end(), inspects)) return true;
  for (const solvers::SolverInfo* solver : solvers::registered())
    if (controls.open.uses(*solver) && std::any_of(solver->views.begin(), solver->views.end(), inspects))
      return true;
  return false;
}

constexpr double k_rest = 0.15;  // seconds

/// While a solver's view with inspection is shown, a pointer at rest inspects the point under it. Only at
/// rest, because each inspection interrupts rendering.
void inspect_at_rest(Viewport& v, const Area& shown, bool active) {
  static ImVec2 last;
  static double since = 0;
  const ImVec2 at = ImGui::GetIO().MousePos;
  if (at.x != last.x || at.y != last.y) last = at, since = v.work.now, v.script_inspects = false;
  if (std::exchange(v.inspections_known, v.work.inspections) != v.work.inspections) {
    v.script_inspects = true;
    v.inspected_place.reset();
  }
  if (v.script_inspects) return;
  const vec2 place = shown.place_of(at);
  // During a load the renderer refuses inspections.
  const bool still = !(active && dragging()) && !v.moves.flying() && !v.work.open.loading();
  if (inspects_pointer(v.controls) && v.hovered && shown.contains(at) && still) {
    if (active || v.inspected_place == place || v.work.now - since < k_rest) return;
    v.inspected_place = place;
    ++v.inspections_known;
    v.controls.act("inspect.at", place.x, place.y);
  } else if (v.inspected_place) {
    v.inspected_place.reset();
    v.controls.act("inspect.none");
  }
}

}  // namespace

void trace_pixel(Actions& actions, const PathsView& paths, const vec2& at) {
  actions.act("inspect.trace", at.x, at.y, paths.count);
  actions.act("window.side", k_paths_side);
}

void keep_view(Actions& actions, const commands::OpenScene& open, const commands::Navigation& camera,
               CardsView& cards) {
  const commands::Navigation::Bookmarks before = camera.bookmarks_of(open.scene.get());
  actions.act("camera.bookmark");
  for (const auto& [name, line] : camera.bookmarks_of(open.scene.get()))
    if (!before.contains(name)) cards.notice(fmt::format("Saved as '{}' in the Camera menu.", name), 4);
}

void draw_toolbar(Actions& actions, const commands::OpenScene& open, bool dropper, const Area& area) {
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
        std::find(tone->choices.begin(), tone->choices.end(), open.setting("film.tone_curve")) -
        tone->choices.begin());
    const std::string& ocio = open.setting("film.ocio");
    if (!ocio.empty()) {
      chosen = static_cast<int>(names.size());
      names.emplace_back("OCIO");
    }
    if (choice("##tone", "", names, chosen, tone_width) && static_cast<size_t>(chosen) < tone->choices.size())
      actions.act("set", "film.tone_curve", tone->choices[static_cast<size_t>(chosen)]);
    tooltip(ocio.empty() ? tone->help : ocio + ", of the configuration that $OCIO names; see the View menu.");
    right -= px(4);
  }
  if (const OptionInfo* ev = plan::find_option("film.ev")) {
    right -= ev_width;
    ImGui::SetCursorScreenPos({right, y});
    auto value = static_cast<float>(open.setting_real("film.ev"));
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
    if (slider("##ev", "", value, how, ev_width)) actions.act("set", "film.ev", fmt::format("{:.4g}", value));
    tooltip(ev->help + " Double-click to type.");
    right -= px(4);
  }
  if (!narrow) {
    right -= grey_width;
    ImGui::SetCursorScreenPos({right, y});
    if (button("##grey", "Grey", dropper, grey_width)) actions.act("exposure.dropper", !dropper);
    tooltip("The next click in the picture sets the exposure so that the clicked point is middle grey. B.");
    right -= px(4) + tiles_width;
    ImGui::SetCursorScreenPos({right, y});
    if (button("##tiles", "Tiles", open.setting_on("overlay.tiles"), tiles_width))
      actions.toggle("overlay.tiles");
    tooltip(plan::find_option("overlay.tiles")->help + " T.");
  }
  right -= px(8);
  ImGui::SetCursorScreenPos({area.lo.x + pad, y});
  layer_buttons(actions, open, right - area.lo.x - pad);
  ImGui::End();
}

void draw_picture(Viewport& v, const Keys& keys, const std::vector<std::string>& recent, bool paths_marks,
                  const Area& area) {
  if (!v.click_taken()) v.cards.end_click_notice();
  begin_panel("##picture", area, colour::surround, false);
  v.area = area;
  ImDrawList* list = ImGui::GetWindowDrawList();
  const bool shown = v.has_picture() && v.texture != 0;
  Area frame = area;  // of the picture itself
  std::optional<LampHandle> hot;
  std::optional<GizmoPart> hot_part;
  if (shown) {
    // One picture pixel per window pixel; while the sizes differ the picture is centred and scaled down if
    // necessary.
    float w = static_cast<float>(v.texture_width) * static_cast<float>(v.divisor);
    float h = static_cast<float>(v.texture_height) * static_cast<float>(v.divisor);
    if (w > area.width() + static_cast<float>(v.divisor) ||
        h > area.height() + static_cast<float>(v.divisor)) {
      const float fit = std::min(area.width() / w, area.height() / h);
      w = std::floor(w * fit), h = std::floor(h * fit);
    }
    const ImVec2 lo(std::floor(area.lo.x + 0.5f * (area.width() - w)),
                    std::floor(area.lo.y + 0.5f * (area.height() - h)));
    list->AddImage(reinterpret_cast<ImTextureID>(static_cast<uintptr_t>(v.texture)), lo,
                   {lo.x + w, lo.y + h});
    frame = {lo, {lo.x + w, lo.y + h}};
    draw_comparison(v.work, v.compare, frame);
    if (ImGui::IsMouseDown(0))
      hot = v.drag.lamp;
    else if (v.hovered && !v.click_taken()) {
      if (v.brackets)
        hot_part = object_handle_at(v.marked(), v.scene_view.gizmo, frame, ImGui::GetIO().MousePos);
      if (!hot_part) hot = lamp_handle_at(v.marked(), frame, ImGui::GetIO().MousePos);
    }
    draw_lamp_handles(v.marked(), frame, hot);
    if (v.brackets)
      draw_object(v.marked(), v.scene_view.gizmo, frame, hot_part, v.drag.object ? &*v.drag.object : nullptr,
                  v.scene_view.typed ? &*v.scene_view.typed : nullptr);
    draw_region(v.work.open, frame);
    draw_frame_guide(v.frame_guide, v.work.open.snapshot->camera, frame);
  }
  if (!shown) draw_empty_state(v.controls.actions, v.work.open, recent, area);
  Area legend;
  if (v.work.open.snapshot) {
    legend = draw_legend(v.work.open, v.light_marks, frame, v.area);
    draw_inspection(*v.work.open.snapshot, frame, legend);
    draw_pixel_card(v.work, frame);
    v.histogram.draw(*v.work.open.snapshot, frame, v.area);
  }
  draw_cards(v.controls.actions, v.work.open, v.cards, v.work.now, area, legend);

  bool active = false;
  v.hovered = false;
  if (shown) {
    ImGui::SetCursorScreenPos(area.lo);
    ImGui::InvisibleButton("##view", {std::max(1.0f, area.width()), std::max(1.0f, area.height())},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    v.hovered = ImGui::IsItemHovered();
    active = ImGui::IsItemActive();
    if (drag_wipe(v.controls.actions, v.work, v.compare, frame, active)) {
      v.controls.actions.wake(2);
      ImGui::End();
      return;
    }
    if (ImGui::IsItemActivated()) begin_drag(v, frame);
    if (hot && v.hovered && !active) tooltip(help_of(v, *hot));
    if (hot_part && v.hovered && !active) tooltip(help_of(v.scene_view.gizmo, *hot_part));
    if ((v.click_taken() || hot || hot_part) && v.hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    const bool inspected = inspect_while_held(v, frame, active);
    // A click on the middle means what is under it; the other handles take theirs.
    const bool kept = v.drag.object && v.drag.object->part != GizmoPart::middle;
    if (!inspected && !kept && v.hovered && ImGui::IsMouseReleased(0) && ImGui::IsItemDeactivated() &&
        ImGui::GetIO().MouseDragMaxDistanceSqr[0] < px(k_drag) * px(k_drag))
      click(v, frame);
  }
  if (shown && paths_marks) draw_paths_marks(v.work, frame);
  if (shown && (drag_noise_area(v.controls.actions, v.paths, frame, active) ||
                drag_region(v.controls.actions, v.region, frame, active))) {
    v.controls.actions.wake(2);
    ImGui::End();
    return;
  }
  inspect_at_rest(v, frame, active);
  navigate(v, keys, frame, active);
  follow_object_drag(v, active);
  ImGui::End();
}

}  // namespace lucerna::ui
