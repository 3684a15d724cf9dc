// The panel on the right: cameras and navigation, lights, environment, materials.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "state.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

/// A row that can be chosen: mark, name (elided), a dim note at the right end. Returns whether it was
/// pressed.
bool list_row(const char* id, bool chosen, const std::string& name, const std::string& note, ImU32 mark,
              float inset_right, float height = 24) {
  const float width = ImGui::CalcItemWidth();
  const ImVec2 lo = ImGui::GetCursorScreenPos(), hi(lo.x + width, lo.y + px(height));
  const bool pressed = ImGui::InvisibleButton(id, {std::max(1.0f, width - px(inset_right)), px(height)});
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (chosen || hovered)
    list->AddRectFilled({lo.x - px(4), lo.y}, {hi.x + px(4), hi.y},
                        chosen ? colour::field_active : colour::field, px(3));
  float x = lo.x;
  if (mark) {
    const float y = 0.5f * (lo.y + hi.y);
    list->AddRectFilled({x, y - px(5)}, {x + px(10), y + px(5)}, mark, px(2));
    list->AddRect({x, y - px(5)}, {x + px(10), y + px(5)}, colour::grey(80), px(2));
    x += px(18);
  }
  const float note_width = note.empty() ? 0 : text_width(note) + px(8);
  const float right = hi.x - px(inset_right);
  draw_text(list, {x, lo.y}, {right, hi.y}, elided(name, std::max(0.0f, right - note_width - x)),
            chosen || hovered ? colour::text : colour::text);
  if (!note.empty()) draw_text(list, {x, lo.y}, {right, hi.y}, note, colour::text_faint, Align::right);
  return pressed;
}

ImU32 display_colour(const vec3& linear) {
  const auto encode = [](float v) {
    v = std::clamp(v, 0.0f, 1.0f);
    v = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
    return static_cast<int>(v * 255 + 0.5f);
  };
  return IM_COL32(encode(linear.x), encode(linear.y), encode(linear.z), 255);
}

float brightest(const vec3& c) { return std::max({c.x, c.y, c.z}); }
std::string name_or(const std::string& name, const char* kind, size_t index) {
  return name.empty() ? fmt::format("{} {}", kind, index + 1) : name;
}
/// What a press on a row does: selects, or takes the selection away.
void choose(Ui& ui, bool chosen, const char* kind, size_t index) {
  if (chosen)
    ui.act("select.none");
  else
    ui.act("select", kind, index + 1);
}
void quiet_line(const std::string& text) { label(text, colour::text_faint); }

/// Scrolls so that the row at `y` (window pixels) is in view.
void show_row(float y) {
  const ImVec2 window = ImGui::GetWindowPos();
  if (y < window.y || y + px(24) > window.y + ImGui::GetWindowHeight())
    ImGui::SetScrollFromPosY(y - window.y, 0.5f);
}

void cameras(Ui& ui) {
  const auto& list = ui.scene->cameras;
  if (list.empty()) quiet_line("The scene has no camera");
  for (size_t i = 0; i < list.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (list_row("##camera", ui.scene_camera == static_cast<int>(i), name_or(list[i].name, "Camera", i),
                 i < 9 ? fmt::format("{}", i + 1) : "", 0, 0))
      ui.act("camera.select", i + 1);
    tooltip(fmt::format("{}: {}.{}", name_or(list[i].name, "Camera", i),
                        list[i].orthographic ? "orthographic" : "perspective",
                        i < 9 ? fmt::format(" Key {}.", i + 1) : ""));
    ImGui::PopID();
  }
  if (!ui.view) return;
  gap(4);
  const Viewpoint& view = *ui.view;
  if (view.camera.orthographic) {
    float height = 2 * view.camera.ymag;
    if (slider("##height", "Height", height,
               {.lo = 0.01f, .hi = 1000, .log = true, .decimals = 2, .unit = "m"}))
      ui.act("camera.height", height);
    tooltip("Height of what an orthographic camera sees.");
  } else {
    // The command takes the angle: it means the same in a window of any shape.
    float lens = commands::focal_length_mm(view.camera.yfov, ui.aspect);
    if (slider("##lens", "Lens", lens, {.lo = 8, .hi = 200, .log = true, .decimals = 1, .unit = "mm"}))
      ui.act("camera.fov", commands::yfov_from_focal_length(lens, ui.aspect) * 180 / k_pi);
    tooltip(fmt::format(
        "Focal length for a frame 36 mm wide; now a field of view of {:.1f}\xC2\xB0 from top to bottom.",
        view.camera.yfov * 180 / k_pi));
  }
  float speed = ui.speed;
  if (slider("##speed", "Fly speed", speed,
             {.lo = 0.01f, .hi = 1000, .log = true, .decimals = 2, .unit = "m/s"}))
    ui.act("camera.speed", speed);
  tooltip(
      "Speed of flight with W A S D Q E while the pointer is over the picture; Shift flies four times "
      "faster.");
  const vec3 eye = commands::eye_of(view.camera);
  value_row("Eye",
            fmt::format("{} {} {} m", padded(real_text(eye.x, 2), 6), padded(real_text(eye.y, 2), 6),
                        padded(real_text(eye.z, 2), 6)),
            "Position of the camera: x, y (up), z in metres.");
}

void light_rows(Ui& ui, bool reveal) {
  const auto& lights = ui.scene->lights;
  size_t emitters = 0;
  for (const scene::Material& m : ui.scene->materials) emitters += brightest(m.emission) > 0;
  if (lights.empty())
    quiet_line(emitters == 0 ? "No lights"
                             : fmt::format("No lamps; {} material{} light", emitters,
                                           emitters == 1 ? " emits" : "s emit"));
  static const char* kinds[] = {"point", "spot", "sun"};
  for (size_t i = 0; i < lights.size(); ++i) {
    const auto index = static_cast<uint32_t>(i);
    const scene::Light light = ui.light(index);
    ImGui::PushID(static_cast<int>(i));
    const float strength = brightest(light.intensity);
    const vec3 tint = strength > 0 ? light.intensity / strength : vec3(1);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool chosen = ui.selection == Selection{Kind::light, index};
    if (chosen && reveal) show_row(at.y);
    if (list_row("##light", chosen, name_or(light.name, "Light", i), kinds[static_cast<size_t>(light.kind)],
                 colour::with_alpha(display_colour(tint), light.enabled ? 1.0f : 0.3f), 28))
      choose(ui, chosen, "light", index);
    tooltip("Selects the light; F then frames it.");
    const float below = ImGui::GetCursorScreenPos().y;
    ImGui::SetCursorScreenPos({at.x + ImGui::CalcItemWidth() - px(22), at.y + px(1)});
    if (sign_button("##on", Sign::power, light.enabled))
      ui.act("light.set", i + 1, named("on", !light.enabled));
    tooltip(light.enabled ? "Switches the light off." : "Switches the light on.");
    ImGui::SetCursorScreenPos({at.x, below});
    const bool sun = light.kind == scene::LightKind::directional;
    Slider how{.lo = 0, .hi = 1000, .decimals = 2, .unit = sun ? "W/m\xC2\xB2" : "W/sr", .bar = false};
    // Drags move by a share of the value; a light turned down to nothing starts from a thousandth.
    how.lo = 1e-3f, how.hi = 1e5f, how.log = true, how.travel = 0.25f;
    ImGui::BeginDisabled(!light.enabled);
    float shown = std::max(strength, how.lo);
    if (slider("##strength", sun ? "Irradiance" : "Intensity", shown, how))
      ui.act("light.set", i + 1, named("intensity", shown));
    ImGui::EndDisabled();
    tooltip(sun ? "Irradiance on a surface that faces the light, of its strongest channel."
                : "Radiant intensity of the strongest channel.");
    ImGui::PopID();
    gap(4);
  }
}

void environment(Ui& ui) {
  const scene::Environment& e = ui.scene->environment;
  const bool image = e.image != scene::k_none;
  const bool dark = !image && brightest(e.radiance) <= 0;
  value_row("Light",
            image  ? (e.file.empty() ? "image" : e.file)
            : dark ? "none"
                   : "even radiance",
            image ? "A latitude-longitude image around the scene." : "Radiance from every direction.");
  gap(4);
  ImGui::BeginDisabled(dark);
  float shown = std::max(ui.environment_scale(), 1e-3f);
  if (slider("##scale", "Strength", shown,
             {.lo = 1e-3f,
              .hi = 1000,
              .log = true,
              .decimals = 3,
              .unit = "\xC3\x97",
              .bar = false,
              .travel = 0.25f}))
    ui.act("environment.set", named("scale", shown));
  tooltip("Multiplies the radiance of the environment.");
  ImGui::BeginDisabled(!image);
  float turn = std::remainder(ui.environment_rotation(), 360.0f);
  if (slider("##rotation", "Rotation", turn, {.lo = -180, .hi = 180, .decimals = 1, .unit = "\xC2\xB0"}))
    ui.act("environment.set", named("rotation", turn));
  tooltip("Turns the image counter-clockwise, seen from above.");
  ImGui::EndDisabled();
  ImGui::EndDisabled();
}

void material_details(const scene::Material& m) {
  const auto colour_text = [](const vec3& c) { return fmt::format("{:.3f} {:.3f} {:.3f}", c.x, c.y, c.z); };
  const auto textured = [](const scene::TextureUse& use) { return use ? " \xC3\x97 texture" : ""; };
  value_row("Base colour", colour_text(vec3(m.base_color)) + textured(m.base_color_texture),
            "Linear reflectance.");
  value_row("Roughness", fmt::format("{:.3f}{}", m.roughness, textured(m.metallic_roughness_texture)),
            "Perceptual roughness, 0 to 1.");
  value_row("Metallic", fmt::format("{:.3f}{}", m.metallic, textured(m.metallic_roughness_texture)),
            "0 dielectric, 1 metal.");
  if (brightest(m.emission) > 0)
    value_row("Emission", colour_text(m.emission) + textured(m.emission_texture), "Emitted radiance.");
  if (m.transmission > 0)
    value_row("Transmission", fmt::format("{:.3f}{}", m.transmission, textured(m.transmission_texture)),
              "Share of light let through.");
  if (m.transmission > 0 || m.ior != 1.5f)
    value_row("Index of refraction", fmt::format("{:.3f}", m.ior),
              "0 means a mirror-like boundary (as KHR_materials_ior says).");
  if (m.thickness > 0) {
    value_row("Body", "solid", "Light refracts on entering and is absorbed inside.");
    if (std::isfinite(m.attenuation_distance))
      value_row("Absorbs to",
                fmt::format("{} in {:.3g} m", colour_text(m.attenuation_color), m.attenuation_distance),
                "Colour of white light after that distance.");
  } else if (m.transmission > 0) {
    value_row("Body", "thin wall", "No thickness: light passes without bending.");
  }
  if (m.diffuse_transmission > 0)
    value_row("Diffuse transmission", fmt::format("{:.3f}", m.diffuse_transmission),
              "Share of light scattered through.");
  if (m.alpha_mode != scene::AlphaMode::opaque)
    value_row(
        "Coverage",
        m.alpha_mode == scene::AlphaMode::mask ? fmt::format("cut at {:.2f}", m.alpha_cutoff) : "blended",
        "What alpha means.");
  if (m.normal_texture)
    value_row("Normal texture", fmt::format("\xC3\x97 {:.2f}", m.normal_scale),
              "Strength of the normal texture.");
  if (m.unlit) value_row("Unlit", "yes", "Shown as it is; lights nothing.");
  if (m.double_sided) value_row("Double-sided", "yes", "Its back side emits as its front does.");
}

void materials(Ui& ui, bool reveal) {
  const auto& list = ui.scene->materials;
  for (size_t i = 0; i < list.size(); ++i) {
    const auto index = static_cast<uint32_t>(i);
    const scene::Material& m = list[i];
    const bool chosen = ui.selection == Selection{Kind::material, index};
    if (chosen && reveal) show_row(ImGui::GetCursorScreenPos().y);
    ImGui::PushID(static_cast<int>(i));
    const bool emits = brightest(m.emission) > 0;
    const char* note = emits                                                ? "emits"
                       : m.transmission > 0                                 ? "glass"
                       : m.metallic > 0.5f && !m.metallic_roughness_texture ? "metal"
                                                                            : "";
    if (list_row("##material", chosen, name_or(m.name, "Material", i), note,
                 display_colour(emits ? m.emission / brightest(m.emission) : vec3(m.base_color)), 0))
      choose(ui, chosen, "material", index);
    tooltip(fmt::format("{}. Selects the material; F then frames what is made of it.",
                        name_or(m.name, "Material", i)));
    if (chosen) {
      ImGui::Indent(px(18));
      ImGui::PushItemWidth(ImGui::CalcItemWidth() - px(18));
      material_details(m);
      ImGui::PopItemWidth();
      ImGui::Unindent(px(18));
      gap(4);
    }
    ImGui::PopID();
  }
}

void objects(Ui& ui, bool reveal) {
  const auto& list = ui.scene->instances;
  if (reveal && ui.selection.kind == Kind::instance)
    show_row(ImGui::GetCursorScreenPos().y + px(24) * static_cast<float>(ui.selection.index));
  // Long lists draw only the rows in view.
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(list.size()), px(24));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const auto index = static_cast<uint32_t>(i);
      const scene::Instance& instance = list[index];
      const bool chosen = ui.selection.kind == Kind::instance && ui.selection.index == index;
      ImGui::PushID(i);
      if (list_row("##object", chosen, name_or(instance.name, "Object", index), "", 0, 0))
        choose(ui, chosen, "object", index);
      tooltip("Selects the object; F then frames it.");
      ImGui::PopID();
    }
}

}  // namespace

void draw_scene_panel(Ui& ui, const Area& area) {
  if (!ui.layout.right_open) return;
  begin_panel("##scene", area, colour::panel, true);
  if (!ui.scene) {
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
    if (panel_section(ui, title, fallback, count > 0 ? fmt::format("{}", count) : "")) {
      begin_padded();
      ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {px(8), px(2)});
      draw();
      ImGui::PopStyleVar();
      end_padded();
      gap(10);
    }
  };
  // What has been selected elsewhere, by a click in the picture say, is brought into view.
  const bool reveal = ui.reveals();
  if (reveal && ui.selection.kind == Kind::instance) ui.sections["Objects"] = true;
  if (reveal && ui.selection.kind == Kind::material) ui.sections["Materials"] = true;
  if (reveal && ui.selection.kind == Kind::light) ui.sections["Lights"] = true;
  block("Camera", ui.scene->cameras.size(), true, [&] { cameras(ui); });
  block("Lights", ui.scene->lights.size(), true, [&] { light_rows(ui, reveal); });
  block("Environment", 0, true, [&] { environment(ui); });
  block("Materials", ui.scene->materials.size(), true, [&] { materials(ui, reveal); });
  block("Objects", ui.scene->instances.size(), false, [&] { objects(ui, reveal); });
  hairline();
  ImGui::End();
}

}  // namespace lucerna::ui
