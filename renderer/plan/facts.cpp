#include "plan/facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>

#include "base/error.h"
#include "scene/display_name.h"
#include "scene/light_groups.h"
#include "shaders/shared/bsdf_table.h"

namespace lucerna::plan {
namespace {

using scene::AlphaMode, scene::Id, scene::LightKind, scene::Material, scene::Scene;
using List = std::vector<Evidence>;

/// A scene with what its rows ask for more than once.
struct Context {
  const Scene& scene;
  std::vector<uint8_t> used;    ///< by material: a surface has it
  std::vector<uint8_t> hidden;  ///< by mesh: all its instances are hidden
  explicit Context(const Scene& s) : scene(s), used(s.materials.size(), 0), hidden(s.meshes.size(), 0) {
    for (const scene::Instance& instance : s.instances)
      if (instance.hidden && instance.mesh < hidden.size()) hidden[instance.mesh] = 1;
    for (const scene::Instance& instance : s.instances)
      if (!instance.hidden && instance.mesh < hidden.size()) hidden[instance.mesh] = 0;
    for (const scene::Instance& instance : s.instances)
      for (const scene::Primitive& p : scene::shown_parts(s, instance)) used[p.material] = 1;
  }
  /// Materials of surfaces that meet the condition.
  List materials(const std::function<bool(const Material&)>& meets) const {
    List list;
    for (size_t i = 0; i < used.size(); ++i)
      if (used[i] && meets(scene.materials[i]))
        list.push_back(
            {Evidence::Kind::material, Id(i), scene::display_name(scene.materials[i].name, "Material", i)});
    return list;
  }
  List lamps(const std::function<bool(const scene::Light&)>& meets) const {
    List list;
    for (size_t i = 0; i < scene.lights.size(); ++i)
      if (const scene::Light& l = scene.lights[i]; l.enabled && l.intensity != vec3(0) && meets(l))
        list.push_back({Evidence::Kind::lamp, Id(i), scene::display_name(l.name, "Light", i)});
    return list;
  }
  List meshes(const std::function<bool(const scene::Primitive&)>& meets) const {
    List list;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
      const auto& parts = scene.meshes[i].primitives;
      if (!hidden[i] && std::any_of(parts.begin(), parts.end(), meets))
        list.push_back({Evidence::Kind::mesh, Id(i), scene::display_name(scene.meshes[i].name, "Mesh", i)});
    }
    return list;
  }
  List environment() const {
    const scene::Environment& e = scene.environment;
    const bool shines = e.scale > 0 && (e.image != scene::k_none || e.radiance != vec3(0));
    if (!shines) return {};
    return {{Evidence::Kind::environment, 0, e.file.empty() ? "uniform sky" : e.file}};
  }
  /// Everything that emits.
  List emitters() const {
    List list = lamps([](const scene::Light&) { return true; });
    for (List more : {environment(), materials(scene::is_light)})
      list.insert(list.end(), more.begin(), more.end());
    return list;
  }
  bool lit() const { return !emitters().empty(); }
};

bool has_transmission(const Material& m) { return m.transmission > 0 && !m.unlit; }
bool has_metal(const Material& m) { return m.metallic > 0 && !m.unlit; }
bool has_diffuse(const Material& m) {
  const bool body = m.metallic < 1 || m.metallic_roughness_texture;
  const bool solid = m.transmission < 1 || m.transmission_texture;
  return !m.unlit && vec3(m.base_color) != vec3(0) && body && solid;
}
/// The roughness of a texture is at most the factor.
bool is_rough(const Material& m) { return m.roughness * m.roughness >= shared::k_delta_alpha; }
/// Metal or glass smooth enough to focus light (transport/casters.h).
bool focuses(const Material& m) {
  constexpr float k_most_roughness = 0.5f;
  return (has_metal(m) || has_transmission(m)) &&
         (m.roughness <= k_most_roughness || m.metallic_roughness_texture);
}
bool has_emission(const Material& m) { return m.emission != vec3(0) && !m.unlit; }
void drop_emission(Material& m) { m.emission = vec3(0), m.emission_texture = {}; }
bool has_coat(const Material& m) {
  return !m.unlit && m.specular > 0 && m.ior != 1 && m.transmission < 1 &&
         (m.metallic < 1 || m.metallic_roughness_texture);
}
void drop_coat(Material& m) {
  if (m.transmission <= 0) m.specular = 0, m.specular_texture = {};
}
bool is_solid_glass(const Material& m) { return has_transmission(m) && m.thickness > 0; }
bool is_pane(const Material& m) { return has_transmission(m) && m.thickness <= 0; }
bool is_frosted(const Material& m) { return has_transmission(m) && is_rough(m); }
bool absorbs(const Material& m) {
  return has_transmission(m) && m.thickness > 0 && m.attenuation_distance < k_infinity &&
         m.attenuation_color != vec3(1);
}
void drop_absorption(Material& m) { m.attenuation_distance = k_infinity; }
bool is_dispersive(const Material& m) { return is_solid_glass(m) && m.dispersion > 0; }
void drop_dispersion(Material& m) { m.dispersion = 0; }
bool has_rough_diffuse(const Material& m) { return m.diffuse_roughness > 0 && has_diffuse(m); }
void drop_rough_diffuse(Material& m) { m.diffuse_roughness = 0, m.diffuse_roughness_texture = {}; }
bool has_shallow_relief(const Material& m) { return has_relief(m) && !m.deep_relief && !m.unlit; }
void drop_shallow_relief(Material& m) {
  if (!m.deep_relief) m.height = 0, m.height_texture = {};
}
bool has_deep_relief(const Material& m) { return has_relief(m) && m.deep_relief; }
void drop_deep_relief(Material& m) {
  m.deep_relief = false;  // its slopes remain
}
bool catches_shadows(const Material& m) { return m.shadow_catcher; }
void drop_catcher(Material& m) { m.shadow_catcher = false; }
bool is_translucent(const Material& m) { return m.diffuse_transmission > 0; }
void drop_translucency(Material& m) { m.diffuse_transmission = 0; }
bool has_clearcoat(const Material& m) { return m.clearcoat > 0 && !m.unlit; }
void drop_clearcoat(Material& m) {
  m.clearcoat = 0;
  m.clearcoat_texture = m.clearcoat_roughness_texture = m.clearcoat_normal_texture = {};
}
bool has_sheen(const Material& m) { return m.sheen_color != vec3(0) && !m.unlit; }
void drop_sheen(Material& m) {
  m.sheen_color = vec3(0);
  m.sheen_color_texture = m.sheen_roughness_texture = {};
}
bool is_brushed(const Material& m) { return m.anisotropy > 0 && !m.unlit; }
void drop_brushing(Material& m) { m.anisotropy = 0, m.anisotropy_texture = {}; }
bool has_film(const Material& m) { return m.iridescence > 0 && !m.unlit; }
void drop_film(Material& m) {
  m.iridescence = 0;
  m.iridescence_texture = m.iridescence_thickness_texture = {};
}
bool is_cut_out(const Material& m) { return m.alpha_mode == AlphaMode::mask; }
void drop_cut_outs(Material& m) {
  if (m.alpha_mode == AlphaMode::mask) m.alpha_mode = AlphaMode::opaque;
}
bool is_partial(const Material& m) { return m.alpha_mode == AlphaMode::blend; }
void drop_blending(Material& m) {
  if (m.alpha_mode == AlphaMode::blend) m.alpha_mode = AlphaMode::opaque;
}
bool is_unlit(const Material& m) { return m.unlit; }

/// A row of the table.
struct Row {
  const char *key, *label;
  EffectGroup group;
  const char* switches;
  const char* missing;
  List (*find)(const Context&);
  void (*remove)(Scene&) = nullptr;  ///< null: cannot be off
};

template <auto Meets>
List of_materials(const Context& c) {
  return c.materials(Meets);
}
template <auto Texture>
List of_texture(const Context& c) {
  return c.materials([](const Material& m) { return bool(m.*Texture); });
}
template <auto Texture>
void drop_texture(Scene& scene) {
  for (Material& m : scene.materials) m.*Texture = {};
}
template <LightKind Kind>
List of_lamps(const Context& c) {
  return c.lamps([](const scene::Light& l) { return l.kind == Kind; });
}
template <LightKind Kind>
void drop_lamps(Scene& scene) {
  for (scene::Light& l : scene.lights) l.enabled &= l.kind != Kind;
}
template <auto Change>
void of_each(Scene& scene) {
  for (Material& m : scene.materials) Change(m);
}

/// Light over diffuse surfaces.
List interreflection(const Context& c) { return c.lit() ? c.materials(has_diffuse) : List{}; }

List caustics(const Context& c) {
  return c.lit() && !c.materials(has_diffuse).empty() ? c.materials(focuses) : List{};
}

/// Lamps with a shape.
List shaped_lamps(const Context& c) {
  return c.lamps([](const scene::Light& l) { return has_shape(l.kind); });
}
void drop_shaped_lamps(Scene& scene) {
  for (scene::Light& l : scene.lights) l.enabled &= !has_shape(l.kind);
}

/// Light of lamps without size by way of smooth surfaces.
List point_caustics(const Context& c) {
  const bool lamps = !c.lamps([](const scene::Light& l) { return !has_shape(l.kind); }).empty();
  return lamps && !c.materials(has_diffuse).empty() ? c.materials(polished) : List{};
}

std::vector<Row> component_rows() {
  constexpr EffectGroup group = EffectGroup::components;
  return {
      {"primary", "Emitters and direct light", group, "components.primary", "no light",
       [](const Context& c) { return c.emitters(); }},
      {"secondary", "One diffuse interreflection", group, "components.secondary",
       "no light, or no diffuse surface", interreflection},
      {"tertiary", "Deeper interreflection", group, "components.tertiary", "no light, or no diffuse surface",
       interreflection},
      {"caustic", "Focused light", group, "components.caustic; casters at which light paths are aimed",
       "no polished metal or glass, no light, or no diffuse surface", caustics},
      {"point_caustic", "Focused light of lamps without size", group,
       "photons or light tracing: paths from the eye cannot find it",
       "no lamp without size, or no mirror-smooth surface", point_caustics},
  };
}

std::vector<Row> light_rows() {
  constexpr EffectGroup group = EffectGroup::lights;
  return {
      {"point", "Point lamps", group, "light table", "none is on", of_lamps<LightKind::point>,
       drop_lamps<LightKind::point>},
      {"spot", "Spot lamps", group, "light table", "none is on", of_lamps<LightKind::spot>,
       drop_lamps<LightKind::spot>},
      {"directional", "Distant lamps", group, "light table", "none is on", of_lamps<LightKind::directional>,
       drop_lamps<LightKind::directional>},
      {"profile", "Lamps with a measured distribution", group, "table of the distribution", "none is on",
       of_lamps<LightKind::profile>, drop_lamps<LightKind::profile>},
      {"shaped", "Lamps with a shape", group, "light table; rays may meet the lamps", "none is on",
       shaped_lamps, drop_shaped_lamps},
      {"projector", "Pictures that spots project", group, "tables of the pictures", "no spot has one",
       [](const Context& c) { return c.lamps([](const scene::Light& l) { return bool(l.picture); }); },
       [](Scene& s) {
         for (scene::Light& l : s.lights) l.picture.reset();
       }},
      {"emission", "Emitting surfaces", group, "triangles in the light table", "no surface emits",
       of_materials<has_emission>, of_each<drop_emission>},
      {"environment", "Sky", group, "environment map and its table", "none",
       [](const Context& c) { return c.environment(); }, [](Scene& s) { s.environment.scale = 0; }},
      {"sun", "Sun in the sky's picture", group, "separate selection by caches and light groups",
       "no texel is far above the mean",
       [](const Context& c) { return scene::has_sun(c.scene) ? c.environment() : List{}; }},
      {"portals", "Portals", group, "sampling of the sky through openings",
       "none is marked or found, or no sky",
       [](const Context& c) {
         List list;
         for (size_t i = 0; !c.environment().empty() && i < c.scene.portals.size(); ++i)
           list.push_back(
               {Evidence::Kind::portal, Id(i), scene::display_name(c.scene.portals[i].name, "Portal", i)});
         return list;
       },
       [](Scene& s) { s.portals.clear(); }},
  };
}

std::vector<Row> surface_rows() {
  constexpr EffectGroup group = EffectGroup::surfaces;
  return {
      {"diffuse", "Diffuse reflection", group, "diffuse lobe", "no surface has it",
       of_materials<has_diffuse>},
      {"metal", "Metals", group, "specular lobe", "no surface has it", of_materials<has_metal>},
      {"coat", "Reflection of dielectrics", group, "specular lobe", "no surface has it",
       of_materials<has_coat>, of_each<drop_coat>},
      {"solid_glass", "Solid glass and liquids", group, "refraction", "no surface has it",
       of_materials<is_solid_glass>},
      {"thin_glass", "Panes", group, "thin walls", "no surface has it", of_materials<is_pane>},
      {"rough_transmission", "Frosted glass", group, "rough refraction", "no surface has it",
       of_materials<is_frosted>},
      {"absorption", "Absorption in solids", group, "media of paths", "no solid absorbs",
       of_materials<absorbs>, of_each<drop_absorption>},
      {"dispersion", "Dispersion in solids", group, "wavelengths of paths", "no solid has it",
       of_materials<is_dispersive>, of_each<drop_dispersion>},
      {"diffuse_transmission", "Translucent sheets", group, "diffuse lobe to the other side",
       "no surface has it", of_materials<is_translucent>, of_each<drop_translucency>},
      {"diffuse_roughness", "Rough diffuse surfaces", group, "diffuse lobe that depends on the view",
       "no surface has it", of_materials<has_rough_diffuse>, of_each<drop_rough_diffuse>},
      {"bump", "Relief by height", group, "shading normals by slopes", "no surface has it",
       of_materials<has_shallow_relief>, of_each<drop_shallow_relief>},
      {"parallax", "Deep relief", group, "rays followed into the relief", "no surface has it",
       of_materials<has_deep_relief>, of_each<drop_deep_relief>},
      {"shadow_catcher", "Shadow catchers", group, "the background's colour on the surface",
       "no surface is one", of_materials<catches_shadows>, of_each<drop_catcher>},
      {"clearcoat", "Clear coats", group, "specular lobe over the material", "no surface has it",
       of_materials<has_clearcoat>, of_each<drop_clearcoat>},
      {"sheen", "Sheen of fibres", group, "lobe at grazing angles over the material", "no surface has it",
       of_materials<has_sheen>, of_each<drop_sheen>},
      {"anisotropy", "Brushed surfaces", group, "tangents and a specular lobe of two widths",
       "no surface has it", of_materials<is_brushed>, of_each<drop_brushing>},
      {"iridescence", "Thin films", group, "interference in the specular lobe", "no surface has it",
       of_materials<has_film>, of_each<drop_film>},
      {"alpha_mask", "Cut-outs", group, "tests of coverage along rays", "no surface has it",
       of_materials<is_cut_out>, of_each<drop_cut_outs>},
      {"alpha_blend", "Partial coverage", group, "random passage of rays", "no surface has it",
       of_materials<is_partial>, of_each<drop_blending>},
      {"unlit", "Unlit surfaces", group, "colour shown as light", "no surface has it",
       of_materials<is_unlit>},
      {"vertex_colors", "Vertex colours", group, "further vertex data", "no mesh has them",
       [](const Context& c) {
         return c.meshes([](const scene::Primitive& p) { return !p.colors.empty(); });
       }},
  };
}

std::vector<Row> texture_rows() {
  constexpr EffectGroup group = EffectGroup::textures;
  const char* none = "no surface has it";
  return {
      {"normal_map", "Normal maps", group, "tangents and shading normals", none,
       of_texture<&Material::normal_texture>, drop_texture<&Material::normal_texture>},
      {"base_texture", "Colour", group, "texture array", none, of_texture<&Material::base_color_texture>,
       drop_texture<&Material::base_color_texture>},
      {"roughness_texture", "Metal and roughness", group, "texture array", none,
       of_texture<&Material::metallic_roughness_texture>,
       drop_texture<&Material::metallic_roughness_texture>},
      {"emission_texture", "Emission", group, "texture array", none, of_texture<&Material::emission_texture>,
       drop_texture<&Material::emission_texture>},
      {"specular_texture", "Specular strength", group, "texture array", none,
       of_texture<&Material::specular_texture>, drop_texture<&Material::specular_texture>},
      {"specular_color_texture", "Specular colour", group, "texture array", none,
       of_texture<&Material::specular_color_texture>, drop_texture<&Material::specular_color_texture>},
      {"transmission_texture", "Transmission", group, "texture array", none,
       of_texture<&Material::transmission_texture>, drop_texture<&Material::transmission_texture>},
      {"diffuse_transmission_texture", "Diffuse transmission", group, "texture array", none,
       of_texture<&Material::diffuse_transmission_texture>,
       drop_texture<&Material::diffuse_transmission_texture>},
      {"diffuse_transmission_color_texture", "Colour of diffuse transmission", group, "texture array", none,
       of_texture<&Material::diffuse_transmission_color_texture>,
       drop_texture<&Material::diffuse_transmission_color_texture>},
      {"clearcoat_texture", "Clear coat", group, "texture array", none,
       of_texture<&Material::clearcoat_texture>, drop_texture<&Material::clearcoat_texture>},
      {"clearcoat_roughness_texture", "Roughness of clear coat", group, "texture array", none,
       of_texture<&Material::clearcoat_roughness_texture>,
       drop_texture<&Material::clearcoat_roughness_texture>},
      {"clearcoat_normal_map", "Normal maps of clear coat", group, "tangents and the coat's normals", none,
       of_texture<&Material::clearcoat_normal_texture>, drop_texture<&Material::clearcoat_normal_texture>},
      {"sheen_color_texture", "Colour of sheen", group, "texture array", none,
       of_texture<&Material::sheen_color_texture>, drop_texture<&Material::sheen_color_texture>},
      {"sheen_roughness_texture", "Roughness of sheen", group, "texture array", none,
       of_texture<&Material::sheen_roughness_texture>, drop_texture<&Material::sheen_roughness_texture>},
      {"anisotropy_texture", "Direction of brushing", group, "texture array", none,
       of_texture<&Material::anisotropy_texture>, drop_texture<&Material::anisotropy_texture>},
      {"iridescence_texture", "Thin film", group, "texture array", none,
       of_texture<&Material::iridescence_texture>, drop_texture<&Material::iridescence_texture>},
      {"iridescence_thickness_texture", "Thickness of film", group, "texture array", none,
       of_texture<&Material::iridescence_thickness_texture>,
       drop_texture<&Material::iridescence_thickness_texture>},
      {"diffuse_roughness_texture", "Diffuse roughness", group, "texture array", none,
       of_texture<&Material::diffuse_roughness_texture>, drop_texture<&Material::diffuse_roughness_texture>},
      {"height_texture", "Height", group, "texture array", none, of_texture<&Material::height_texture>,
       drop_texture<&Material::height_texture>},
  };
}

/// Evidence: cameras of which that holds.
template <bool (*holds)(const scene::Camera&)>
List of_cameras(const Context& c) {
  List list;
  for (size_t i = 0; i < c.scene.cameras.size(); ++i)
    if (holds(c.scene.cameras[i]))
      list.push_back(
          {Evidence::Kind::camera, Id(i), scene::display_name(c.scene.cameras[i].name, "Camera", i)});
  return list;
}
bool is_parallel(const scene::Camera& c) { return c.orthographic; }
bool has_lens(const scene::Camera& c) { return c.perspective() && c.lens.f_number > 0; }
bool is_wide(const scene::Camera& c) { return c.wide != scene::Wide::none; }
bool is_shifted(const scene::Camera& c) { return c.shift != vec2(0); }
bool is_cut(const scene::Camera& c) { return c.section.cuts(); }

std::vector<Row> camera_rows() {
  const auto group = EffectGroup::camera;
  const char* none = "no camera has it";
  return {{"orthographic", "Parallel projection", group, "rays of the camera", none, of_cameras<is_parallel>},
          {"wide", "Panorama or fisheye", group, "rays of the camera", none, of_cameras<is_wide>},
          {"depth_of_field", "Depth of field", group, "code for a lens in the camera's kernels", none,
           of_cameras<has_lens>},
          {"lens_shift", "Lens shift", group, "rays of the camera", none, of_cameras<is_shifted>},
          {"section", "Section plane", group, "code for a plane in the camera's kernels", none,
           of_cameras<is_cut>}};
}

const std::vector<Row>& table() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all;
    for (const auto& part : {component_rows(), light_rows(), surface_rows(), texture_rows(), camera_rows()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return rows;
}

const Row* find_row(std::string_view key) {
  const auto row = std::find_if(table().begin(), table().end(), [&](const Row& r) { return r.key == key; });
  return row == table().end() ? nullptr : &*row;
}

}  // namespace

std::string_view kind_name(Evidence::Kind kind) {
  constexpr std::array<const char*, 6> names{"material", "mesh", "lamp", "environment", "portal", "camera"};
  return names.at(size_t(kind));
}

std::string_view group_name(EffectGroup group) {
  constexpr std::array<const char*, 5> names{"Components", "Lights", "Surfaces", "Textures", "Camera"};
  return names.at(size_t(group));
}

bool polished(const Material& m) {
  const bool reflects = m.metallic > 0 || m.transmission > 0 || (m.specular > 0 && m.ior != 1);
  return !m.unlit && reflects && !is_rough(m);
}

const Effect& SceneFacts::effect(std::string_view key) const {
  for (const Effect& e : effects)
    if (e.key == key) return e;
  throw std::out_of_range(fmt::format("there is no effect '{}'", key));
}

SceneFacts facts_of(const Scene& scene) {
  const Context context(scene);
  SceneFacts facts;
  for (const Row& row : table()) {
    Effect& e = facts.effects.emplace_back();
    e = {.key = row.key,
         .label = row.label,
         .group = row.group,
         .switches = row.switches,
         .can_be_off = row.remove != nullptr,
         .evidence = row.find(context)};
    if (!e.called_for()) e.missing = row.missing;
  }
  return facts;
}

std::string evidence_text(const Effect& effect, size_t most) {
  std::string text;
  for (size_t i = 0; i < effect.evidence.size() && i < most; ++i) {
    const Evidence& e = effect.evidence[i];
    const bool again = i > 0 && effect.evidence[i - 1].kind == e.kind;
    text += fmt::format("{}{}'{}'", i == 0 ? "" : ", ", again ? "" : fmt::format("{} ", kind_name(e.kind)),
                        e.name);
  }
  if (effect.evidence.size() > most) text += fmt::format(" and {} more", effect.evidence.size() - most);
  return text;
}

std::vector<std::string> parse_effects(const std::string& list, const std::string& where) {
  std::vector<std::string> keys;
  size_t begin = 0;
  while (begin <= list.size()) {
    const size_t comma = std::min(list.find(',', begin), list.size());
    std::string key = list.substr(begin, comma - begin);
    begin = comma + 1;
    key.erase(0, key.find_first_not_of(' '));
    key.erase(key.find_last_not_of(' ') + 1);
    if (key.empty()) continue;
    if (const Row* row = find_row(key); !row || !row->remove) {
      std::vector<std::string_view> valid;
      for (const Row& r : table())
        if (r.remove) valid.emplace_back(r.key);
      throw_error(where, "'{}': {}; valid: {}", key,
                  row ? "this effect cannot be off" : "there is no such effect", fmt::join(valid, ", "));
    }
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(std::move(key));
  }
  return keys;
}

std::shared_ptr<const Scene> without_effects(std::shared_ptr<const Scene> scene,
                                             const std::vector<std::string>& keys) {
  if (keys.empty()) return scene;
  const Context context(*scene);
  std::shared_ptr<Scene> less;
  for (const std::string& key : keys) {
    const Row& row = *find_row(key);
    if (row.find(context).empty()) continue;
    if (!less) less = std::make_shared<Scene>(*scene);
    row.remove(*less);
  }
  return less ? less : scene;
}

}  // namespace lucerna::plan
