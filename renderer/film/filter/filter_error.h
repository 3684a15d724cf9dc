#pragma once
// How wrong a filtered picture is, from the halves of the film and of the filtered film. README.md.
#include <vector>

#include "film/film.h"

namespace lucerna::film {

/// A tile of a filtered picture; all in luminance.
struct FilteredTile {
  double luminance = 0;       ///< mean
  double standard_error = 0;  ///< of that mean: noise and bias together
  /// Half width of the interval around `luminance` that holds the truth with probability 0.9.
  double half_width_90() const { return 1.645 * standard_error; }
  double relative = 0;  ///< quadratic mean of the pixels' errors, each over the maximum of its
                        ///< luminance, the tile's, and the floor
};

struct FilterError {
  uint32_t tiles_across = 0, tiles_down = 0;
  /// Of each pixel: standard error of its luminance, noise and bias together. With less than two samples: its
  /// own luminance.
  std::vector<float> pixels;
  std::vector<float> luminances;    ///< of each pixel of the filtered picture
  std::vector<FilteredTile> tiles;  ///< in raster order
  double luminance = 0;             ///< mean of the picture
  double rms = 0;                   ///< of the picture, in the quadratic mean over its pixels
  double relative() const { return luminance > 0 ? rms / luminance : 0; }
  double tile_median = 0, tile_worst_tenth = 0;  ///< of FilteredTile::relative
};

/// `filtered`: what Filter::apply has made of `samples`; of one size. `side`: of a tile [pixels], 1 or more.
/// `luminance_floor`: tiles that are darker are compared with this.
FilterError filter_error(const Image& samples, const Image& filtered, uint32_t side, double luminance_floor);

}  // namespace lucerna::film
