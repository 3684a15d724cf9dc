#pragma once
// Error of the picture in the window, tile by tile, calibrated by samples that it has not used.
//
// A preview estimates an error for each tile (PreviewTile::error), with approximately the right pattern but
// not always the right size. Samples taken after a picture was shown measure its squared error without bias,
// but with much noise (shaders/film/preview_judge.comp). The estimate is multiplied by the ratio of the two
// for the whole picture, for neighbourhoods of 9x9 and 3x3 tiles and for the tile itself, at each level
// weighted by the variance of the measurements.
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
  ShownJudge();
  /// Starts another picture: drops measurements, and expects a ratio half-way (in logarithms) between this
  /// picture's and the usual one.
  void restart();
  /// Error of the shown picture from its tiles, in raster order, `across` in a row. `measured`: their
  /// `square` and `noise` are valid, for the previous picture. Without tiles, no error.
  ShownError judge(std::span<const shared::PreviewTile> tiles, uint32_t across, bool measured);
  /// True squared errors over the expected ones, in the last measured picture.
  double ratio() const { return ratio_; }

 private:
  /// Sum of a tile's measured squared errors, times `weight`, and the variance of that sum.
  struct Measured {
    double square = 0, weight = 0, variance = 0;
  };
  void measure(std::span<const shared::PreviewTile> tiles, uint32_t across);

  std::vector<Measured> tiles_;
  double first_ratio_, ratio_;
};

}  // namespace lucerna::film
