// By what lights are chosen: emissive triangles and punctual lights by power, directions of the environment
// by its luminance.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "scene/lamp.h"
#include "upload/alias_table.h"
#include "upload/environment_map.h"
#include "upload/flatten.h"
#include "upload/textures.h"

namespace lucerna::upload {
namespace {

using namespace shared;
float as_float(uint32_t bits) { return std::bit_cast<float>(bits); }

/// Solid angle of a texel, times width / 2 pi: the difference of two cosines as a product, of which nothing
/// cancels beside the poles.
double row_band(uint32_t row, uint32_t h) {
  return 2 * std::sin(std::numbers::pi * (row + 0.5) / h) * std::sin(0.5 * std::numbers::pi / h);
}
/// Density of a texel's directions, per solid angle.
double texel_density(double pmf, size_t texel, uint32_t w, uint32_t h) {
  return pmf * w / (2 * std::numbers::pi * row_band(uint32_t(texel / w), h));
}

/// Weights of texels: luminance under the bilinear filter's support (a 3x3 tent), times the solid angle of
/// the texel, so that no direction with light has density 0.
std::vector<double> texel_weights(const std::vector<double>& y, uint32_t w, uint32_t h) {
  std::vector<double> weights(y.size());
  for (uint32_t row = 0; row < h; ++row) {
    const double band = row_band(row, h);
    for (uint32_t column = 0; column < w; ++column) {
      double sum = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const uint32_t r = uint32_t(std::clamp(int(row) + dy, 0, int(h) - 1)), c = (column + w + dx) % w;
          sum += y[size_t(r) * w + c] * (dx ? 1 : 2) * (dy ? 1 : 2) / 16.0;
        }
      weights[size_t(row) * w + column] = sum * band;
    }
  }
  return weights;
}

/// Luminances of a map's texels.
std::vector<double> luminances(const EnvironmentMap& map) {
  std::vector<double> y(size_t(map.width) * map.height);
  for (size_t i = 0; i < y.size(); ++i) y[i] = luminance(map.radiance(i));
  return y;
}

/// Which texels are the sun: those above the threshold times the mean over the sphere.
std::vector<uint8_t> sun_texels(const std::vector<double>& y, uint32_t w, uint32_t h, double threshold) {
  double sum = 0;
  for (uint32_t row = 0; row < h; ++row)
    for (uint32_t column = 0; column < w; ++column) sum += y[size_t(row) * w + column] * row_band(row, h);
  const double mean = sum / (2.0 * w);  // bands sum to 2
  std::vector<uint8_t> sun(y.size());
  for (size_t i = 0; i < y.size(); ++i) sun[i] = y[i] > threshold * mean;
  return sun;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

/// What the environment weighs, as one emitter or as two.
struct EnvironmentWeights {
  std::vector<double> texels, sun_texels;  ///< the latter none unless the sun is apart
  std::vector<uint8_t> is_sun;             ///< by texel
};

EnvironmentWeights environment_weights(const EnvironmentMap& map, bool sun_apart, double threshold) {
  EnvironmentWeights weights;
  std::vector<double> y = luminances(map);
  weights.is_sun.resize(y.size());
  if (sun_apart) {
    weights.is_sun = sun_texels(y, map.width, map.height, threshold);
    std::vector<double> of_sun(y.size());
    for (size_t i = 0; i < y.size(); ++i)
      if (weights.is_sun[i]) std::swap(of_sun[i], y[i]);
    weights.sun_texels = texel_weights(of_sun, map.width, map.height);
  }
  weights.texels = texel_weights(y, map.width, map.height);
  return weights;
}

/// Table and densities of the environment's texels.
void choose_texels(const EnvironmentMap& map, const EnvironmentWeights& weights, LightDistribution& to) {
  to.environment_alias = build_alias_table(weights.texels);
  const double total = sum_of(weights.texels);
  to.environment_density.resize(weights.texels.size());
  for (size_t i = 0; i < weights.texels.size(); ++i) {
    const float density =
        total > 0 ? float(texel_density(weights.texels[i] / total, i, map.width, map.height)) : 0;
    to.environment_density[i] = weights.is_sun[i] ? -density : density;
  }
}

/// The sun's table and densities, the latter without the sun's own pmf.
void choose_sun_cells(const EnvironmentMap& map, const std::vector<double>& weights, LightDistribution& to) {
  std::vector<double> cells;
  std::vector<vec4> texels;
  const double total = sum_of(weights);
  to.sun_density.assign((weights.size() + 3) / 4, vec4(0));
  for (size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0) continue;
    to.sun_density[i / 4][int(i % 4)] = float(texel_density(weights[i] / total, i, map.width, map.height));
    cells.push_back(weights[i]);
    texels.emplace_back(as_float(uint32_t(i)), 0, 0, 0);
  }
  to.sun_cells = build_alias_table(cells);
  to.sun_cells.insert(to.sun_cells.end(), texels.begin(), texels.end());
}

/// Mean luminance factor of the emission texture over a triangle, by 16 points; the estimate only steers
/// sampling.
double texture_mean(const scene::Scene& scene, const scene::TextureUse& use, const FlatScene& flat,
                    const uvec4& t) {
  if (!use) return 1;
  double sum = 0;
  for (int i = 0; i < 16; ++i) {
    float u = (i % 4 + 0.5f) / 4, v = (i / 4 + 0.5f) / 4;
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto uv = [&](uint32_t vertex) {
      if (use.uv_set == 1 && !flat.extra.empty()) return vec2(flat.extra[2 * size_t(vertex) + 1]);
      return vec2(flat.vertices[2 * size_t(vertex)].w, flat.vertices[2 * size_t(vertex) + 1].w);
    };
    sum += luminance(read_texture(scene, use, (1 - u - v) * uv(t.x) + u * uv(t.y) + v * uv(t.z)));
  }
  return sum / 16;
}

/// m^2
float triangle_area(const FlatScene& flat, uint32_t primitive) {
  const vec3* p = &flat.positions[3 * size_t(primitive)];
  return 0.5f * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
}

/// Entries of the light table, with the weight that each is chosen by from the scene, and the flux that it
/// sends there.
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
  for (uint32_t i = 0; i < flat.triangles.size(); ++i) {
    const scene::Material& m = scene.materials[flat.triangles[i].w & k_triangle_material_mask];
    if (m.unlit || luminance(m.emission) <= 0) continue;
    const float area = triangle_area(flat, i);
    if (!(area > 0)) continue;
    const double mean = texture_mean(scene, m.emission_texture, flat, flat.triangles[i]);
    const double flux = double(k_pi) * area * luminance(m.emission) * mean * (m.double_sided ? 2 : 1);
    choice.add(k_light_triangle, i, flux, flux);
  }
}

/// Lamps: flux; of a directional one that through a disk as large as the scene.
void add_lamps(const scene::Scene& scene, double disk, Choice& choice) {
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const scene::Light& l = scene.lights[i];
    if (!l.enabled || !(luminance(l.intensity) > 0)) continue;
    const double y = luminance(l.intensity);
    if (l.kind == scene::LightKind::directional) {
      choice.add(k_light_directional, i, y * disk, y * disk);
    } else if (l.kind == scene::LightKind::spot) {
      const float inner = std::cos(l.inner_cone), outer = std::cos(l.outer_cone);
      choice.add(k_light_spot, i, y * (2 * k_pi * (1 - 0.5 * (inner + outer))), y * scene::solid_angle(l));
    } else {
      choice.add(k_light_point, i, y * (4 * k_pi), y * scene::solid_angle(l));
    }
  }
}

/// The environment and the sun count with the whole scene's cross-section, of which an interior receives
/// little: neither they nor the lamps get less than a share of the samples.
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

/// A table of the lamps alone, for scenes with as many as make it worth to choose among them
/// (shaders/lib/lights.glsl). Lamps that are off count, so that switching them compiles no kernels.
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
  if (flat.effects.lamp_candidates == 0 || of_lamps.empty()) return;
  d.lamp_alias = build_alias_table(of_lamps);
  d.lamp_pmf = float(sum_of(of_lamps) / sum_of(weights));
}

}  // namespace

void flatten_light_distribution(const scene::Scene& scene, FlatScene& flat) {
  LightDistribution d;
  Choice choice;
  add_triangles(scene, flat, choice);
  const bool emissive = !choice.entries.empty();
  const double disk = double(k_pi) * flat.scene_radius * flat.scene_radius;
  add_lamps(scene, disk, choice);
  const bool lit = environment_shines(scene.environment);
  const bool sun_apart = lit && flat.sun_threshold > 0;
  const EnvironmentMap map(scene);
  EnvironmentWeights weights;
  double environment = 0, sun = 0;
  if (lit) {
    weights = environment_weights(map, sun_apart, double(flat.sun_threshold));
    // Mean radiance times solid angle through the scene's disk.
    const auto power = [&](double sum) {
      return sum * 2 * k_pi / map.width * scene.environment.scale * disk;
    };
    sun = power(sum_of(weights.sun_texels));
    environment = power(sum_of(weights.texels));
    choose_texels(map, weights, d);
  }
  const bool has_sun = sun > 0;
  const double sky_power = environment, sun_power = sun;
  balance(choice, environment, sun);
  if (sun_apart) {
    const double all = environment + sun + sum_of(choice.weights);
    if (all > 0) d.environment_light_pmf = float(environment / all);
    d.sky_power = sky_power;
    if (has_sun) {
      choose_sun_cells(map, weights.sun_texels, d);
      choice.add(k_light_environment, 0, sun, sun_power);
    }
    if (choice.entries.empty())
      choice.add(k_light_point, scene::k_none, 1, 0);  // dark: a table is never empty
  } else if (environment > 0) {
    choice.add(k_light_environment, 0, environment, sky_power);
    d.environment_light_pmf = float(environment / sum_of(choice.weights));
  }
  d.light_alias = build_alias_table(choice.weights);
  if (!d.light_alias.empty()) d.entries = std::move(choice.entries), d.light_power = std::move(choice.fluxes);
  choose_lamps(scene, choice.weights, flat, d);
  if (has_sun)
    for (vec4& four : d.sun_density) four *= d.light_alias.back().z;
  if (emissive) d.primitive_light_pmf = triangle_densities(flat, d);
  flat.effects.lights = !d.entries.empty();
  flat.effects.emissive = emissive;
  flat.effects.environment_map = lit;
  flat.effects.sky_apart = sun_apart;
  flat.effects.sun = has_sun;
  flat.effects.light_groups = flat.groups ? uint32_t(flat.groups->groups.size()) : 1;
  flat.effects.group_components = flat.group_components;
  static_cast<LightDistribution&>(flat) = std::move(d);
}

}  // namespace lucerna::upload
