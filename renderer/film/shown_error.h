#pragma once
// How wrong the picture in the window is, tile by tile, calibrated by samples that it has not used.
//
// A preview expects an error of each tile (PreviewTile::error), which has about the right pattern but not
// always the right size. Samples taken after a picture was shown measure its squared error without bias, but
// with much noise (shaders/film/preview_judge.comp). The ratio of the two is estimated for the whole picture,
// for neighbourhoods of 9x9 and 3x3 tiles and for the tile itself: at each level by its measurements and,
// weighed by their variances, by the level above it.
#include <cstdint>
#include <span>
#include <vector>

#include "shaders/shared/preview.h"

namespace lucerna::film {

/// Relative errors of tiles of k_preview_tile pixels: means over a tile of the deviation of 3x3 pixels'
/// means, over their luminance or shared::k_preview_dark.
struct ShownError {
  double median = 0, worst_tenth = 0;  ///< a tenth of the tiles exceed the latter
};

class ShownJudge {
 public:
  /// Another picture begins: measurements of tiles are dropped, the picture's ratio counts less.
  void restart();
  /// The tiles of what is shown now, in raster order; `across` in a row. `measured`: their expected, square
  /// and noise are of the picture before. No tiles: no error.
  ShownError judge(std::span<const shared::PreviewTile> tiles, uint32_t across, bool measured);
  /// True squared errors over the expected ones, over the picture.
  double ratio() const;

 private:
  /// Sums over tiles and measurements of the square measured and expected, and the variance of the former,
  /// each by a weight that makes bright and dark tiles alike.
  struct Sums {
    double square = 0, expected = 0, variance = 0;
    void add(const Sums& other, double weight = 1);
    /// The ratio square/expected, given `prior` and its variance.
    double ratio(double prior, double prior_variance) const;
  };
  void measure(std::span<const shared::PreviewTile> tiles, uint32_t across);
  std::vector<double> tile_ratios(uint32_t across) const;

  std::vector<Sums> tiles_;
  Sums all_;
};

}  // namespace lucerna::film
