#pragma once
// What a smaller error will cost, from the errors measured so far. Always a band: the law is extrapolated,
// and what it rests on is noisy itself.
#include <optional>
#include <span>
#include <vector>

#include "stats/ledger.h"

namespace lucerna::stats {

/// How the error of uniform sampling goes on, told from the ledger's lines.
///
/// Variance falls as 1 / N where samples are as good as independent, and faster where a well-spread sequence
/// meets something smooth, or edges of d dimensions, as N^(-1 - 1/d) (He and Wang 2015). A picture has both,
/// so that with N samples a pixel
///   error^2 = a / N + b / N^(1 + q),   a, b >= 0,  q in {1/4, 1/2, 3/4, 1}:
/// the exponent begins between 1/2 and 1 and comes to 1/2 in the end. How much is left of the second part
/// now, 1 - f, is what a forecast hangs on. All f in [0, 1] and the four q are taken for equally likely
/// before, and weighted by what the lines of the last factor of 16 of work make of them. Lines share their
/// samples: the logarithms of N error^2 at N1 < N2 are correlated with N1 / N2, a Markov chain in log N.
///
/// A line's own noise is that of a sum of squares with Entry::degrees degrees of freedom, so that few bright
/// pixels widen the band; the degrees are themselves told from those pixels, and too kind by about half where
/// tails are heavy. In three renders each of seven interiors (2048 samples a pixel) the band of 90 % held the
/// truth in 94 to 99 of 100 cases, whether it was told at 16 or at 1000 samples, for targets near and far
/// (measured on errors of the mean). Errors as seen are bounded pixel by pixel: where most of the light is
/// not met yet they fall more slowly at first than any of these laws. It cannot speak for light that no
/// sample has met.
class Outlook {
 public:
  /// Lines from this many samples a pixel on, and at least three, tell something; before they do not.
  static constexpr double k_least_samples = 16;

  explicit Outlook(const Ledger& ledger);
  /// Whether there is enough to tell anything by; the rest is only for then.
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
/// the band holds the truth in 90 of 100 cases, as Outlook says; each further sample takes what those of the
/// last half of the work have taken, give or take spread_of_pace(). Nothing before Outlook is known(), nor
/// where paths_target() is 0. What is reached already is told as the second in which it was, between two
/// lines.
std::optional<Band> seconds_to(const Ledger& ledger, double target);

/// The sum's error (Entry::sum) with so many samples a pixel, by the records of the last line; the band holds
/// it in 90 of 100 cases. Nothing before Outlook is known().
std::optional<Band> error_at(const Ledger& ledger, double samples);

/// Seconds left of work whose whole amount is an estimate that changes while the work goes on. What is said
/// does not jump with it: totals are averaged over the newer half of the work, each unit of work alike.
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
inline constexpr double k_usual_k = 1.2;  ///< where nothing is known of the picture

/// Paths of the whole adaptive render: those there are, and for every open tile those that bring its error
/// under the target and its neighbours' (`across` tiles in a row) under twice the target, within the minimum
/// and maximum; the band holds the truth in 90 of 100 cases. Nothing while an open tile has fewer than
/// Outlook::k_least_samples.
///
/// How fast tiles leave saturation is the picture's: log k is taken to be normal about log(1.2) with 0.5
/// before, and weighted by how well the law takes the tiles' earlier errors to the present ones in the mean
/// of the logarithms (deviation 0.07; once in a hundred times errors follow no law, because light is met that
/// no sample had met before, and then history says next to nothing). What a law says is itself off by 5 % and
/// 15 % of the logarithm of the growth. Of the bands told while seven interiors were rendered to 20 and to 10
/// %, 128 of 134 held the truth (with 16 samples a pixel on average 26 of 28). They do not foresee light that
/// no sample has met yet.
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
