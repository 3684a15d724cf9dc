// Emission of the lights of a flattened scene.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "scene/lamp.h"
#include "upload/environment_irradiance.h"
#include "upload/environment_map.h"
#include "upload/flatten.h"

namespace lucerna::upload {
namespace {

using namespace shared;

/// Texels of the light table (shaders/shared/scene.h).
using LightTexels = std::array<vec4, k_light_texels>;

LightTexels triangle_texels(const scene::Scene& scene, const FlatScene& flat, uint32_t primitive) {
  const uvec4& t = flat.triangles[primitive];
  const scene::Material& m = scene.materials[t.w & k_triangle_material_mask];
  const vec3* p = &flat.positions[3 * size_t(primitive)];
  const float area = 0.5f * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
  const uint32_t sides =
      (m.double_sided ? k_light_both_sides : 0u) | (t.w & k_triangle_flipped ? k_light_flipped : 0u);
  return {vec4(p[0], as_float(k_light_triangle)), vec4(p[1], area), vec4(p[2], as_float(primitive)),
          vec4(m.emission, as_float(sides))};
}

/// Where a profile or a picture is in the list, which gets it if it has not.
template <class T>
uint32_t number_of(std::vector<std::shared_ptr<const T>>& list, const std::shared_ptr<const T>& item) {
  const auto found = std::find(list.begin(), list.end(), item);
  const auto number = uint32_t(found - list.begin());
  if (found == list.end()) list.push_back(item);
  return number;
}

/// The table of pictures (shaders/shared/scene.h).
std::vector<vec4> picture_texels(const Pictures& pictures) {
  std::vector<vec4> texels(pictures.size());
  for (size_t p = 0; p < pictures.size(); ++p) {
    const scene::LightPicture& picture = *pictures[p];
    texels[p] = vec4(as_float(uint32_t(texels.size())), as_float(picture.width), as_float(picture.height), 0);
    for (uint32_t y = 0; y < picture.height; ++y)
      for (uint32_t x = 0; x < picture.width; ++x) {
        const bool has_cell = y + 1 < picture.height && x + 1 < picture.width;
        texels.emplace_back(picture.at(x, y),
                            has_cell ? picture.cell_density[size_t{y} * (picture.width - 1) + x] : 0);
      }
    for (const vec4& entry : picture.alias) texels.emplace_back(entry.x, entry.y, 0, 0);
  }
  return texels;
}

/// The table of profiles (shaders/shared/scene.h).
std::vector<vec4> profile_texels(const Profiles& profiles) {
  std::vector<vec4> texels(profiles.size());
  for (size_t p = 0; p < profiles.size(); ++p) {
    const scene::LightProfile& profile = *profiles[p];
    texels[p] = vec4(as_float(uint32_t(texels.size())), as_float(profile.rows), as_float(profile.columns), 0);
    const std::vector<vec4>& alias = profile.alias;
    const double step = std::numbers::pi / (profile.rows - 1), width = 2 * std::numbers::pi / profile.columns;
    for (uint32_t row = 0, i = 0; row < profile.rows; ++row) {
      const double angle = width * (std::cos(step * row) - std::cos(step * (row + 1)));
      for (uint32_t column = 0; column < profile.columns; ++column, ++i)
        texels.push_back(row + 1 < profile.rows
                             ? vec4(profile.intensity[i], alias[i].x, alias[i].y, double(alias[i].z) / angle)
                             : vec4(profile.intensity[i], 1, as_float(i), 0));
    }
  }
  return texels;
}

/// `table`: number of its profile or picture.
LightTexels lamp_texels(const scene::Light& l, uint32_t kind, uint32_t table) {
  const vec3 intensity = l.enabled ? l.intensity : vec3(0);
  if (l.kind == scene::LightKind::directional)
    return {vec4(vec3(0), as_float(kind)), vec4(intensity, 0), vec4(l.direction, 0), vec4(0)};
  if (has_shape(l.kind)) {
    const vec2 half = scene::half_size(l);
    const uint32_t bits = (l.two_sided ? k_light_both_sides : 0u) | (l.visible ? 0u : k_light_hidden);
    return {vec4(l.position, as_float(kind)), vec4(intensity, half.x), vec4(l.direction, half.y),
            vec4(scene::right_across(l.direction, l.right), as_float(bits))};
  }
  if (l.kind == scene::LightKind::profile)
    return {vec4(l.position, as_float(kind)), vec4(intensity, 0), vec4(l.direction, 0),
            vec4(scene::right_across(l.direction, l.right), as_float(table << k_light_profile_shift))};
  if (l.picture) {
    const vec2 extent = scene::picture_extent(l);
    return {vec4(l.position, as_float(kind)), vec4(intensity, extent.x), vec4(l.direction, extent.y),
            vec4(scene::right_across(l.direction, l.right), as_float(table << k_light_profile_shift))};
  }
  return {vec4(l.position, as_float(kind)), vec4(intensity, std::cos(l.inner_cone)),
          vec4(l.direction, std::cos(l.outer_cone)), vec4(0)};
}

/// Emission of a table's entry; `surfaces` by primitive.
uint32_t group_of(const FlatScene& flat, const LightEntry& entry, const std::vector<uint8_t>& surfaces) {
  if (entry.kind == k_light_triangle) return surfaces[entry.index];
  // With a separate sky, the entry is the sun's.
  if (entry.kind == k_light_environment)
    return flat.effects.separate_sky ? flat.groups->sun : flat.groups->sky;
  return entry.index == scene::k_none ? 0 : flat.groups->lamps[entry.index];
}

/// Light groups of the primitives, 0 for those that do not emit.
std::vector<uint8_t> surface_groups(const scene::Scene& scene, const FlatScene& flat) {
  std::vector<uint8_t> groups;
  groups.reserve(flat.triangles.size());
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const auto& primitives = scene::shown_parts(scene, scene.instances[i]);
    const std::vector<uint8_t>& of = flat.groups->surfaces[i];
    for (size_t p = 0; p < primitives.size(); ++p)
      groups.insert(groups.end(), primitives[p].triangles.size(), of.empty() ? uint8_t(0) : of[p]);
  }
  return groups;
}

LightTexels texels_of(const scene::Scene& scene, const FlatScene& flat, const LightEntry& entry,
                      Profiles& profiles, Pictures& pictures) {
  if (entry.kind == k_light_triangle) return triangle_texels(scene, flat, entry.index);
  const vec4 only_kind(vec3(0), as_float(entry.kind));
  if (entry.kind == k_light_environment) {
    const auto sun_cells = uint32_t(flat.environment.sun_cells.size() / 2);
    return {only_kind, vec4(as_float(sun_cells), 0, 0, 0), vec4(0), vec4(0)};
  }
  if (entry.index == scene::k_none) return {only_kind, vec4(0), vec4(0), vec4(0)};
  const scene::Light& lamp = scene.lights[entry.index];
  const uint32_t table = lamp.profile   ? number_of(profiles, lamp.profile)
                         : lamp.picture ? number_of(pictures, lamp.picture)
                                        : 0;
  return lamp_texels(lamp, entry.kind, table);
}

}  // namespace

void flatten_emission(const scene::Scene& scene, FlatScene& flat) {
  Emission e;
  if (flat.effects.light_groups > 1) e.emissive_groups = surface_groups(scene, flat);
  e.lights.reserve(flat.entries.size() * k_light_texels);
  Profiles profiles;
  Pictures pictures;
  for (const LightEntry& entry : flat.entries) {
    LightTexels texels = texels_of(scene, flat, entry, profiles, pictures);
    if (flat.effects.light_groups > 1)
      texels[3].w = as_float(std::bit_cast<uint32_t>(texels[3].w) | group_of(flat, entry, e.emissive_groups)
                                                                        << k_light_group_shift);
    e.lights.insert(e.lights.end(), texels.begin(), texels.end());
  }
  e.profiles =
      profiles == flat.profiles_in_table ? flat.profiles : SharedVector<vec4>(profile_texels(profiles));
  e.profiles_in_table = std::move(profiles);
  e.pictures =
      pictures == flat.pictures_in_table ? flat.pictures : SharedVector<vec4>(picture_texels(pictures));
  e.pictures_in_table = std::move(pictures);
  e.environment_rotation = scene.environment.rotation * k_pi / 180;
  if (flat.effects.environment_map) {
    const EnvironmentMap map(scene);
    e.environment_radiance = vec3(scene.environment.scale);
    e.environment_width = map.width, e.environment_height = map.height;
    e.environment_source = EnvironmentSource(scene);
    if (flat.environment_source == e.environment_source) {
      e.environment_texels = flat.environment_texels;
    } else {
      std::vector<vec3> texels(size_t(map.width) * map.height);
      for (size_t i = 0; i < texels.size(); ++i) texels[i] = map.radiance(i);
      e.environment_texels = std::move(texels);
    }
    const bool catches = std::any_of(scene.materials.begin(), scene.materials.end(),
                                     [](const scene::Material& m) { return m.shadow_catcher; });
    const bool known =
        flat.environment_source == e.environment_source && !flat.environment_irradiance.empty();
    if (catches && known)
      e.environment_irradiance = flat.environment_irradiance;
    else if (catches)
      e.environment_irradiance =
          environment_irradiance(std::as_const(e.environment_texels), map.width, map.height);
  }
  static_cast<Emission&>(flat) = std::move(e);
}

void flatten_lights(const scene::Scene& scene, FlatScene& flat) {
  flatten_light_distribution(scene, flat);
  flatten_emission(scene, flat);
}

}  // namespace lucerna::upload
