// The undoable command that changes a material, and materials as its words.
#include <algorithm>
#include <cmath>

#include "base/color.h"
#include "base/error.h"
#include "base/file.h"
#include "commands/command_list.h"
#include "commands/light_words.h"
#include "commands/material_words.h"
#include "commands/open_scene.h"
#include "commands/text.h"
#include "scene/range.h"

namespace lucerna::commands {
namespace {

using scene::MaterialFactors;
using scene::TextureSource;

constexpr double k_most = double{scene::k_max_strength};
constexpr float k_usual_height = 0.01f;

struct NumberWord {
  const char* name;
  float MaterialFactors::*value;
  const char* help;
  double lo, hi;
  const char* unit = "";
};
constexpr NumberWord k_numbers[] = {
    {"roughness", &MaterialFactors::roughness, "", 0, 1},
    {"metallic", &MaterialFactors::metallic, "", 0, 1},
    {"ior", &MaterialFactors::ior, "index of refraction", 1, 100},
    {"specular", &MaterialFactors::specular, "strength of a dielectric's reflection", 0, 1},
    {"transmission", &MaterialFactors::transmission, "share of light that is transmitted, as by glass", 0, 1},
    {"thickness", &MaterialFactors::thickness, "above 0: a solid that refracts and absorbs; 0: a thin wall",
     0, 1e6, "m"},
    {"diffuse_transmission", &MaterialFactors::diffuse_transmission,
     "share of light that is transmitted diffusely, as by leaves and lampshades", 0, 1},
    {"diffuse_roughness", &MaterialFactors::diffuse_roughness,
     "of the diffuse reflection; 1: as dusty as sandstone or clay", 0, 1},
    {"height", &MaterialFactors::height,
     "of relief by the height texture, from black to white; below 0: black is high (not with deep_relief)",
     -double{scene::k_max_height}, double{scene::k_max_height}, "m"},
    {"cutoff", &MaterialFactors::alpha_cutoff, "coverage below it is none, with alpha=mask", 0, 1},
    {"normal_scale", &MaterialFactors::normal_scale, "strength of the normal map", -1000, 1000},
    {"clearcoat", &MaterialFactors::clearcoat, "strength of a coat of varnish", 0, 1},
    {"clearcoat_roughness", &MaterialFactors::clearcoat_roughness, "", 0, 1},
    {"clearcoat_normal_scale", &MaterialFactors::clearcoat_normal_scale, "strength of the coat's normal map",
     -1000, 1000},
    {"sheen_roughness", &MaterialFactors::sheen_roughness, "", 0, 1},
    {"anisotropy", &MaterialFactors::anisotropy, "0: reflects equally in all directions, 1: most brushed", 0,
     1},
    {"dispersion", &MaterialFactors::dispersion, "of solid glass: 20 / Abbe number", 0,
     double{scene::k_max_dispersion}},
    {"iridescence", &MaterialFactors::iridescence, "strength of a thin film", 0, 1},
    {"film_ior", &MaterialFactors::iridescence_ior, "index of refraction of that film", 1, 100},
    {"film_thickness", &MaterialFactors::iridescence_maximum, "of that film; with a texture where it is 1", 0,
     1e5, "nm"},
    {"film_thickness_min", &MaterialFactors::iridescence_minimum, "where a texture of the thickness is 0", 0,
     1e5, "nm"},
};

struct ColourWord {
  const char* name;
  vec3 MaterialFactors::*value;
  const char* help;
  double hi;
};
constexpr ColourWord k_colours[] = {
    {"specular_color", &MaterialFactors::specular_color, "linear; colour of a dielectric's reflection",
     k_most},
    {"absorb_color", &MaterialFactors::attenuation_color,
     "linear; colour that white light has after absorb_distance in a solid", 1},
    {"diffuse_transmission_color", &MaterialFactors::diffuse_transmission_color, "linear", 1},
    {"sheen", &MaterialFactors::sheen_color, "linear; reflectance of fibres, as of velvet", 1},
    {"emission", &MaterialFactors::emission, "linear; emitted radiance", 1e9},
};

const std::vector<std::string> k_alpha{"opaque", "mask", "blend"};
const std::vector<std::string> k_no_files{"own", "none"};

std::string texture_word(const scene::TextureSlot& slot) { return std::string(slot.name) + "_texture"; }

std::vector<Parameter> material_parameters(const OpenScene& open) {
  const auto names = [&open](const std::vector<std::string>&) {
    return open.scene ? given_names(open.scene->materials) : std::vector<std::string>();
  };
  const auto colour = [](const char* name, const char* help, double hi) {
    return Parameter{.name = name, .type = Type::vector, .help = help, .lo = 0, .hi = hi, .optional = true};
  };
  const auto flag = [](const char* name, const char* help) {
    return Parameter{.name = name, .type = Type::boolean, .help = help, .optional = true};
  };
  const auto real = [](const char* name, const char* help, double lo, double hi, const char* unit) {
    return Parameter{
        .name = name, .type = Type::real, .help = help, .lo = lo, .hi = hi, .unit = unit, .optional = true};
  };
  std::vector<Parameter> list{
      {.name = "material", .help = "its name, or its number from 1", .which = true, .names = names},
      {.name = "like",
       .help = "first takes all values and textures of this material; plain: of a matt, light grey one "
               "without textures",
       .optional = true,
       .names = names},
      colour("color", "linear; reflectance", 1),
      real("coverage", "share of the surface that is there, with alpha=mask or blend", 0, 1, ""),
      {.name = "alpha",
       .type = Type::choice,
       .help = "what coverage means: nothing, a cut at `cutoff`, a share",
       .choices = k_alpha,
       .optional = true}};
  for (const NumberWord& w : k_numbers) list.push_back(real(w.name, w.help, w.lo, w.hi, w.unit));
  list.push_back(real("anisotropy_rotation", "of the brushing", -360, 360, "degrees"));
  list.push_back(real("absorb_distance", "in a solid; 0: it absorbs nothing", 0, 1e9, "m"));
  for (const ColourWord& w : k_colours) list.push_back(colour(w.name, w.help, w.hi));
  list.push_back(colour("emission_color", "linear; its strongest channel is scaled to 1", 1e9));
  list.push_back(kelvin());
  list.push_back(
      real("strength", "emitted radiance of the strongest channel, before the colour", 0, 1e9, "cd/m2"));
  list.push_back(flag("on", "turns emission on or off"));
  list.push_back(flag("two_sided", "the back emits too"));
  list.push_back(flag("shadow_catcher", "shows what is behind it, and the shadows of objects on it"));
  list.push_back(flag("deep_relief", "relief by the height texture hides and shadows itself"));
  using scene::LightUnit;
  for (Parameter& p : strength_parameters({LightUnit::lumen, LightUnit::watt, LightUnit::nit}))
    list.push_back(std::move(p));
  for (const scene::TextureSlot& slot : scene::k_texture_slots)
    list.push_back({.name = texture_word(slot),
                    .type = Type::file,
                    .help = "PNG or JPEG; none: removed; own: as the scene has it",
                    .choices = {".png", ".jpg", ".jpeg"},
                    .words = k_no_files,
                    .optional = true});
  return list;
}

Document::Material plain_material() {
  Document::Material m;
  m.base_color = vec4(0.8f, 0.8f, 0.8f, 1), m.metallic = 0;
  return m;
}

/// Textures of one material for another one.
scene::TextureSources textures_like(const OpenScene& open, uint32_t to, uint32_t from) {
  scene::TextureSources result;
  const scene::TextureSources sources = open.textures(from);
  const std::vector<scene::Material>& loaded = open.loaded->materials;
  for (uint32_t s = 0; s < std::size(scene::k_texture_slots); ++s) {
    using Kind = TextureSource::Kind;
    TextureSource source = scene::source_of(sources, s);
    if (source.kind == Kind::own) source = {Kind::material, "", from};
    const auto use = scene::k_texture_slots[s].use;
    if (source.kind == Kind::material && !(loaded.at(source.material).*use)) source = {.kind = Kind::none};
    if (source.kind == Kind::none && !(loaded.at(to).*use)) source = {};
    if (source.kind == Kind::material && source.material == to) source = {};
    if (source.kind != Kind::own) result[s] = source;
  }
  return result;
}

void take_like(OpenScene& open, const std::string& like, uint32_t index, Document::Material& m) {
  if (like != "plain") {
    const uint32_t from = open.material_index(like);
    m = open.edit().materials[from];
    m.textures = textures_like(open, index, from);
    return;
  }
  m = plain_material();
  for (uint32_t s = 0; s < std::size(scene::k_texture_slots); ++s)
    if (open.loaded->materials.at(index).*scene::k_texture_slots[s].use)
      m.textures[s] = {.kind = TextureSource::Kind::none};
}

void take_textures(const OpenScene& open, const Arguments& a, uint32_t index, Document::Material& m) {
  for (uint32_t s = 0; s < std::size(scene::k_texture_slots); ++s) {
    const std::string word = texture_word(scene::k_texture_slots[s]);
    if (!a.has(word)) continue;
    const std::string& value = a.text(word);
    const bool has_own = bool(open.loaded->materials.at(index).*scene::k_texture_slots[s].use);
    if (value == "own" || (value == "none" && !has_own))
      m.textures.erase(s);
    else if (value == "none")
      m.textures[s] = {.kind = TextureSource::Kind::none};
    else
      m.textures[s] = {TextureSource::Kind::file, absolute_path(value).string()};
  }
}

void take_emission(const OpenScene& open, const Arguments& a, uint32_t index, Document::Material& m) {
  const vec3 tint = requested_tint(a, "emission_color", tint_of(m.emission));
  float strength = strength_in(a, tint, m.emission);
  take(a, "strength", strength);
  if (a.has("strength") || a.has("emission_color") || a.has("kelvin")) m.emission = strength * tint;
  if (const auto unit = given_unit(a, {}))
    m.emission = given_strength(a, *unit, open.emission_factor(index, *unit), m.emission);
  take(a, "on", m.emits);
}

void set_material(OpenScene& open, const Arguments& a) {
  const uint32_t index = open.material_index(a.text("material"));
  Document::Material& m = open.edit().materials[index];
  const bool unlit = m.unlit;
  if (a.has("like")) take_like(open, a.text("like"), index, m);
  m.unlit = unlit;
  vec3 color(m.base_color);
  take(a, "color", color);
  m.base_color = vec4(color, m.base_color.w);
  take(a, "coverage", m.base_color.w);
  if (a.has("alpha"))
    m.alpha_mode = static_cast<scene::AlphaMode>(std::find(k_alpha.begin(), k_alpha.end(), a.text("alpha")) -
                                                 k_alpha.begin());
  for (const NumberWord& w : k_numbers) take(a, w.name, m.*w.value);
  for (const ColourWord& w : k_colours) take(a, w.name, m.*w.value);
  if (a.has("anisotropy_rotation")) m.anisotropy_rotation = glm::radians(a.number("anisotropy_rotation"));
  if (a.has("absorb_distance"))
    m.attenuation_distance = a.number("absorb_distance") > 0 ? a.number("absorb_distance") : k_infinity;
  take(a, "two_sided", m.double_sided);
  take(a, "deep_relief", m.deep_relief);
  take(a, "shadow_catcher", m.shadow_catcher);
  if (m.deep_relief && m.height < 0) m.height = -m.height;
  take_emission(open, a, index, m);
  take_textures(open, a, index, m);
  // A height texture alone would show nothing.
  if (a.has("height_texture") && !a.has("height") && m.height == 0 && a.text("height_texture") != "none")
    m.height = k_usual_height;
}

}  // namespace

std::string material_words(const Document::Material& m) {
  const Document::Material plain = plain_material();
  std::string words;
  const auto put = [&](const std::string& name, const auto& value, const auto& usual) {
    if (value != usual) words += (words.empty() ? "" : " ") + name + "=" + word(value);
  };
  put("color", vec3(m.base_color), vec3(plain.base_color));
  put("coverage", m.base_color.w, 1.0f);
  put("alpha", k_alpha[size_t(m.alpha_mode)], k_alpha[0]);
  for (const NumberWord& w : k_numbers) put(w.name, m.*w.value, plain.*w.value);
  put("anisotropy_rotation", glm::degrees(m.anisotropy_rotation), 0.0f);
  if (std::isfinite(m.attenuation_distance)) put("absorb_distance", m.attenuation_distance, -1.0f);
  for (const ColourWord& w : k_colours) put(w.name, m.*w.value, plain.*w.value);
  put("two_sided", m.double_sided, false);
  put("deep_relief", m.deep_relief, false);
  put("shadow_catcher", m.shadow_catcher, false);
  put("on", m.emits, true);
  for (const auto& [slot, source] : m.textures)
    if (source.kind == TextureSource::Kind::file)
      put(texture_word(scene::k_texture_slots[slot]), source.file, std::string());
  return words;
}

void add_material_commands(Registry& registry, OpenScene& open) {
  registry.add(
      {.name = "material.set",
       .help =
           "Changes a material of the scene; its textures still multiply it. Omitted values stay unchanged.",
       .parameters = material_parameters(open),
       .check =
           [](const Arguments& a) {
             for (const char* part : {"emission_color", "kelvin", "strength"}) exclude(a, "emission", part);
             given_unit(a, {"emission", "strength"});
             exclude(a, "emission_color", "kelvin");
           },
       .run = [&open](const Arguments& a) { set_material(open, a); },
       .undoable = true});
}

}  // namespace lucerna::commands
