#pragma once
// Learned probabilities of lights from recorded light samples (shaders/shared/learned_lights.h): pure host
// code.
#include <span>
#include <vector>

#include "shaders/shared/learned_lights.h"
#include "upload/light_clusters.h"

namespace lucerna::transport {

/// Grid of the cells of space: a cube of shared::k_learned_cells along an axis. Points outside use the cells
/// at its border.
struct LearnedCells {
  vec3 origin{0};
  float scale = 0;  ///< cells a metre; 0: a single cell
};
/// Grid around most of the positions of light samples.
LearnedCells learned_cells(std::span<const shared::LightRecord> records);

/// Rows of probabilities of clusters, and the row of each cell.
struct LearnedLights {
  LearnedCells cells;
  std::vector<uint32_t> grid;  ///< learned_grid
  std::vector<vec4> rows;      ///< learned_rows
  uint32_t row_count = 0;
  /// By row: share of unblocked shadow rays among the light samples of the last generation; < 0: unknown.
  std::vector<float> arrived;

  /// Row for a place and facing (shared::LightRecord::cell), as kernels find it.
  uint32_t row_at(const vec3& position, uint32_t facing) const;
};

/// Probabilities of an unlearned start: nearly as without learning, with a tenth uniform over clusters.
LearnedLights plain_lights(const upload::LightClusters& clusters);
/// For the first generation: half as without learning, half uniform over clusters, so that weak lights are
/// found where they are the only ones visible.
LearnedLights exploring_lights(const upload::LightClusters& clusters);
/// Learns from recorded samples. Cells are as small as the number of records allows; the prior of cells with
/// few records is that of the cells around them, and of all space the probabilities without learning. The
/// order of records does not matter. `last`: number of records of the last generation, at the end.
LearnedLights learn_lights(const upload::LightClusters& clusters, const LearnedCells& cells,
                           std::span<const shared::LightRecord> records, size_t last = 0);
/// Variance of a light sample without learning over that with `lights`, both relative to the squared light of
/// its row with a floor of 5 % of the mean. `records`: sampled with `lights`, which must not have learned
/// from them: variances of the same samples would be too small by far. Their order does not matter. At most
/// 10^6; 1 without light.
double measured_gain(const upload::LightClusters& clusters, const LearnedLights& lights,
                     std::span<const shared::LightRecord> records);

}  // namespace lucerna::transport
