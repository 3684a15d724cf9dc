#pragma once
// Forecast of the cost of a smaller error, from the errors measured so far. Always a band: the law is
// extrapolated from noisy data.
#include <optional>
#include <span>
#include <vector>

#include "stats/ledger.h"

namespace lucerna::stats {

/// Predicts the error of uniform sampling from the ledger's entries.
///
/// Variance falls as 1 / N for independent samples, and faster where a well-distributed sequence meets
/// something smooth, or edges of d dimensions, as N^(-1 - 1/d) (He and Wang 2015). A picture has both, so
/// with N samples a pixel
///   error^2 = a / N + b / N^(1 + q),   a, b >= 0,  q in {1/4, 1/2, 3/4, 1}:
/// the exponent starts between 1/2 and 1 and ends at 1/2. The forecast depends on the remaining share of the
/// second part, 1 - f. All f in [0, 1] and the four q are equally likely a priori, and weighted by the
/// entries of the last factor of 16 of work. Entries share their samples: the logarithms of N error^2 at N1 <
/// N2 are correlated with N1 / N2, a Markov chain in log N.
///
/// The noise of an entry is that of a sum of squares with Entry::degrees degrees of freedom, so a few bright
/// pixels widen the band; the degrees are estimated from the same pixels, and too large by about half with
/// heavy tails. In three renders each of seven interiors (2048 samples a pixel) the 90 % band contained the
/// true value in 94 to 99 of 100 cases, for forecasts at 16 to 1000 samples and for near and far targets
/// (errors of the mean). Errors as seen are bounded pixel by pixel: while most of the light is not sampled
/// yet, they fall more slowly than any of these laws. Light that no sample has met cannot be predicted.
class Outlook {
 public:
  /// Entries from this many samples a pixel on, and at least three, are used.
  static constexpr double k_least_samples = 16;

  explicit Outlook(const Ledger& ledger);
  /// True if there is enough data; the other functions require it.
  bool known() const { return !laws_.empty(); }
  /// Samples a pixel, over those of the last line (>= 1), with which the error is under `target` (> 0) with
  /// the probability `wanted`, 0 < p < 1.
  double growth(double target, double wanted) const;
  /// The error that is not exceeded with the probability `wanted` when there are `growth` times the samples.
  double error(double growth, double wanted) const;
  /// -d log(error) / d log(N) now, as expected: 1/2 to 1.
  double exponent() const;

 private:
  struct Law {
    double q, share;         ///< share: f, of the part that falls as 1 / N
    double level, variance;  ///< of log(a) as if all lines were one, and its variance
    double last;             ///< log(a) by the last line alone
    double weight;
  };
  double probability(double target, double growth) const;

  std::vector<Law> laws_;
  double samples_ = 0;        ///< of the last line
  double line_variance_ = 0;  ///< of the logarithm of a line's error^2
};

/// The paths' error with which the sum's is `target` (Entry::sum), by the records of the last line; 0: what
/// records and interpolation come to is over it, and no samples will reach it.
double paths_target(const Ledger& ledger, double target);

/// Wall seconds (Entry::wall_s) from the image's start until the sum's error is `target` in uniform sampling:
/// a 90 % band, see Outlook. Further samples take as long as those of the last half of the work, within
/// spread_of_pace(). nullopt unless Outlook is known(), and if paths_target() is 0. A target already reached
/// returns the time at which it was, interpolated between two entries.
std::optional<Band> seconds_to(const Ledger& ledger, double target);

/// Error of the sum (Entry::sum) with that many samples a pixel, with the records of the last entry; a 90 %
/// band. nullopt unless Outlook is known().
std::optional<Band> error_at(const Ledger& ledger, double samples);

/// Remaining seconds of work whose total is an estimate that changes. The result does not jump with it:
/// totals are averaged over the newer half of the work, each unit with equal weight.
class WorkPace {
 public:
  static constexpr double k_least_seconds = 3, k_least_share = 0.1;
  /// `done`, `left`: units of work. Nothing until k_least_seconds and k_least_share of the work have gone by:
  /// what a unit takes is not known before. Work that is less than before, or an earlier time, is a new one.
  std::optional<double> follow(double seconds, double done, double left);

 private:
  static constexpr double k_least_rest = 0.5;  ///< of what the newest pace makes of the rest
  struct Point {
    double seconds = 0, done = 0;
  };
  std::vector<Point> points_;    ///< since the work was begun
  std::optional<double> total_;  ///< seconds from then to the end
};

/// Wall seconds that a path has taken lately: over the last half of the work, so that the first, short passes
/// do not count. 0 before there is a line.
double seconds_a_path(const Ledger& ledger);
/// By how much that differs between the last half and the last quarter of the work, as a logarithm; a
/// twentieth at least.
double spread_of_pace(const Ledger& ledger);

/// A tile as the forecast sees it.
struct TileProgress {
  double error = 0;    ///< of the paths, as the scheduler has it (film::TileError::relative)
  double goal = 0;     ///< that it is to come to, where that is not the target; 0: it is
  double samples = 0;  ///< a pixel
  double pixels = 0;
  bool open = true;  ///< still given samples
  /// The same with a half to a quarter of the samples; 0: not known.
  double earlier_error = 0, earlier_samples = 0;
};

/// Error at which the tiles' measure saturates: with few samples of rare light one half of the film holds
/// nearly all of a pixel, and the difference of the halves says no more than that.
inline constexpr double k_saturated_error = 0.63;

/// Samples a pixel at which a tile's error comes to `target`. Errors fall from saturation e0 to those of
/// independent samples,
///   1 / error^k = 1 / e0^k + (samples / s^2)^(k/2),
/// s the noise of one sample; k says how soon: about 2 where all pixels of a tile are alike, 1 and less where
/// light comes in amounts of all sizes, so that pixels leave saturation one after another.
double samples_to(const TileProgress& tile, double target, double k);
inline constexpr double k_usual_k = 1.2;  ///< without data of the picture

/// Paths of the whole adaptive render: those so far, and for every open tile those that bring its error under
/// the target and its neighbours' (`across` tiles in a row) under twice the target, within the minimum and
/// maximum; a 90 % band. nullopt while an open tile has fewer than Outlook::k_least_samples.
///
/// The exponent k at which tiles leave saturation depends on the picture: log k is normal about log(1.2) with
/// deviation 0.5 a priori, and weighted by how well the law predicts the tiles' present errors from earlier
/// ones in the mean of the logarithms (deviation 0.07; with a probability of 1 % errors follow no law,
/// because new light is met, and history has little weight). The law itself is uncertain by 5 % and 15 % of
/// the logarithm of the growth. While seven interiors were rendered to 20 and to 10 %, 128 of 134 bands
/// contained the true value (with 16 samples a pixel on average 26 of 28). Light that no sample has met
/// cannot be predicted.
std::optional<Band> total_paths(std::span<const TileProgress> tiles, uint32_t across, double target,
                                double min_samples, double max_samples);

/// What plain sampling takes, about.
struct SamplePace {
  double seconds = 0;  ///< of a sample for every pixel
  double noise = 0;    ///< relative, of the picture with one (Entry::error)
  /// Until it has that noise, which falls with the square root of the samples.
  double seconds_to(double error) const { return seconds * (noise / error) * (noise / error); }
};

}  // namespace lucerna::stats
