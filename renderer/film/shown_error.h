#pragma once
// How wrong the picture in the window is, tile by tile, calibrated by samples that it has not used.
//
// A preview expects an error of each tile (PreviewTile::error), which has about the right pattern but not
// always the right size. Samples taken after a picture was shown measure its squared error without bias, but
// with much noise (shaders/film/preview_judge.comp). What is expected is corrected by the ratio of the two
// over the whole picture, over neighbourhoods of 9x9 and 3x3 tiles and in the tile itself, at each level
// weighed by the variance of the measurements.
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
  /// Another picture begins: measurements are dropped; half of what they said of the size of expected errors,
  /// as a power, is kept.
  void restart();
  /// The tiles of what is shown now, in raster order; `across` in a row. `measured`: their square and noise
  /// are of the picture before. No tiles: no error.
  ShownError judge(std::span<const shared::PreviewTile> tiles, uint32_t across, bool measured);
  /// True squared errors over the expected ones, over the picture judged last.
  double ratio() const { return ratio_; }

 private:
  /// The square of a tile's error as measured so far, times `weight`, and the variance of that sum.
  struct Measured {
    double square = 0, weight = 0, variance = 0;
  };
  void measure(std::span<const shared::PreviewTile> tiles, uint32_t across);

  std::vector<Measured> tiles_;
  double first_ratio_ = 1, ratio_ = 1;
};

}  // namespace lucerna::film
