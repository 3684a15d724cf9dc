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
// - records: noise of records, common to all samples that read them.
// - interpolation: mean error of lookups, as an absolute value: constant between records; for photons,
//   the blur of their discs. Reported to the user as the bias of lookups.
// The last two are known if the film has them (Film::record_errors_complete(), lookup_bias_known()), and
// 0 without lookups. Their sum: base/error_sum.h. Other errors of biased solvers are not included.
//
// If lookups find nothing in any sample of a block (too few photons), the halves agree and show no
// noise. That is no evidence: such a block has an unknown error, and counts with all of its light, a
// tile as 1, the picture by the share of such pixels.
#include <array>
#include <cmath>
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
/// Of a picture that is shown with that exposure (EV) and tone curve (shared::k_tone_*).
SeenRange seen_range(double ev, uint32_t curve);

/// What lookups make of a mean over some blocks, in luminance; degrees: of freedom of noise^2.
struct RecordsError {
  double noise = 0, interpolation = 0, degrees = 0;
};
RecordsError records_error(std::span<const shared::BlockRecords> blocks);
/// Of a block, as its light is mixed: in proportion to its luminance, as if records erred in the light of
/// every group alike.
shared::BlockRecords mixed_records(const shared::BlockRecords& records, const shared::BlockError& block);
/// Blur error of a mean over blocks, in luminance, as an absolute value. The halves of the film estimate it
/// independently, so the square of the root of their product (0 if their signs differ) is free of their noise
/// on average.
double blur_error(std::span<const shared::BlockError> blocks);

/// True if lookups of secondary or tertiary light have found nothing in any sample of this block.
bool without_evidence(const shared::BlockError& block);

/// Of a tile: some blocks that lie together.
struct TileError {
  double pixels = 0;     ///< with samples in both halves
  double luminance = 0;  ///< mean
  /// Of that mean by the paths: pixels are independent, so their variances add up; but see
  /// count_shared_noise().
  double standard_error = 0;
  /// Degrees of freedom of standard_error^2 by Satterthwaite: (sum v)^2 / (sum v^2 / 3), for v has one degree
  /// of freedom and so E[v^2] = 3 sigma^4. All pixels alike: their number; one that dwarfs the rest: 3.
  double degrees = 0;
  /// What stops the tile: the error as seen, limited to r (shaders/shared/film.h), in the mean over each
  /// quadrant of 4x4 pixels of a block, and of these the quadratic mean. A lone firefly, whose r is at
  /// most 1.26, adds 2 % to a tile of 16x16 pixels whatever its size and does not hold it; one hard corner
  /// counts for more than its area, but does not decide alone. Its own noise falls with the number of pixels,
  /// so that it can be trusted from one pass to the next.
  double relative = 0;
  double variance = 0, fourth = 0;  ///< sums of v and v^2, from which the two above come
  double difference = 0;            ///< of `luminance` in the film's two halves, half of it
  RecordsError records;             ///< of the mean: pixels that read the same records err together
  /// Root mean squares over the pixels of the lookup errors, relative as in `relative`.
  double relative_records = 0, relative_interpolation = 0;
  /// Sum of the three relative ones: the estimated error of the tile.
  double relative_sum() const { return error_sum(relative, relative_records, relative_interpolation); }
  bool unknown = false;  ///< a block of it is without_evidence(); `relative` is then 1 at least
  /// Set by mark_heavy_tails(): the noise is not of a kind that the interval below can speak for.
  bool heavy_tailed = false;

  /// Half width of the interval around `luminance` that holds the truth with probability 0.9: of both noises
  /// by Student's t, with their degrees of freedom by Satterthwaite, and interpolation's part.
  double half_width_90() const;
};
/// `records`: of the same blocks, or none. RecordsError::interpolation is that of records and the blur, whose
/// signs have nothing to do with each other, in quadrature.
TileError tile_error(std::span<const shared::BlockError> blocks,
                     std::span<const shared::BlockRecords> records = {});

/// TileError::relative, relative_records and relative_interpolation alone, of these blocks of film.errors().
struct RelativeError {
  double paths = 0, records = 0, interpolation = 0;
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

/// Marks the tiles, `across` in a row, whose light comes in rare large amounts (caustics, fireflies): where
/// few pixels make up the noise (degrees below an eighth of the pixels) of the tile itself, or of it and its
/// eight neighbours together, each relative to its own luminance. The neighbours count, for a tile among
/// fireflies that looks calm has not met its own yet: at 64 samples of scenes/glass the intervals of such
/// calm tiles hold the truth in one case of five.
void mark_heavy_tails(std::span<TileError> tiles, uint32_t across, double luminance_floor);

/// How the errors of a picture's tiles, as seen, spread: where ImageError::seen() is a mean over the picture,
/// these say how its best and its worst parts look.
struct TileSpread {
  double median = 0;       ///< of the median tile
  double worst_tenth = 0;  ///< what a tenth of the tiles are over
  double worst = 0;
  size_t heavy_tailed = 0;  ///< tiles that are marked so
};
/// Of TileError::relative_sum(), or of one of its parts; all 0 where there are no tiles.
TileSpread tile_spread(std::span<const TileError> tiles);
TileSpread tile_spread(std::span<const TileError> tiles, double TileError::*part);

/// Of a whole picture; [0] the sum of the components, [1..4] they.
struct ImageError {
  double pixels = 0;
  std::array<double, 5> luminance{};  ///< mean
  std::array<double, 5> rms{};        ///< of the pixels' standard errors, in luminance
  /// Degrees of freedom of rms[0]^2, as TileError::degrees: its relative standard error is sqrt(2 / degrees),
  /// if the samples represent its noise.
  double degrees = 0;
  /// Of the sum: the same of what records make of each pixel.
  double records_rms = 0, interpolation_rms = 0;
  double unknown = 0;  ///< share of the pixels that lie in blocks without_evidence()

  /// Root mean squares over the pixels of the errors as seen, of the sum and of the components.
  std::array<double, 5> seen_rms{};
  double seen_degrees = 0;                          ///< of freedom of seen_rms[0]^2, as `degrees`
  double seen_records = 0, seen_interpolation = 0;  ///< as records_rms and interpolation_rms, as seen
  double white = 0, dark = 0;  ///< shares of the pixels that are no darker than white, darker than the floor

  /// The error as seen. Of the sum, with pixels of unknown error counted as wrong by all of their light.
  double seen(int layer) const {
    const double known = seen_rms[size_t(layer)];
    return layer == 0 ? std::sqrt(known * known + unknown) : known;
  }
  /// Including lookups: the reported error of the picture.
  double seen_sum() const { return error_sum(seen(0), seen_records, seen_interpolation); }
  /// A component's share of the noise, 0..1 for component 0..3: its squared error as seen over the sum of
  /// all components'. They add up to 1, or are all 0 where there is no noise.
  double share(int component) const;

  /// The error of the mean: rms over the sum's mean luminance. Of the sum, with pixels of unknown error
  /// counted as wrong by the mean luminance.
  double relative(int layer) const {
    const double known = luminance[0] > 0 ? rms[size_t(layer)] / luminance[0] : 0;
    return layer == 0 ? std::sqrt(known * known + unknown) : known;
  }
  double relative_records() const { return luminance[0] > 0 ? records_rms / luminance[0] : 0; }
  double relative_interpolation() const { return luminance[0] > 0 ? interpolation_rms / luminance[0] : 0; }
  /// Of the three.
  double relative_sum() const { return error_sum(relative(0), relative_records(), relative_interpolation()); }
};
ImageError image_error(std::span<const shared::BlockError> blocks);

/// The value t with P(|T| < t) = 0.9 for Student's T with that many degrees of freedom, which need not be
/// whole; within 1 % for 1 or more.
double student_90(double degrees);

}  // namespace lucerna::film
