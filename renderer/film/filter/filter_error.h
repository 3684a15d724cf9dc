#pragma once
// Error of a filtered picture, from the halves of the film and of the filtered film. Method: README.md.
#include <vector>

#include "film/film.h"

namespace lucerna::film {

/// A tile of a filtered picture; all in luminance.
struct FilteredTile {
  double luminance = 0;       ///< mean
  double standard_error = 0;  ///< of that mean: noise and bias together
  /// Half width of the interval around `luminance` that contains the truth with probability 0.9.
  double half_width_90() const { return 1.645 * standard_error; }
  double relative = 0;  ///< quadratic mean of the pixels' errors, each over the maximum of its
                        ///< luminance, that of the tile, and the floor
};

struct FilterError {
  uint32_t tiles_across = 0, tiles_down = 0;
  /// Standard error of each pixel's luminance, noise and bias together; with less than two samples, its
  /// luminance.
  std::vector<float> pixels;
  std::vector<float> luminances;    ///< luminance of each filtered pixel
  std::vector<FilteredTile> tiles;  ///< in raster order
  double luminance = 0;             ///< mean of the picture
  /// Standard errors over those that the halves of the filtered film differ by: what bias adds to noise; 1 or
  /// more. Quadratic mean over the pixels, relative to their luminance.
  double over_noise = 1;
  double rms = 0;  ///< quadratic mean of the pixels' errors
  double relative() const { return luminance > 0 ? rms / luminance : 0; }
  double tile_median = 0, tile_worst_tenth = 0;  ///< statistics of FilteredTile::relative
};

/// `filtered`: result of Filter::apply for `samples`, of equal size. `side`: side of a tile [pixels], 1 or
/// more. `luminance_floor`: minimum luminance for relative errors of tiles.
FilterError filter_error(const Image& samples, const Image& filtered, uint32_t side, double luminance_floor);

}  // namespace lucerna::film
