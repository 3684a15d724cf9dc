#include "material_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/color.h"
#include "commands/material_words.h"
#include "light_rows.h"
#include "list_rows.h"
#include "scene/display_name.h"
#include "scene/range.h"
#include "swatch_popup.h"
#include "widgets.h"

namespace lucerna::ui {
namespace {

using commands::Kind;
using commands::named;
using commands::Selection;
using scene::display_name;

constexpr const char* k_times_texture = "\xC3\x97 texture";

/// Rows of one material.
class MaterialRows {
 public:
  MaterialRows(Controls& controls, uint32_t index)
      : controls_(controls), index_(index), m_(controls.open.material(index)) {}

  void draw() {
    catcher();
    if (m_.shadow_catcher) return;
    colours();
    emission();
    if (!m_.unlit) layers(), transmission(), coverage();
    if (m_.unlit) value_row("Unlit", "yes", "Shown with its base colour; neither lit nor a light.");
  }

 private:
  template <class... A>
  void set(const A&... words) {
    controls_.act("material.set", index_ + 1, words...);
  }
  static std::string with(const std::string& label, const scene::TextureUse& use) {
    return use ? label + " " + k_times_texture : label;
  }
  void number(const char* key, const std::string& label, float value, const char* help,
              const Slider& how = {.decimals = 3}) {
    if (slider((std::string("##") + key).c_str(), label, value, how)) set(named(key, value));
    tooltip(help);
  }
  void toggle(const char* key, const char* label, bool on, const char* help) {
    if (button((std::string("##") + key).c_str(), label, on, ImGui::CalcItemWidth())) set(named(key, !on));
    tooltip(help);
  }
  void color(const char* key, const char* label, vec3 value, const scene::TextureUse& use, const char* help) {
    if (colour_field((std::string("##") + key).c_str(), label, value, use ? k_times_texture : ""))
      set(named(key, value));
    tooltip(help);
  }

  void colours() {
    color("color", "Base colour", vec3(m_.base_color), m_.base_color_texture,
          "Reflectance, linear. Press to choose a colour.");
    number("roughness", with("Roughness", m_.metallic_roughness_texture), m_.roughness,
           "Perceptual roughness: 0 is a mirror, 1 is matt.");
    number("metallic", with("Metalness", m_.metallic_roughness_texture), m_.metallic,
           "0 is a dielectric such as paint, stone or wood; 1 is metal.");
    if (m_.normal_texture)
      number("normal_scale", "Relief", m_.normal_scale, "Strength of the normal texture.",
             {.lo = 0, .hi = 2, .decimals = 2, .typed_lo = -100, .typed_hi = 100});
    if (m_.height_texture) relief();
    if (m_.metallic >= 1 || m_.unlit) return;
    number("diffuse_roughness", with("Diffuse roughness", m_.diffuse_roughness_texture), m_.diffuse_roughness,
           "0 is smooth plaster and paint; 1 is flat and dusty, as sandstone, clay and the moon.");
    number("specular", with("Reflection", m_.specular_texture), m_.specular,
           "Strength of a dielectric's reflection; 1 is physical.");
    if (m_.specular > 0)
      color("specular_color", "Reflection colour", glm::min(m_.specular_color, vec3(1)),
            m_.specular_color_texture, "Colour of the reflection seen from the front; white is physical.");
    number("ior", "Index of refraction", m_.ior, "Air 1, water 1.33, most paints and glass 1.5, diamond 2.4.",
           {.lo = 1, .hi = 2.5f, .decimals = 3, .typed_hi = 100});
  }

  void catcher() {
    toggle("shadow_catcher", "Shadow catcher", m_.shadow_catcher,
           "The surface looks like the sky's picture behind it, with the shadows and reflections of objects "
           "on it: the ground of a photograph. It blocks no light.");
  }

  // By the height texture.
  void relief() {
    number("height", "Height", m_.height,
           "Height of the relief where the texture is white over where it is black; below 0 it is turned "
           "inside out.",
           {.lo = 0,
            .hi = 0.05f,
            .decimals = 4,
            .unit = "m",
            .typed_lo = -scene::k_max_height,
            .typed_hi = scene::k_max_height});
    toggle(
        "deep_relief", "Hides and shadows itself", m_.deep_relief,
        "Deep relief: rays are followed into it, white lying on the surface. If not, the relief only turns "
        "the shading normal, which costs less.");
  }

  void emission() {
    if (m_.unlit) return;
    const vec3 light = controls_.open.emission(index_);
    if (strength_of(light) > 0) {
      emission_slider(controls_, index_);
      emission_unit(controls_, index_);
      colour_rows(controls_.actions, "material.set", index_ + 1, "emission_color", tint_of(light),
                  m_.emission_texture ? k_times_texture : "");
      toggle("two_sided", "Emits on both sides", m_.double_sided, "The back side emits like the front side.");
      if (button("##dark", "Remove emission", false, ImGui::CalcItemWidth())) set(named("strength", 0));
      tooltip("Makes the surface non-emissive. Can be undone.");
    } else {
      if (button("##glow", "Add emission", false, ImGui::CalcItemWidth())) set(named("strength", 1));
      tooltip("Makes the surface a light of radiance 1; edit it here or under Lights.");
    }
  }

  // Coat, sheen, brushing and thin film: a row each for its strength, and the others once it is there.
  void layers() {
    number("clearcoat", with("Clear coat", m_.clearcoat_texture), m_.clearcoat,
           "Strength of a coat of varnish over the material.");
    if (m_.clearcoat > 0)
      number("clearcoat_roughness", with("Coat roughness", m_.clearcoat_roughness_texture),
             m_.clearcoat_roughness, "0 is a glossy coat, 1 is matt.");
    if (m_.clearcoat > 0 && m_.clearcoat_normal_texture)
      number("clearcoat_normal_scale", "Coat relief", m_.clearcoat_normal_scale,
             "Strength of the coat's normal texture.",
             {.lo = 0, .hi = 2, .decimals = 2, .typed_lo = -100, .typed_hi = 100});
    color("sheen", "Sheen", m_.sheen_color, m_.sheen_color_texture,
          "Reflectance of fibres that stand up, as of velvet; black is none. Press to choose a colour.");
    if (m_.sheen_color != vec3(0))
      number("sheen_roughness", with("Sheen roughness", m_.sheen_roughness_texture), m_.sheen_roughness,
             "0 shines at the rim alone, 1 all over.");
    number("anisotropy", with("Brushed", m_.anisotropy_texture), m_.anisotropy,
           "Stretches reflections along a direction of the surface, as on brushed metal.");
    if (m_.anisotropy > 0)
      number("anisotropy_rotation", "Brushing direction",
             glm::degrees(std::remainder(m_.anisotropy_rotation, 2 * k_pi)), "Rotates that direction.",
             {.lo = -180, .hi = 180, .decimals = 1, .unit = "\xC2\xB0"});
    number("iridescence", with("Thin film", m_.iridescence_texture), m_.iridescence,
           "Colours of interference, as on soap bubbles and tempered steel.");
    if (m_.iridescence <= 0) return;
    const Slider film{.lo = 0, .hi = 1500, .decimals = 0, .unit = "nm"};
    number("film_thickness", with("Film thickness", m_.iridescence_thickness_texture), m_.iridescence_maximum,
           "Thickness of the film; it decides the colours.", film);
    if (m_.iridescence_thickness_texture)
      number("film_thickness_min", "Least thickness", m_.iridescence_minimum, "Where the texture is 0.",
             film);
    number("film_ior", "Film's index", m_.iridescence_ior, "Index of refraction of the film.",
           {.lo = 1, .hi = 2.5f, .decimals = 2, .typed_hi = 100});
  }

  void transmission() {
    number("diffuse_transmission", with("Translucence", m_.diffuse_transmission_texture),
           m_.diffuse_transmission,
           "Share of light that is transmitted diffusely, as by leaves and lampshades.");
    if (m_.diffuse_transmission > 0)
      color("diffuse_transmission_color", "Translucent colour", m_.diffuse_transmission_color,
            m_.diffuse_transmission_color_texture, "Colour of that light.");
    number("transmission", with("Transmission", m_.transmission_texture), m_.transmission,
           "Share of light that is transmitted, as by glass and water.");
    if (m_.transmission <= 0) return;
    static constexpr ChoiceButton k_bodies[] = {
        {"pane", "Thin wall", "Light passes without refraction: window panes, bubbles."},
        {"solid", "Solid",
         "Light is refracted at the surface and absorbed inside. The surface must be closed."}};
    const bool solid = m_.thickness > 0;
    if (const ChoiceButton* pressed = choice_buttons("body", k_bodies, solid ? 1 : 0))
      set(named("thickness", pressed == &k_bodies[1] ? 1 : 0));
    if (!solid) return;
    const bool absorbs = std::isfinite(m_.attenuation_distance);
    number("absorb_distance", "Absorbs within", absorbs ? m_.attenuation_distance : 0,
           "Distance over which white light takes the colour below; 0: nothing is absorbed.",
           {.lo = 0, .hi = 1, .decimals = 3, .unit = "m", .typed_hi = 1e6f, .at_zero = "none"});
    if (absorbs)
      color("absorb_color", "Colour inside", m_.attenuation_color, {},
            "Colour of white light after that distance.");
    number(
        "dispersion", "Dispersion", m_.dispersion,
        "How much the refraction depends on the colour: 20 over the Abbe number. Crown glass .34, flint .6, "
        "diamond .36.",
        {.lo = 0, .hi = 2, .decimals = 2, .typed_hi = scene::k_max_dispersion});
  }

  void coverage() {
    static const std::vector<std::string> words{"opaque", "mask", "blend"};
    auto mode = int(m_.alpha_mode);
    if (choice("##alpha", "Coverage", {"full", "cut out", "blended"}, mode, 0,
               {"Alpha has no meaning.", "The surface is there where alpha reaches a limit.",
                "Alpha is the share of the surface that is there."}))
      set(named("alpha", words[size_t(mode)]));
    tooltip("What the alpha of the base colour and its texture means.");
    if (m_.alpha_mode == scene::AlphaMode::opaque) return;
    number("coverage", with("Alpha", m_.base_color_texture), m_.base_color.w,
           "Factor of the texture's alpha.");
    if (m_.alpha_mode == scene::AlphaMode::mask)
      number("cutoff", "Cut below", m_.alpha_cutoff, "Where alpha is below it the surface is not there.");
  }

  Controls& controls_;
  uint32_t index_;
  const scene::Material m_;
};

/// Names of the texture slots, as k_texture_slots.
constexpr const char* k_slot_labels[] = {"Base colour",
                                         "Roughness and metalness",
                                         "Relief",
                                         "Emission",
                                         "Reflection",
                                         "Reflection colour",
                                         "Transmission",
                                         "Translucence",
                                         "Translucent colour",
                                         "Clear coat",
                                         "Coat roughness",
                                         "Coat relief",
                                         "Sheen",
                                         "Sheen roughness",
                                         "Brushing",
                                         "Thin film",
                                         "Film thickness",
                                         "Diffuse roughness",
                                         "Height"};
static_assert(std::size(k_slot_labels) == std::size(scene::k_texture_slots));

/// The file or the image that a slot shows.
std::string texture_name(const commands::OpenScene& open, const scene::TextureUse& use,
                         const scene::TextureSource& source) {
  if (source.kind == scene::TextureSource::Kind::file)
    return std::filesystem::path(source.file).filename().string();
  const std::vector<scene::Texture>& textures = open.scene->textures;
  const std::vector<scene::Image>& images = open.scene->images;
  if (use.texture >= textures.size() || textures[use.texture].image >= images.size()) return "image";
  return std::filesystem::path(images[textures[use.texture].image].name).filename().string();
}

void textures(Controls& controls, uint32_t index) {
  const scene::Material m = controls.open.material(index);
  const scene::TextureSources sources = controls.open.textures(index);
  const auto word = [](uint32_t slot) { return std::string(scene::k_texture_slots[slot].name) + "_texture"; };
  for (uint32_t s = 0; s < std::size(scene::k_texture_slots); ++s) {
    const scene::TextureUse& use = m.*scene::k_texture_slots[s].use;
    const scene::TextureSource& source = scene::source_of(sources, s);
    const bool own = source.kind == scene::TextureSource::Kind::own;
    if (!use && own) continue;
    ImGui::PushID(int(s));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const std::string name = use ? texture_name(controls.open, use, source) : "removed";
    if (list_row("##texture", false, name, k_slot_labels[s], 0, 28))
      controls.act("dialog.texture", index + 1, scene::k_texture_slots[s].name);
    tooltip(fmt::format("{}: {}. Press to choose another file (PNG or JPEG).", k_slot_labels[s], name));
    if (own ? row_sign(at, "##no_texture", Sign::close, false, "Removes the texture.")
            : row_sign(at, "##own_texture", Sign::close, false, "Restores the texture of the scene's file."))
      controls.act("material.set", index + 1, named(word(s), own ? "none" : "own"));
    ImGui::PopID();
  }
  if (button("##add_texture", "Add a texture", false, ImGui::CalcItemWidth())) ImGui::OpenPopup("##slots");
  tooltip("Chooses what an image file is for, then the file.");
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {px(8), px(6)});
  const bool open = ImGui::BeginPopup("##slots");
  ImGui::PopStyleVar();
  if (!open) return;
  for (uint32_t s = 0; s < std::size(scene::k_texture_slots); ++s)
    if (!(m.*scene::k_texture_slots[s].use) && ImGui::Selectable(k_slot_labels[s]))
      controls.act("dialog.texture", index + 1, scene::k_texture_slots[s].name);
  ImGui::EndPopup();
}

/// Copy, paste and swatches.
void copies(Controls& controls, SceneView& view, uint32_t index) {
  const float third = (ImGui::CalcItemWidth() - px(8)) / 3;
  if (button("##copy", "Copy", view.copied_material == index, third)) view.copied_material = index;
  tooltip("Takes this material, with its textures, for Paste on another one.");
  ImGui::SameLine(0, px(4));
  const bool can = view.copied_material && *view.copied_material != index &&
                   *view.copied_material < controls.open.scene->materials.size();
  ImGui::BeginDisabled(!can);
  if (button("##paste", "Paste", false, third))
    controls.act("material.set", index + 1, named("like", *view.copied_material + 1));
  tooltip(can ? fmt::format("Makes it like '{}', with its textures.",
                            display_name(controls.open.scene->materials[*view.copied_material].name,
                                         "Material", *view.copied_material))
              : "Copy another material first.");
  ImGui::EndDisabled();
  ImGui::SameLine(0, px(4));
  if (button("##swatches", "Swatches", false, third)) ImGui::OpenPopup(k_swatches);
  tooltip("Materials to choose from, and to keep for other scenes.");
  swatch_popup(controls, view, index);
}

// The file's variants of the materials, and clay.
void material_sets(Controls& controls) {
  const std::vector<std::string>& variants = controls.open.scene->variants;
  if (!variants.empty()) {
    std::vector<std::string> names{"default"};
    names.insert(names.end(), variants.begin(), variants.end());
    const auto found = std::find(names.begin() + 1, names.end(), controls.open.setting("scene.variant"));
    int chosen = found == names.end() ? 0 : static_cast<int>(found - names.begin());
    if (choice("##variant", "Variant", names, chosen))
      controls.act("set", "scene.variant", chosen > 0 ? names[static_cast<size_t>(chosen)] : "");
    tooltip("Sets of materials that the scene's file offers. The picture starts again.");
  }
  option_control(controls, "scene.clay", "Clay");
}

}  // namespace

void draw_material_rows(Controls& controls, const Selection& selection, SceneView& view, bool reveal) {
  material_sets(controls);
  const auto& list = controls.open.scene->materials;
  for (size_t i = 0; i < list.size(); ++i) {
    const auto index = static_cast<uint32_t>(i);
    const scene::Material m = controls.open.material(index);
    const bool chosen = selection == Selection{Kind::material, index};
    if (chosen && reveal) show_row(ImGui::GetCursorScreenPos().y);
    ImGui::PushID(static_cast<int>(i));
    const bool emits = strength_of(m.emission) > 0;
    const char* note = emits                                                ? "emits"
                       : m.transmission > 0                                 ? "glass"
                       : m.metallic > 0.5f && !m.metallic_roughness_texture ? "metal"
                                                                            : "";
    if (list_row("##material", chosen, display_name(m.name, "Material", i), note,
                 display_colour(emits ? m.emission / strength_of(m.emission) : vec3(m.base_color)), 0))
      choose(controls.actions, view, chosen, "material", index);
    tooltip(fmt::format("{}. Press to select the material; F frames its objects.",
                        display_name(m.name, "Material", i)));
    if (chosen) {
      ImGui::Indent(px(18));
      ImGui::PushItemWidth(ImGui::CalcItemWidth() - px(18));
      copies(controls, view, index);
      MaterialRows(controls, index).draw();
      textures(controls, index);
      ImGui::PopItemWidth();
      ImGui::Unindent(px(18));
      gap(4);
    }
    ImGui::PopID();
  }
}

}  // namespace lucerna::ui
