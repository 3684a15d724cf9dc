#pragma once
// Two measures of error, each with its name:
// - as seen: every pixel's error relative to the light around it, with nothing visible below a floor and
//   above display white at the current exposure; defined in shaders/shared/seen_error.h. Used for
//   component errors and shares, for stopping tiles in adaptive sampling, for forecasts, and to
//   distribute work.
// - of the mean: root mean square of the pixels' luminance errors relative to the picture's mean
//   luminance. Independent of exposure; used to compare a linear picture with a reference. Few bright
//   pixels dominate it: with a window of 5 % of the pixels, 95 % of it may come from the window's edges.
//
// Parts of the error of a picture and of its tiles:
// - paths: noise of the samples, from the two independently scrambled halves of the film. Falls with
//   more samples.
// - lookup noise: noise of stored light, common to all samples that read the same of it.
// - interpolation: mean error of lookups, as an absolute value: of interpolation between stored values, and
//   of blur. Reported to the user as the bias of lookups.
// The last two are known if the film has them (Film::lookup_errors_complete(), lookup_bias_known()), and
// 0 without lookups. Their sum: base/error_sum.h. Other errors of biased solvers are not included.
//
// If lookups find nothing in any sample of a block (too few photons), the halves agree and show no
// noise. That is no evidence: such a block has an unknown error, and counts with all of its light, a
// tile as 1, the picture by the share of such pixels.
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "base/error_sum.h"
#include "film/film.h"

namespace lucerna::film {

using shared::k_luminance_floor;

/// Luminances between which a picture's errors are seen (seen_error.h); both > 0.
struct SeenRange {
  float floor = k_luminance_floor, white = 1;
  bool operator==(const SeenRange&) const = default;
};
/// Range for a picture shown with that exposure (EV) and tone curve (shared::k_tone_*).
SeenRange seen_range(double ev, uint32_t curve);

/// Errors of lookups in a mean over some blocks, in luminance; `degrees`: degrees of freedom of noise^2.
struct LookupsError {
  double noise = 0, interpolation = 0, degrees = 0;
};
LookupsError lookups_error(std::span<const shared::BlockLookups> blocks);
/// Errors of a block with the present mix of lights: proportional to its luminance, assuming equal relative
/// errors in all light groups.
shared::BlockLookups mixed_lookups(const shared::BlockLookups& lookups, const shared::BlockError& block);
/// Blur error of a mean over blocks, in luminance, as an absolute value. The halves of the film estimate it
/// independently, so the square of the root of their product (0 if their signs differ) is free of their noise
/// on average.
double blur_error(std::span<const shared::BlockError> blocks);

/// True if lookups of secondary or tertiary light have found nothing in any sample of this block.
bool without_evidence(const shared::BlockError& block);

/// Error of a tile, a square of blocks.
struct TileError {
  double pixels = 0;     ///< number of pixels with samples in both halves
  double luminance = 0;  ///< mean
  /// Standard error of that mean from the paths. Pixels are independent, so their variances add up; except
  /// see count_shared_noise().
  double standard_error = 0;
  /// Degrees of freedom of standard_error^2 by Satterthwaite: (sum v)^2 / (sum v^2 / 3), for v has one degree
  /// of freedom and so E[v^2] = 3 sigma^4. All pixels alike: their number; one that dwarfs the rest: 3.
  double degrees = 0;
  /// Stops the tile: the error as seen, limited to r (shaders/shared/film.h): quadratic mean over quadrants
  /// of 4x4 pixels of their mean errors. A single firefly, whose r is at most 1.26, adds at most 2 % to a
  /// tile of 16x16 pixels and does not keep it open; one difficult corner counts for more than its area, but
  /// does not decide alone. The noise of this value falls with the number of pixels, so it is reliable from
  /// pass to pass.
  double relative = 0;
  double variance = 0, fourth = 0;  ///< sums of v and v^2, from which the two above come
  double difference = 0;            ///< half of the difference of `luminance` in the film's two halves
  /// Errors of the mean. Pixels that read the same stored light have correlated errors.
  LookupsError lookups;
  /// Root mean squares over the pixels of the lookup errors, relative as in `relative`.
  double relative_lookup_noise = 0, relative_interpolation = 0;
  /// Sum of the three relative ones: the estimated error of the tile.
  double relative_sum() const { return error_sum(relative, relative_lookup_noise, relative_interpolation); }
  bool unknown = false;  ///< a block is without_evidence(); `relative` is then at least 1
  /// Set by mark_heavy_tails(): the interval below is not valid for this noise.
  bool heavy_tailed = false;

  /// Half width of the interval around `luminance` that holds the truth with probability 0.9: of both noises
  /// by Student's t, with their degrees of freedom by Satterthwaite, and interpolation's part.
  double half_width_90() const;
};
/// `lookups`: of the same blocks, or empty. LookupsError::interpolation combines the errors of interpolation
/// and of blur in quadrature, as their signs are independent.
TileError tile_error(std::span<const shared::BlockError> blocks,
                     std::span<const shared::BlockLookups> lookups = {});

/// Only TileError::relative, relative_lookup_noise and relative_interpolation, from these blocks of
/// film.errors().
struct RelativeError {
  double paths = 0, lookup_noise = 0, interpolation = 0;
};
RelativeError relative_error(const Film& film, std::span<const uint32_t> blocks);

/// For tiles, `across` in a row, whose pixels have common noise: nearby pixels read the same photons of a
/// round, so the noise of a tile's mean exceeds what its pixels' variances imply, by the number of pixels
/// that share data. That factor is estimated as the square of TileError::difference, whose mean is the
/// variance of the mean, over the variance implied by TileError::variance; averaged over the tile and two
/// rings of tiles around it, and at least 1. standard_error is multiplied by its root, and `degrees` is set
/// for this estimate.
void count_shared_noise(std::span<TileError> tiles, uint32_t across);

/// The tiles of a film, `side` pixels (8 or 16) along each side, in raster order, from film.errors(); with
/// count_shared_noise() where photons are read (film.lookup_bias_known()).
std::vector<TileError> tile_errors(const Film& film, uint32_t side);

/// Marks the tiles, `across` in a row, whose light comes in rare large amounts (caustics, fireflies): few
/// pixels cause most of the noise (degrees below an eighth of the pixels) of the tile itself, or of it and
/// its eight neighbours together, each relative to its own luminance. Neighbours count because a calm tile
/// among fireflies has not received its own yet: at 64 samples of scenes/glass the intervals of such tiles
/// contain the truth in one case of five.
void mark_heavy_tails(std::span<TileError> tiles, uint32_t across, double luminance_floor);

/// Distribution of the errors as seen of a picture's tiles; ImageError::seen() is their mean over the
/// picture.
struct TileSpread {
  double median = 0;       ///< error of the median tile
  double worst_tenth = 0;  ///< error that a tenth of the tiles exceed
  double worst = 0;
  size_t heavy_tailed = 0;  ///< number of marked tiles
};
/// Distribution of TileError::relative_sum(), or of one of its parts or a function; all 0 without tiles.
TileSpread tile_spread(std::span<const TileError> tiles,
                       const std::function<double(const TileError&)>& of = &TileError::relative_sum);

/// Noise of a layer by path expression. Its lookups' errors are not known.
struct LayerError {
  double luminance = 0;  ///< mean
  double rms = 0;        ///< as in ImageError
  double seen_rms = 0;   ///< likewise: relative to the light of the whole picture, as seen
};

/// Error of a whole picture; [0]: sum of the components, [1..4]: components.
struct ImageError {
  double pixels = 0;
  std::array<double, 5> luminance{};  ///< mean
  std::array<double, 5> rms{};        ///< root mean square of the pixels' standard errors, in luminance
  /// Degrees of freedom of rms[0]^2, as TileError::degrees: its relative standard error is sqrt(2 / degrees),
  /// if the samples represent its noise.
  double degrees = 0;
  /// Likewise, from the errors of lookups in each pixel; of the sum.
  double lookup_noise_rms = 0, interpolation_rms = 0;
  double unknown = 0;  ///< share of the pixels in blocks without_evidence()

  /// Root mean squares over the pixels of the errors as seen, of the sum and of the components.
  std::array<double, 5> seen_rms{};
  double seen_degrees = 0;  ///< degrees of freedom of seen_rms[0]^2
  double seen_lookup_noise = 0,
         seen_interpolation = 0;   ///< like lookup_noise_rms and interpolation_rms, as seen
  double white = 0, dark = 0;      ///< shares of pixels not below white, and below the floor
  std::vector<LayerError> layers;  ///< by path expressions; image_error() leaves it empty

  /// The error as seen of a component or the sum; in the sum, pixels of unknown error count with all of their
  /// light.
  double seen(int layer) const {
    const double known = seen_rms[size_t(layer)];
    return layer == 0 ? std::sqrt(known * known + unknown) : known;
  }
  /// Including lookups: the reported error of the picture.
  double seen_sum() const { return error_sum(seen(0), seen_lookup_noise, seen_interpolation); }
  /// A component's share of the noise, 0..1 for component 0..3: its squared error as seen over the sum of
  /// all components'. They add up to 1, or are all 0 where there is no noise.
  double share(int component) const;

  /// The error of the mean: rms over the mean luminance of the sum; in the sum, pixels of unknown error count
  /// with the mean luminance.
  double relative(int layer) const {
    const double known = luminance[0] > 0 ? rms[size_t(layer)] / luminance[0] : 0;
    return layer == 0 ? std::sqrt(known * known + unknown) : known;
  }
  double relative(const LayerError& layer) const { return luminance[0] > 0 ? layer.rms / luminance[0] : 0; }
  double relative_lookup_noise() const { return luminance[0] > 0 ? lookup_noise_rms / luminance[0] : 0; }
  double relative_interpolation() const { return luminance[0] > 0 ? interpolation_rms / luminance[0] : 0; }
  /// Combined relative error of all three parts.
  double relative_sum() const {
    return error_sum(relative(0), relative_lookup_noise(), relative_interpolation());
  }
};
ImageError image_error(std::span<const shared::BlockError> blocks);

/// Of the k_error_layers layers of such blocks (Film::layer_errors).
std::array<LayerError, shared::k_error_layers> layer_errors(std::span<const shared::BlockError> blocks);

/// The value t with P(|T| < t) = 0.9 for Student's T with that many degrees of freedom, which need not be
/// whole; within 1 % for 1 or more.
double student_90(double degrees);

}  // namespace lucerna::film
