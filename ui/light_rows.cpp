#include "light_rows.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/blackbody.h"
#include "base/color.h"
#include "commands/light_edit.h"
#include "commands/light_words.h"
#include "emitters.h"
#include "scene/display_name.h"
#include "scene/lamp.h"
#include "scene/light_groups.h"
#include "scene/light_units.h"
#include "scene/range.h"
#include "state.h"
#include "sun_rows.h"

namespace lucerna::ui {

using commands::Kind;
using commands::named;
using commands::Selection;
using scene::display_name;

void colour_rows(Actions& actions, const char* command, size_t item, const char* color_name, const vec3& tint,
                 const std::string& note) {
  vec3 picked = tint;
  if (colour_field("##colour", "Colour", picked, note) && strength_of(picked) > 0)
    actions.act(command, item, named(color_name, tint_of(picked)));
  tooltip("Colour of the light, its strongest channel 1. Press to choose another.");
  const NearestKelvin nearest = nearest_kelvin(tint);
  float kelvin = nearest.kelvin;
  const bool near = nearest.off < 0.02f;
  if (slider("##kelvin", near ? "Temperature" : "Temperature, about", kelvin,
             {.lo = k_coolest_kelvin,
              .hi = k_hottest_kelvin,
              .log = true,
              .decimals = 0,
              .unit = "K",
              .bar = near,
              .step = 10,
              .travel = 0.5f}))
    actions.act(command, item, named("kelvin", kelvin));
  tooltip(
      near ? "Temperature of the black body of this colour. Candles 1900 K, bulbs 2700 K, daylight 6500 K."
           : "No black body has this colour; the nearest by blue over red. A drag takes the colour of that "
             "temperature.");
}

namespace {

using scene::LightUnit;

/// Drags scale the value; a light of strength 0 starts from the least.
Slider strength_slider(LightUnit unit, const char* symbol) {
  const bool watts = unit == LightUnit::watt;
  return {.lo = watts ? 1e-5f : 1e-3f,
          .hi = watts ? 1e5f : 1e7f,
          .log = true,
          .decimals = watts ? 3 : 2,
          .unit = symbol,
          .bar = false,
          .travel = 0.25f};
}

constexpr std::array<const char*, scene::k_light_units> k_unit_helps{
    "Luminous intensity in front of the lamp; of a measured distribution where it is strongest.",
    "Luminous flux: all light that leaves it.",
    "Illuminance of a small plane that faces the light, of a lamp at a distance in front of it.",
    "Radiant power: lumens over 683, as glTF exporters have it. An LED makes about 100 lm from a watt of "
    "electricity.",
    "Luminance of its surface.",
};

/// Chooses the unit among those of a light.
void unit_choice(Actions& actions, const std::vector<LightUnit>& units, LightUnit shown,
                 bool per_area = false) {
  std::vector<std::string> names, helps;
  int chosen = 0;
  for (const LightUnit unit : units) {
    if (unit == shown) chosen = int(names.size());
    names.push_back(per_area && unit == LightUnit::watt
                        ? "W/m\xC2\xB2, irradiance"
                        : fmt::format("{}, {}", info_of(unit).symbol, uncapitalised(info_of(unit).quantity)));
    helps.emplace_back(k_unit_helps[size_t(unit)]);
  }
  if (choice("##unit", "Unit", names, chosen, 0, helps))
    actions.act("light.unit", info_of(units[size_t(chosen)]).word);
  tooltip("Unit in which the strengths of lights are shown. The light stays as it is.");
}

/// The units of a material's emission.
std::vector<LightUnit> surface_units(const commands::OpenScene& open, uint32_t index) {
  if (open.material(index).emission_texture || !(open.emitting_area(index) > 0)) return {LightUnit::nit};
  return {LightUnit::nit, LightUnit::lumen, LightUnit::watt};
}
/// The chosen unit if a material's emission has it, or else nits.
LightUnit surface_unit(const commands::OpenScene& open, uint32_t index) {
  const std::vector<LightUnit> units = surface_units(open, index);
  const auto at = std::find(units.begin(), units.end(), open.light_unit.unit);
  return at == units.end() ? LightUnit::nit : *at;
}

}  // namespace

void emission_slider(Controls& controls, uint32_t index) {
  const LightUnit unit = surface_unit(controls.open, index);
  const scene::LightUnitInfo& info = info_of(unit);
  const Slider how = strength_slider(unit, info.symbol);
  const double factor = controls.open.emission_factor(index, unit);
  float shown = std::max(float(factor * scene::exact_luminance(controls.open.emission(index))), how.lo);
  ImGui::BeginDisabled(!controls.open.emits(index));
  if (slider("##strength", info.quantity, shown, how))
    controls.act("material.set", index + 1, named(info.word, shown));
  ImGui::EndDisabled();
  tooltip(unit == LightUnit::nit
              ? "Luminance of the surface; its texture multiplies it."
              : fmt::format("Of all surfaces with this material. {}", k_unit_helps[size_t(unit)]));
}

void emission_unit(Controls& controls, uint32_t index) {
  unit_choice(controls.actions, surface_units(controls.open, index), surface_unit(controls.open, index));
}

namespace {

constexpr const char* k_menu = "##menu";  ///< of a row's right button

/// Roll of a selected lamp; `level`: what is level at 0.
void roll_row(Actions& actions, size_t i, const scene::Light& light, const char* level) {
  float roll = scene::roll_of(light.direction, light.right);
  if (slider("##roll", "Roll", roll,
             {.lo = -180, .hi = 180, .decimals = 1, .unit = "\xC2\xB0", .typed_lo = -360, .typed_hi = 360}))
    actions.act("light.set", i + 1, named("roll", roll));
  tooltip(fmt::format("Angle about the direction of its light; at 0 {} is level.", level));
}

/// Sizes of a selected lamp with a shape. Its power stays.
void shape_rows(Actions& actions, size_t i, const scene::Light& light) {
  using scene::LightKind;
  const auto size = [&](const char* id, const char* label, const char* parameter, float value,
                        const char* help) {
    if (slider(id, label, value,
               {.lo = 1e-3f,
                .hi = 100,
                .log = true,
                .decimals = 3,
                .unit = "m",
                .bar = false,
                .travel = 0.25f,
                .typed_lo = scene::k_least_lamp,
                .typed_hi = scene::k_max_lamp}))
      actions.act("light.set", i + 1, named(parameter, value));
    tooltip(help);
  };
  if (light.kind == LightKind::rectangle) {
    size("##width", "Width", "width", light.width, "Width of the lamp. Its power stays.");
    size("##height", "Height", "height", light.height, "Height of the lamp. Its power stays.");
  } else {
    if (light.kind == LightKind::tube)
      size("##length", "Length", "length", light.width, "Length of the lamp. Its power stays.");
    size("##radius", "Radius", "radius", light.radius, "Radius of the lamp. Its power stays.");
  }
  if (light.kind == LightKind::tube) {
    vec3 axis = light.right;
    if (slider_row("##axis", "Axis", axis, {.lo = -1, .hi = 1, .decimals = 3, .bar = false}) >= 0)
      actions.act("light.set", i + 1, named("right", axis));
    tooltip("Direction of the tube: x, y (up), z; any length above 0.");
  }
  if (light.kind == LightKind::rectangle) roll_row(actions, i, light, "the width");
  const float half = 0.5f * (ImGui::CalcItemWidth() - px(4));
  if (button("##visible", "Visible", light.visible, half))
    actions.act("light.set", i + 1, named("visible", !light.visible));
  tooltip("The camera sees the lamp itself. Mirrors show it in any case.");
  if (light.kind == LightKind::rectangle || light.kind == LightKind::disk) {
    ImGui::SameLine(0, px(4));
    if (button("##two_sided", "Two-sided", light.two_sided, half))
      actions.act("light.set", i + 1, named("two_sided", !light.two_sided));
    tooltip("Whether the lamp shines to its back too.");
  }
}

/// A button that opens the dialog for a file of the light: its "profile" or its "picture".
void file_button(Actions& actions, size_t i, const char* kind, const char* text) {
  if (button((std::string("##") + kind).c_str(), text, false, ImGui::CalcItemWidth()))
    actions.act("dialog.light_file", i + 1, kind);
  tooltip(std::string_view(kind) == "profile"
              ? "Chooses a measured distribution: IES LM-63 or EULUMDAT. The lamp keeps its power."
              : "Chooses an image that the spot projects.");
}

/// The distribution of a selected lamp: its web in two planes, and its numbers.
void profile_rows(Actions& actions, size_t i, const scene::Light& light) {
  const scene::LightProfile& p = *light.profile;
  value_row("Distribution", p.name.empty() ? "unnamed" : p.name,
            "File of the measured distribution (light.set profile=FILE).");
  file_button(actions, i, "profile", "Other distribution\xE2\x80\xA6");
  if (button("##no_profile", "Remove distribution", false, ImGui::CalcItemWidth()))
    actions.act("light.set", i + 1, named("profile", "none"));
  tooltip("Makes it a point lamp of the same power.");
  value_row("In the file", fmt::format("{:.0f} lm, {:.0f} cd", p.lumens(), p.peak),
            "Flux and largest intensity that the file states.");
  const float size = std::min(ImGui::CalcItemWidth(), px(150)), half = 0.5f * size;
  const ImVec2 lo = ImGui::GetCursorScreenPos(), centre(lo.x + half, lo.y + half);
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (const float share : {0.5f, 1.0f}) list->AddCircle(centre, share * 0.96f * half, colour::hairline, 48);
  for (const int plane : {1, 0}) {
    std::vector<ImVec2> points;
    for (int k = 0; k <= 180; ++k) {
      const float angle = float(k) * k_pi / 90, s = std::sin(angle), c = std::cos(angle);
      const float r = 0.96f * half * p.along(plane == 0 ? vec3(s, 0, -c) : vec3(0, s, -c));
      points.emplace_back(centre.x + r * s, centre.y + r * c);
    }
    list->AddPolyline(points.data(), int(points.size()), plane == 0 ? colour::accent : colour::text_dim, 0,
                      px(1.5f));
  }
  ImGui::Dummy({size, size});
  tooltip("Intensity by direction, down the lamp's axis: across its X axis (bright line) and its Y axis.");
  roll_row(actions, i, light, "its X axis");
}

/// Strength of a light, in the unit that is chosen if it has that one.
void strength_row(Controls& controls, size_t i, const scene::Light& light) {
  const auto [wished, distance] = controls.open.light_unit;
  const LightUnit unit = scene::shown_unit(light, wished, double{distance});
  const scene::LightUnitInfo& info = info_of(unit);
  const bool at_distance = unit == LightUnit::lux && light.kind != scene::LightKind::directional;
  const Slider how = strength_slider(unit, unit_symbol(light, unit));
  float shown = std::max(float(scene::strength_in(light, unit, double{distance}).value_or(0)), how.lo);
  ImGui::BeginDisabled(!light.enabled);
  if (slider("##strength",
             at_distance ? fmt::format("{} at {:.4g} m", info.quantity, distance) : info.quantity, shown,
             how)) {
    if (at_distance)
      controls.act("light.set", i + 1, named(info.word, shown), named("distance", distance));
    else
      controls.act("light.set", i + 1, named(info.word, shown));
  }
  ImGui::EndDisabled();
  tooltip(k_unit_helps[size_t(unit)]);
}

/// Unit of a selected light's strength, and the distance of its lux.
void unit_rows(Controls& controls, const scene::Light& light) {
  const auto [wished, distance] = controls.open.light_unit;
  std::vector<LightUnit> units;
  for (const scene::LightUnitInfo& info : scene::k_unit_table)
    if (scene::unit_factor(light, info.unit, double{distance})) units.push_back(info.unit);
  const LightUnit unit = scene::shown_unit(light, wished, double{distance});
  unit_choice(controls.actions, units, unit, light.kind == scene::LightKind::directional);
  if (wished != LightUnit::lux || light.kind == scene::LightKind::directional) return;
  float metres = distance;
  if (slider("##distance", "At a distance of", metres,
             {.lo = 0.01f,
              .hi = 100,
              .log = true,
              .decimals = 2,
              .unit = "m",
              .bar = false,
              .typed_lo = 1e-3f,
              .typed_hi = 1e4f}))
    controls.act("light.unit", info_of(wished).word, named("distance", metres));
  tooltip("From the middle of the lamp to the plane whose illuminance is shown.");
}

/// The picture of a selected spot, and its roll.
void picture_rows(Actions& actions, size_t i, const scene::Light& light) {
  const scene::LightPicture& p = *light.picture;
  value_row("Picture",
            fmt::format("{}, {} \xC3\x97 {}", p.name.empty() ? "unnamed" : p.name, p.width, p.height),
            "Image that the spot projects (light.set picture=FILE). Its corners are on the cone.");
  file_button(actions, i, "picture", "Other picture\xE2\x80\xA6");
  if (button("##no_picture", "Remove picture", false, ImGui::CalcItemWidth()))
    actions.act("light.set", i + 1, named("picture", "none"));
  tooltip("Makes it a plain spot.");
  roll_row(actions, i, light, "the picture");
}

/// Properties of a selected lamp besides its strength.
void light_details(Actions& actions, const Box& core, size_t i, const scene::Light& light) {
  colour_rows(actions, "light.set", i + 1, "color", tint_of(light.intensity));
  if (light.kind != scene::LightKind::directional) {
    vec3 position = light.position;
    if (position_row(core, position)) actions.act("light.set", i + 1, named("position", position));
    tooltip("Position of the lamp: x, y (up), z in metres.");
  }
  if (has_shape(light.kind)) shape_rows(actions, i, light);
  if (light.profile) profile_rows(actions, i, light);
  if (light.picture) picture_rows(actions, i, light);
  if (light.kind != scene::LightKind::point && light.kind != scene::LightKind::sphere &&
      light.kind != scene::LightKind::tube) {
    const commands::Bearing bearing = commands::bearing_of(light.direction);
    float azimuth = bearing.azimuth, elevation = bearing.elevation;
    if (slider("##azimuth", "Azimuth", azimuth,
               {.lo = 0, .hi = 360, .decimals = 1, .unit = "\xC2\xB0", .typed_lo = -360, .typed_hi = 360}))
      actions.act("light.set", i + 1, named("azimuth", azimuth));
    tooltip("Compass direction from which the light comes: 0 from \xE2\x88\x92Z, 90 from +X.");
    if (slider("##elevation", "Elevation", elevation,
               {.lo = -90, .hi = 90, .decimals = 1, .unit = "\xC2\xB0"}))
      actions.act("light.set", i + 1, named("elevation", elevation));
    tooltip("Angle above the horizon from which the light comes; 90 is vertical.");
  }
  if (light.kind == scene::LightKind::spot) {
    float cone = light.outer_cone * 180 / k_pi, inner = light.inner_cone * 180 / k_pi;
    const float widest = light.picture ? 80.0f : 90.0f;
    if (slider("##cone", "Cone", cone, {.lo = 0.5f, .hi = widest, .decimals = 1, .unit = "\xC2\xB0"}))
      actions.act("light.set", i + 1, named("cone", cone));
    tooltip("Angle from the axis at which the light ends.");
    if (!light.picture) {
      if (slider("##inner", "Inner cone", inner, {.lo = 0, .hi = 90, .decimals = 1, .unit = "\xC2\xB0"}))
        actions.act("light.set", i + 1, named("inner_cone", inner));
      tooltip("Angle from the axis at which the light begins to fade.");
    }
  }
  const bool spot = light.kind == scene::LightKind::spot;
  if (!light.profile && !light.picture && (spot || light.kind == scene::LightKind::point))
    file_button(actions, i, "profile", "Measured distribution\xE2\x80\xA6");
  if (!light.profile && !light.picture && spot)
    file_button(actions, i, "picture", "Project a picture\xE2\x80\xA6");
}

/// A row of the list of lights with its switch, and its properties if selected. Returns true if its switch
/// was pressed.
bool light_row(Actions& actions, SceneView& view, bool chosen, bool reveal, const std::string& name,
               const char* note, const vec3& tint, bool on, const char* kind, size_t index) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (chosen && reveal) show_row(at.y);
  if (list_row("##light", chosen, name, note, colour::with_alpha(display_colour(tint), on ? 1.0f : 0.3f), 28))
    choose(actions, view, chosen, kind, index);
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) ImGui::OpenPopup(k_menu);
  tooltip(fmt::format("{}. Press to select and edit it; F frames it.", name));
  return row_sign(at, "##on", Sign::power, on, on ? "Switches the light off." : "Switches the light on.");
}

/// Name and group of a selected light.
void light_label(Controls& controls, SceneView& view, size_t i, const scene::Light& light) {
  // Typed texts are applied when the field is left.
  if (view.named_light != light.id || !ImGui::IsAnyItemActive())
    view.named_light = light.id, view.light_name = light.name;
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth());
  ImGui::InputTextWithHint("##name", "Name", &view.light_name);
  if (ImGui::IsItemDeactivatedAfterEdit() && view.light_name != light.name)
    controls.act("light.rename", i + 1, view.light_name);
  tooltip("Name of the light. Press to change it.");
  std::vector<std::string> groups{"of its kind"};
  int chosen = 0;
  for (const scene::LightGroup& group : controls.open.light_groups().groups) {
    groups.push_back(group.name);
    if (group.name == light.group) chosen = int(groups.size()) - 1;
  }
  if (chosen == 0 && !light.group.empty()) groups.push_back(light.group), chosen = int(groups.size()) - 1;
  if (choice("##group", "Light group", groups, chosen)) {
    if (chosen == 0)
      controls.act("light.group", i + 1);
    else
      controls.act("light.group", i + 1, named("group", groups[size_t(chosen)]));
  }
  tooltip("Group of the light in the light mix. The command light.group makes new groups.");
}

/// Buttons below a selected light. `highlighting`: the next click places its highlight.
void list_buttons(Controls& controls, size_t i, const scene::Light& light, bool highlighting) {
  const bool sun = light.kind == scene::LightKind::directional, spot = commands::can_be_aimed(light);
  if (button("##highlight", "Place its highlight by a click", highlighting, ImGui::CalcItemWidth()))
    controls.act("light.highlighting", !highlighting);
  tooltip("The next click in the picture moves the light so that its reflection is there.");
  const float third = (ImGui::CalcItemWidth() - px(8)) / 3;
  if (button("##duplicate", "Duplicate", false, third)) controls.act("light.duplicate", i + 1);
  tooltip("Adds a copy beside it and selects it.");
  ImGui::SameLine(0, px(4));
  ImGui::BeginDisabled(sun);
  if (button("##here", spot ? "Aim here" : "Move here", false, third))
    controls.act(spot ? "light.aim_at" : "light.move", i + 1);
  ImGui::EndDisabled();
  tooltip(spot ? "Points the light at the surface in the middle of the picture."
               : "Moves the lamp to the surface in the middle of the picture, some distance off.");
  ImGui::SameLine(0, px(4));
  if (button("##delete", "Delete", false, third)) controls.act("light.delete", i + 1);
  tooltip("Removes the light. Ctrl+Z brings it back.");
}

/// The menu of the right button on a row.
void light_menu(Controls& controls, size_t i, const scene::Light& light) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(8), px(6)});
  if (ImGui::BeginPopup(k_menu)) {
    if (ImGui::Selectable("Duplicate")) controls.act("light.duplicate", i + 1);
    if (light.kind != scene::LightKind::directional && ImGui::Selectable("Move to the middle of the picture"))
      controls.act("light.move", i + 1);
    if (commands::can_be_aimed(light) && ImGui::Selectable("Aim at the middle of the picture"))
      controls.act("light.aim_at", i + 1);
    if (ImGui::Selectable("Delete")) controls.act("light.delete", i + 1);
    ImGui::EndPopup();
  }
  ImGui::PopStyleVar();
}

/// Buttons that add lights.
void add_buttons(Controls& controls) {
  const float third = (ImGui::CalcItemWidth() - px(8)) / 3;
  const auto add = [&](const char* id, const char* name, const char* kind, const char* help) {
    if (button(id, name, false, third)) controls.act("light.add", kind);
    tooltip(help);
  };
  add("##add_point", "+ Lamp", "point",
      "Adds a point lamp at the surface in the middle of the picture, some distance off.");
  ImGui::SameLine(0, px(4));
  add("##add_spot", "+ Spot", "spot", "Adds a spot that shines on the surface in the middle of the picture.");
  ImGui::SameLine(0, px(4));
  add("##add_sun", "+ Sun", "sun", "Adds a sun, 45 degrees above the horizon.");
  add("##add_rectangle", "+ Panel", "rectangle",
      "Adds a rectangle that shines on the surface in the middle of the picture.");
  ImGui::SameLine(0, px(4));
  add("##add_sphere", "+ Globe", "sphere",
      "Adds a shining sphere at the surface in the middle of the picture, some distance off.");
  ImGui::SameLine(0, px(4));
  if (button("##add_more", "More", false, third)) ImGui::OpenPopup("##more");
  tooltip("Adds a disk or a tube.");
  if (ImGui::BeginPopup("##more")) {
    if (ImGui::Selectable("Disk")) controls.act("light.add", "disk");
    if (ImGui::Selectable("Tube")) controls.act("light.add", "tube");
    ImGui::EndPopup();
  }
  gap(4);
}

}  // namespace

void draw_light_rows(Controls& controls, const commands::Navigation& camera, SceneView& view, bool reveal) {
  const std::vector<scene::Light> lights = controls.open.lights();
  const std::vector<uint32_t> glowing = emitters(controls.open, camera);
  add_buttons(controls);
  if (lights.empty() && glowing.empty()) quiet_line("No lights");
  for (size_t i = 0; i < lights.size(); ++i) {
    const auto index = static_cast<uint32_t>(i);
    const scene::Light& light = lights[i];
    ImGui::PushID(static_cast<int>(i));
    const bool chosen = camera.selection == Selection{Kind::light, index};
    if (light_row(controls.actions, view, chosen, reveal, display_name(light.name, "Light", i),
                  light.kind == scene::LightKind::directional ? "sun" : kind_name(light.kind),
                  tint_of(light.intensity), light.enabled, "light", i))
      controls.act("light.set", i + 1, named("on", !light.enabled));
    light_menu(controls, i, light);
    const bool sun = light.kind == scene::LightKind::directional;
    strength_row(controls, i, light);
    if (chosen) {
      unit_rows(controls, light);
      light_details(controls.actions, camera.core, i, light);
      if (sun) sun_details(controls, i, light);
      light_label(controls, view, i, light);
      list_buttons(controls, i, light, view.highlighting);
    }
    ImGui::PopID();
    gap(4);
  }
  // Emissive surfaces are lights too; in many interiors the only ones.
  for (const uint32_t index : glowing) {
    const scene::Material m = controls.open.material(index);
    ImGui::PushID(static_cast<int>(lights.size() + index));
    const bool chosen = camera.selection == Selection{Kind::material, index}, on = controls.open.emits(index);
    const vec3 tint = tint_of(controls.open.emission(index));
    if (light_row(controls.actions, view, chosen, false, display_name(m.name, "Material", index), "surface",
                  tint, on, "material", index))
      controls.act("material.set", index + 1, named("on", !on));
    emission_slider(controls, index);
    if (chosen) {
      emission_unit(controls, index);
      colour_rows(controls.actions, "material.set", index + 1, "emission_color", tint,
                  m.emission_texture ? "\xC3\x97 texture" : "");
    }
    ImGui::PopID();
    gap(4);
  }
}

}  // namespace lucerna::ui
