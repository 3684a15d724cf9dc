#include "upload/environment_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/alias_table.h"
#include "upload/environment_map.h"

namespace lucerna::upload {
namespace {

/// Solid angle of a texel, times width / 2 pi: the difference of two cosines as a product, without
/// cancellation near the poles.
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

/// Selects the texels of the sun: those above the threshold times the mean over the sphere.
std::vector<uint8_t> sun_texels(const std::vector<double>& y, uint32_t w, uint32_t h, double threshold) {
  double sum = 0;
  for (uint32_t row = 0; row < h; ++row)
    for (uint32_t column = 0; column < w; ++column) sum += y[size_t(row) * w + column] * row_band(row, h);
  const double mean = sum / (2.0 * w);  // bands sum to 2
  std::vector<uint8_t> sun(y.size());
  for (size_t i = 0; i < y.size(); ++i) sun[i] = y[i] > threshold * mean;
  return sun;
}

/// Weights of the environment's texels, as one emitter or as two.
struct EnvironmentWeights {
  std::vector<double> texels, sun_texels;  ///< the latter empty unless the sun is separate
  std::vector<uint8_t> is_sun;             ///< by texel
};

EnvironmentWeights environment_weights(const EnvironmentMap& map, bool separate_sun, double threshold) {
  EnvironmentWeights weights;
  std::vector<double> y = luminances(map);
  weights.is_sun.resize(y.size());
  if (separate_sun) {
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
void choose_texels(const EnvironmentMap& map, const EnvironmentWeights& weights, EnvironmentTables& to) {
  to.alias = build_alias_table(weights.texels);
  to.sky_weight = std::accumulate(weights.texels.begin(), weights.texels.end(), 0.0);
  std::vector<float> densities(weights.texels.size());
  for (size_t i = 0; i < weights.texels.size(); ++i) {
    const float density =
        to.sky_weight > 0 ? float(texel_density(to.alias[i].z, i, map.width, map.height)) : 0;
    densities[i] = weights.is_sun[i] ? -density : density;
  }
  to.density = std::move(densities);
}

/// The sun's table and densities, the latter without the sun's own pmf.
void choose_sun_cells(const EnvironmentMap& map, const std::vector<double>& weights, EnvironmentTables& to) {
  to.sun_weight = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(to.sun_weight > 0)) return;
  std::vector<double> cells;
  std::vector<vec4> texels;
  for (size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0) continue;
    cells.push_back(weights[i]);
    texels.emplace_back(std::bit_cast<float>(uint32_t(i)), 0, 0, 0);
  }
  std::vector<vec4> table = build_alias_table(cells), densities((weights.size() + 3) / 4, vec4(0));
  for (size_t k = 0; k < texels.size(); ++k) {
    const auto i = std::bit_cast<uint32_t>(texels[k].x);
    densities[i / 4][int(i % 4)] = float(texel_density(table[k].z, i, map.width, map.height));
  }
  table.insert(table.end(), texels.begin(), texels.end());
  to.sun_cells = std::move(table), to.sun_density = std::move(densities);
}

}  // namespace

EnvironmentSource::EnvironmentSource(const scene::Scene& scene) : image(scene.environment.image) {
  if (image == scene::k_none)
    radiance = scene.environment.radiance;
  else
    images = scene.images;
}

bool EnvironmentSource::operator==(const EnvironmentSource& o) const {
  return image == o.image && radiance == o.radiance && images.shares_with(o.images);
}

EnvironmentTables environment_tables(const scene::Scene& scene, float sun_threshold,
                                     const EnvironmentTables& before) {
  EnvironmentTables to;
  to.source = EnvironmentSource(scene), to.sun_threshold = sun_threshold;
  if (before.source == to.source && before.sun_threshold == sun_threshold) return before;
  const EnvironmentMap map(scene);
  const EnvironmentWeights weights = environment_weights(map, sun_threshold > 0, double(sun_threshold));
  choose_texels(map, weights, to);
  choose_sun_cells(map, weights.sun_texels, to);
  return to;
}

}  // namespace lucerna::upload
