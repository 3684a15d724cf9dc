// Selection of lights: emissive triangles and punctual lights by power, directions of the environment
// by its luminance.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/alias_table.h"
#include "scene/display_name.h"
#include "scene/lamp.h"
#include "upload/environment_map.h"
#include "upload/flatten.h"
#include "upload/texture_mean.h"

namespace lucerna::upload {
namespace {

using namespace shared;

/// Mean of the emission texture on a triangle; above 0 wherever it emits, because light paths start there
/// with a probability proportional to it.
double texture_mean(TextureMeans& means, const scene::TextureUse& use, const FlatScene& flat,
                    const uvec4& t) {
  const auto uv = [&](uint32_t vertex) {
    if (use.uv_set == 1 && !flat.extra.empty()) return vec2(flat.extra[2 * size_t(vertex) + 1]);
    return vec2(flat.vertices[2 * size_t(vertex)].w, flat.vertices[2 * size_t(vertex) + 1].w);
  };
  return means.over(use, {uv(t.x), uv(t.y), uv(t.z)});
}

/// m^2
float triangle_area(const FlatScene& flat, uint32_t primitive) {
  const vec3* p = &flat.positions[3 * size_t(primitive)];
  return 0.5f * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
}

/// Entries of the light table, with their selection weights from the scene, and their flux into it.
struct Choice {
  std::vector<LightEntry> entries;
  std::vector<double> weights, fluxes;
  void add(uint32_t kind, uint32_t index, double weight, double flux) {
    entries.push_back({kind, index});
    weights.push_back(weight);
    fluxes.push_back(flux);
  }
};

/// Emissive triangles: flux pi * L * A, twice that when both sides emit.
void add_triangles(const scene::Scene& scene, const FlatScene& flat, Choice& choice) {
  TextureMeans means(scene);
  for (uint32_t i = 0; i < flat.triangles.size(); ++i) {
    const scene::Material& m = scene.materials[flat.triangles[i].w & k_triangle_material_mask];
    if (m.unlit || luminance(m.emission) <= 0) continue;
    const float area = triangle_area(flat, i);
    if (!(area > 0)) continue;
    const double mean = texture_mean(means, m.emission_texture, flat, flat.triangles[i]);
    const double flux = double(k_pi) * area * luminance(m.emission) * mean * (m.double_sided ? 2 : 1);
    choice.add(k_light_triangle, i, flux, flux);
  }
}

/// Lamps: flux; for directional ones through a disk as large as the scene's core.
void add_lamps(const scene::Scene& scene, double disk, Choice& choice) {
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const scene::Light& l = scene.lights[i];
    if (!l.enabled || !(luminance(l.intensity) > 0) || has_shape(l.kind)) continue;
    const double y = luminance(l.intensity);
    if (l.kind == scene::LightKind::directional) {
      choice.add(k_light_directional, i, y * disk, y * disk);
    } else if (l.picture) {
      const double flux = y * scene::solid_angle(l);
      choice.add(k_light_projector, i, flux, flux);
    } else if (l.kind == scene::LightKind::spot) {
      const float inner = std::cos(l.inner_cone), outer = std::cos(l.outer_cone);
      choice.add(k_light_spot, i, y * (2 * k_pi * (1 - 0.5 * (inner + outer))), y * scene::solid_angle(l));
    } else if (l.kind == scene::LightKind::profile) {
      const double flux = y * scene::solid_angle(l);
      choice.add(k_light_profile, i, flux, flux);
    } else {
      choice.add(k_light_point, i, y * (4 * k_pi), y * scene::solid_angle(l));
    }
  }
}

/// Kind in the table of lights.
uint32_t shape_kind(scene::LightKind kind) {
  switch (kind) {
    case scene::LightKind::sphere:
      return k_light_sphere;
    case scene::LightKind::rectangle:
      return k_light_rectangle;
    case scene::LightKind::disk:
      return k_light_disk;
    default:
      return k_light_tube;
  }
}

/// Lamps with a shape, after the others: their flux.
void add_shapes(const scene::Scene& scene, Choice& choice, LightDistribution& d) {
  d.first_shape = uint32_t(choice.entries.size());
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const scene::Light& l = scene.lights[i];
    if (!l.enabled || !(luminance(l.intensity) > 0) || !has_shape(l.kind)) continue;
    const double flux = luminance(l.intensity) * scene::solid_angle(l);
    choice.add(shape_kind(l.kind), i, flux, flux);
    ++d.shape_count;
  }
}

/// The environment and the sun count with the whole scene's cross-section, of which an interior receives
/// little: both they and the lamps get at least a share of the samples.
void balance(Choice& choice, double& environment, double& sun) {
  const auto is_distant = [&](size_t i) { return choice.entries[i].kind == k_light_directional; };
  double local = 0, distant = environment + sun;
  for (size_t i = 0; i < choice.weights.size(); ++i) (is_distant(i) ? distant : local) += choice.weights[i];
  if (!(local > 0 && distant > 0)) return;
  const double share = std::clamp(distant / (local + distant), 0.25, 0.75);
  for (size_t i = 0; i < choice.weights.size(); ++i)
    choice.weights[i] *= is_distant(i) ? share / distant : (1 - share) / local;
  environment *= share / distant;
  sun *= share / distant;
}

/// Densities of emissive triangles' points, by primitive. Triangles are the table's first entries.
std::vector<float> triangle_densities(const FlatScene& flat, const LightDistribution& d) {
  std::vector<float> densities(flat.triangles.size(), 0.f);
  for (size_t k = 0; k < d.entries.size() && d.entries[k].kind == k_light_triangle; ++k)
    densities[d.entries[k].index] = d.light_alias[k].z / triangle_area(flat, d.entries[k].index);
  return densities;
}

/// Separate table of the lamps, for scenes with enough lamps to resample among them
/// (shaders/lib/lights.glsl). Includes lamps that are off, so that switching them compiles no kernels.
void choose_lamps(const scene::Scene& scene, const std::vector<double>& weights, FlatScene& flat,
                  LightDistribution& d) {
  constexpr size_t k_least = 3, k_many = 6;
  const size_t lamps = scene.lights.size();
  flat.effects.lamp_candidates = lamps < k_least ? 0 : lamps < k_many ? 4 : 8;
  const auto is_lamp = [](const LightEntry& e) {
    return e.kind != k_light_triangle && e.kind != k_light_environment && e.index != scene::k_none;
  };
  std::vector<double> of_lamps;
  for (size_t i = 0; i < d.entries.size(); ++i) {
    if (!is_lamp(d.entries[i])) continue;
    if (of_lamps.empty()) d.first_lamp = uint32_t(i);
    of_lamps.push_back(weights[i]);
  }
  d.lamp_count = uint32_t(of_lamps.size());
  if (flat.effects.lamp_candidates == 0 || of_lamps.empty()) return;
  d.lamp_alias = build_alias_table(of_lamps);
  d.lamp_pmf = float(std::accumulate(of_lamps.begin(), of_lamps.end(), 0.0) /
                     std::accumulate(weights.begin(), weights.end(), 0.0));
}

}  // namespace

void flatten_light_distribution(const scene::Scene& scene, FlatScene& flat) {
  LightDistribution d;
  Choice choice;
  add_triangles(scene, flat, choice);
  const bool emissive = !choice.entries.empty();
  const double disk = double(k_pi) * flat.core_radius * flat.core_radius;
  add_lamps(scene, disk, choice);
  add_shapes(scene, choice, d);
  for (size_t i = 0; i < scene.lights.size(); ++i)
    d.lamp_names.push_back(scene::display_name(scene.lights[i].name, "Light", i));
  const bool lit = environment_shines(scene.environment);
  const bool separate_sun = lit && flat.sun_threshold > 0;
  double environment = 0, sun = 0;
  if (lit) {
    d.environment = environment_tables(scene, separate_sun ? flat.sun_threshold : 0, flat.environment);
    // Mean radiance times solid angle through the scene's disk.
    const auto power = [&](double sum) {
      return sum * 2 * k_pi / EnvironmentMap(scene).width * scene.environment.scale * disk;
    };
    sun = power(d.environment.sun_weight);
    if (!separate_sun) d.portals = portal_tables(scene, d.environment, flat.portals);
    environment = power(d.environment.sky_weight);
  }
  const bool has_sun = sun > 0;
  const double sky_power = environment, sun_power = sun;
  balance(choice, environment, sun);
  if (separate_sun) {
    const double all = environment + sun + std::accumulate(choice.weights.begin(), choice.weights.end(), 0.0);
    if (all > 0) d.environment_light_pmf = float(environment / all);
    d.sky_power = sky_power;
    if (has_sun) choice.add(k_light_environment, 0, sun, sun_power);
    if (choice.entries.empty())
      choice.add(k_light_point, scene::k_none, 1, 0);  // dark: a table is never empty
  } else if (environment > 0) {
    choice.add(k_light_environment, 0, environment, sky_power);
    d.environment_light_pmf =
        float(environment / std::accumulate(choice.weights.begin(), choice.weights.end(), 0.0));
  }
  d.light_alias = build_alias_table(choice.weights);
  if (!d.light_alias.empty()) d.entries = std::move(choice.entries), d.light_power = std::move(choice.fluxes);
  choose_lamps(scene, choice.weights, flat, d);
  if (has_sun) {
    d.sun_density = d.environment.sun_density;
    for (vec4& four : d.sun_density) four *= d.light_alias.back().z;
  }
  if (emissive) d.primitive_light_pmf = triangle_densities(flat, d);
  flat.effects.lights = !d.entries.empty();
  flat.effects.emissive = emissive;
  flat.effects.profiles =
      flat.effects.lights && std::any_of(scene.lights.begin(), scene.lights.end(), [](const scene::Light& l) {
        return l.kind == scene::LightKind::profile;
      });
  flat.effects.pictures =
      flat.effects.lights && std::any_of(scene.lights.begin(), scene.lights.end(),
                                         [](const scene::Light& l) { return l.picture != nullptr; });
  flat.effects.shapes =
      flat.effects.lights && std::any_of(scene.lights.begin(), scene.lights.end(),
                                         [](const scene::Light& l) { return has_shape(l.kind); });
  flat.effects.environment_map = lit;
  flat.effects.separate_sky = separate_sun;
  flat.effects.sun = has_sun;
  flat.effects.portals = d.portals.count();
  flat.effects.light_groups = flat.groups ? uint32_t(flat.groups->groups.size()) : 1;
  flat.effects.group_components = flat.group_components;
  flat.effects.layers = flat.layers;
  static_cast<LightDistribution&>(flat) = std::move(d);
}

}  // namespace lucerna::upload
