#pragma once
// What light samples teach about choosing lights (shaders/shared/learned_lights.h): pure host code.
#include <span>
#include <vector>

#include "shaders/shared/learned_lights.h"
#include "upload/light_clusters.h"

namespace lucerna::transport {

/// Where the cells of space lie: a cube of shared::k_learned_cells along an axis. What lies outside is served
/// by the cells at its border.
struct LearnedCells {
  vec3 origin{0};
  float scale = 0;  ///< cells a metre; 0: there is one cell
};
/// Around most of the places where lights were sampled.
LearnedCells learned_cells(std::span<const shared::LightRecord> records);

/// Rows of probabilities of clusters, and which serves where.
struct LearnedLights {
  LearnedCells cells;
  std::vector<uint32_t> grid;  ///< learned_grid
  std::vector<vec4> rows;      ///< learned_rows
  uint32_t row_count = 0;
  /// By row: share of the light samples of the last generation there whose shadow rays have arrived; < 0: not
  /// known.
  std::vector<float> arrived;
  /// Variance of a light sample with the probabilities without learning over that with these, both relative
  /// to the square of what arrives: estimated from the same samples. 1 where nothing was recorded.
  double gain = 1;
};

/// Nearly as without learning, everywhere: a tenth is even over clusters.
LearnedLights plain_lights(const upload::LightClusters& clusters);
/// For the first generation: half as without learning, half uniform over clusters, so that weak lights are
/// found where they are the only ones visible.
LearnedLights exploring_lights(const upload::LightClusters& clusters);
/// From recorded samples. Cells are as small as what was recorded there allows; where little was, they begin
/// with what the cells around them have found, all of space with the probabilities without learning. The
/// order of records does not matter. `last`: records of the last generation, which are the last of them.
LearnedLights learn_lights(const upload::LightClusters& clusters, const LearnedCells& cells,
                           std::span<const shared::LightRecord> records, size_t last = 0);

}  // namespace lucerna::transport
