// Lights of a flattened scene: emissive triangles by power, punctual lights, the environment by importance.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "upload/alias_table.h"
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

/// Stores the map and gives the luminances of its texels.
std::vector<double> flatten_environment_map(const scene::Image& image, FlatScene& flat) {
  const uint32_t w = image.width, h = image.height;
  flat.environment_width = w;
  flat.environment_height = h;
  flat.environment_texels.resize(size_t(w) * h);
  std::vector<double> y(size_t(w) * h);
  for (size_t i = 0; i < y.size(); ++i) {
    vec3 c(image.floats[4 * i], image.floats[4 * i + 1], image.floats[4 * i + 2]);
    for (int k = 0; k < 3; ++k) c[k] = std::isfinite(c[k]) ? std::max(c[k], 0.f) : 0.f;
    flat.environment_texels[i] = vec4(c, 0);
    y[i] = luminance(c);
  }
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

/// The sun's table and densities, the latter without the sun's own pmf; returns the number of its cells.
uint32_t flatten_sun(const std::vector<double>& weights, FlatScene& flat) {
  std::vector<double> cells;
  std::vector<vec4> texels;
  const double total = sum_of(weights);
  flat.sun_density.assign((weights.size() + 3) / 4, vec4(0));
  for (size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0) continue;
    flat.sun_density[i / 4][int(i % 4)] =
        float(texel_density(weights[i] / total, i, flat.environment_width, flat.environment_height));
    cells.push_back(weights[i]);
    texels.emplace_back(as_float(uint32_t(i)), 0, 0, 0);
  }
  flat.sun_cells = build_alias_table(cells);
  flat.sun_cells.insert(flat.sun_cells.end(), texels.begin(), texels.end());
  return uint32_t(cells.size());
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

/// Solid angle of a spot's cone, each direction weighted with its intensity over that on the axis: full
/// within the inner cone, and the square of what is left of the way to the outer cosine, as
/// shaders/lib/lights.glsl.
double spot_solid_angle(double inner, double outer) {
  const double width = std::max(inner - outer, 1e-4), ramp = std::min(1.0, (1 - outer) / width);
  return 2 * std::numbers::pi * (std::max(0.0, 1 - outer - width) + width * ramp * ramp * ramp / 3);
}

}  // namespace

void flatten_lights(const scene::Scene& scene, FlatScene& flat) {
  flat.lights.clear();
  flat.primitive_light_pmf.clear();
  flat.light_power.clear();
  flat.sky_power = 0;
  flat.environment_texels.clear();
  flat.environment_alias.clear();
  flat.sun_cells.clear();
  flat.sun_density.clear();
  flat.environment_width = flat.environment_height = 0;
  std::vector<double> weights;  // of light samples
  const auto add = [&](uint32_t kind, vec3 a, vec4 b, vec4 c, vec4 d, double weight, double power) {
    flat.lights.insert(flat.lights.end(), {vec4(a, as_float(kind)), b, c, d});
    weights.push_back(weight);
    flat.light_power.push_back(power);
  };
  const auto is_distant = [&](size_t light) {
    return std::bit_cast<uint32_t>(flat.lights[light * k_light_texels].w) == k_light_directional;
  };
  // Emissive triangles: flux pi * L * A, twice that when both sides emit.
  std::vector<std::pair<uint32_t, float>> emissive;
  for (uint32_t i = 0; i < flat.triangles.size(); ++i) {
    const scene::Material& m = scene.materials[flat.triangles[i].w & k_triangle_material_mask];
    if (m.unlit || luminance(m.emission) <= 0) continue;
    const vec3* p = &flat.positions[3 * size_t(i)];
    const float area = 0.5f * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    if (!(area > 0)) continue;
    const double mean = texture_mean(scene, m.emission_texture, flat, flat.triangles[i]);
    emissive.emplace_back(i, area);
    const uint32_t sides = (m.double_sided ? k_light_both_sides : 0u) |
                           (flat.triangles[i].w & k_triangle_flipped ? k_light_flipped : 0u);
    const double power = double(k_pi) * area * luminance(m.emission) * mean * (m.double_sided ? 2 : 1);
    add(k_light_triangle, p[0], vec4(p[1], area), vec4(p[2], as_float(i)), vec4(m.emission, as_float(sides)),
        power, power);
  }
  const double disk = double(k_pi) * flat.scene_radius * flat.scene_radius;
  for (const scene::Light& l : scene.lights) {
    if (!l.enabled || !(luminance(l.intensity) > 0)) continue;
    const float inner = std::cos(l.inner_cone), outer = std::cos(l.outer_cone);
    const double y = luminance(l.intensity);
    const bool spot = l.kind == scene::LightKind::spot;
    if (l.kind == scene::LightKind::directional)
      add(k_light_directional, vec3(0), vec4(l.intensity, 0), vec4(l.direction, 0), vec4(0), y * disk,
          y * disk);
    else
      add(spot ? k_light_spot : k_light_point, l.position, vec4(l.intensity, inner), vec4(l.direction, outer),
          vec4(0), y * (spot ? 2 * k_pi * (1 - 0.5 * (inner + outer)) : 4 * k_pi),
          y * (spot ? spot_solid_angle(double(inner), double(outer)) : 4 * std::numbers::pi));
  }
  // Environment. A constant one is a map of one texel: sampled like any light it has 1.2 times less variance
  // a second in an interior than left to the scattered rays alone.
  const scene::Environment& environment = scene.environment;
  scene::Image one_texel;
  one_texel.width = one_texel.height = 1;
  one_texel.floats = {environment.radiance.x, environment.radiance.y, environment.radiance.z, 1};
  const bool constant = environment.image == scene::k_none;
  const bool map = environment.scale > 0 && !(constant && luminance(environment.radiance) <= 0);
  flat.environment_radiance = vec3(map ? environment.scale : 0);
  flat.environment_rotation = environment.rotation * k_pi / 180;
  double environment_weight = 0, sun_weight = 0;
  std::vector<double> sun_weights;  // of texels
  flat.effects.sky_apart = map && flat.sun_threshold > 0;
  if (map) {
    std::vector<double> y =
        flatten_environment_map(constant ? one_texel : scene.images[environment.image], flat);
    const uint32_t w = flat.environment_width, h = flat.environment_height;
    // Mean radiance times solid angle through the scene's disk.
    const auto power = [&](double sum) { return sum * 2 * k_pi / w * environment.scale * disk; };
    std::vector<uint8_t> sun(y.size());
    if (flat.effects.sky_apart) {
      sun = sun_texels(y, w, h, double(flat.sun_threshold));
      std::vector<double> of_sun(y.size());
      for (size_t i = 0; i < y.size(); ++i)
        if (sun[i]) std::swap(of_sun[i], y[i]);
      sun_weights = texel_weights(of_sun, w, h);
      sun_weight = power(sum_of(sun_weights));
    }
    const std::vector<double> texels = texel_weights(y, w, h);
    flat.environment_alias = build_alias_table(texels);
    const double total = sum_of(texels);
    environment_weight = power(total);
    for (size_t i = 0; i < texels.size(); ++i) {
      const float density = total > 0 ? float(texel_density(texels[i] / total, i, w, h)) : 0;
      flat.environment_texels[i].w = sun[i] ? -density : density;
    }
  }
  flat.effects.sun = sun_weight > 0;
  const double sky_power = environment_weight, sun_power = sun_weight;
  // The environment and the sun count with the whole scene's cross-section, of which an interior receives
  // little: neither they nor the lamps get less than a share of the samples.
  double local = 0, distant = environment_weight + sun_weight;
  for (size_t i = 0; i < weights.size(); ++i) {
    (is_distant(i) ? distant : local) += weights[i];
  }
  if (local > 0 && distant > 0) {
    const double share = std::clamp(distant / (local + distant), 0.25, 0.75);
    for (size_t i = 0; i < weights.size(); ++i) {
      weights[i] *= is_distant(i) ? share / distant : (1 - share) / local;
    }
    environment_weight *= share / distant;
    sun_weight *= share / distant;
  }
  flat.environment_light_pmf = 0;
  if (flat.effects.sky_apart) {
    const double all = environment_weight + sun_weight + sum_of(weights);
    if (all > 0) flat.environment_light_pmf = float(environment_weight / all);
    if (flat.effects.sun) {
      const uint32_t cells = flatten_sun(sun_weights, flat);
      add(k_light_environment, vec3(0), vec4(as_float(cells), 0, 0, 0), vec4(0), vec4(0), sun_weight,
          sun_power);
    }
    if (weights.empty())
      add(k_light_point, vec3(0), vec4(0), vec4(0), vec4(0), 1, 0);  // dark: a table is never empty
    flat.sky_power = sky_power;
  } else if (environment_weight > 0) {
    add(k_light_environment, vec3(0), vec4(0), vec4(0), vec4(0), environment_weight, sky_power);
    double total = 0;
    for (double w : weights) total += w;
    flat.environment_light_pmf = float(environment_weight / total);
  }
  flat.light_alias = build_alias_table(weights);
  if (flat.light_alias.empty()) flat.lights.clear();
  if (flat.effects.sun)
    for (vec4& four : flat.sun_density) four *= flat.light_alias.back().z;
  flat.primitive_light_pmf.assign(emissive.empty() ? 0 : flat.triangles.size(), 0.f);
  for (size_t k = 0; k < emissive.size() && !flat.light_alias.empty(); ++k)
    flat.primitive_light_pmf[emissive[k].first] = flat.light_alias[k].z / emissive[k].second;
  flat.effects.lights = !flat.lights.empty();
  flat.effects.emissive = !emissive.empty();
  flat.effects.environment_map = map;
}

}  // namespace lucerna::upload
