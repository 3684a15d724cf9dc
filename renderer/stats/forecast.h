#pragma once
// What a smaller error will cost, from the errors measured so far. Always a band: the law is extrapolated,
// and what it rests on is noisy itself.
#include <optional>
#include <span>

#include "stats/ledger.h"

namespace lucerna::stats {

/// error = c * work^-exponent: 1/2 for independent samples, up to about 1 for well-spread ones. `deviation`
/// is the exponent's.
struct Law {
  double exponent = 0.5, deviation = 0.1;
};

/// Fitted to the ledger's later lines (those with 8 samples a pixel and more, the last factor of 16 of work)
/// by least squares of the logarithms; without three such lines the independent samples' law. The exponent is
/// held to [0.3, 1.2].
Law fit(const Ledger& ledger, int layer = 0);

/// Seconds from the render's start until the layer's error is `target` in uniform sampling, if every second
/// goes on as the last ones did; nothing before the first line. What is reached already is told as the second
/// in which it was.
std::optional<Band> seconds_to(const Ledger& ledger, double target, int layer = 0);

/// A tile as the forecast sees it.
struct TileProgress {
  double error = 0;
  double samples = 0;                             ///< a pixel
  double earlier_error = 0, earlier_samples = 0;  ///< of about half the samples or less; 0: none
  double pixels = 0;
  bool open = true;  ///< still given samples
};

/// The exponent by which the tiles' errors have fallen, all tiles pooled.
Law fit(std::span<const TileProgress> tiles);

/// Paths of the whole adaptive render: those there are, and for every open tile those that bring its error
/// under the target and its neighbours' (`across` tiles in a row) under twice the target, within the minimum
/// and maximum.
Band total_paths(std::span<const TileProgress> tiles, uint32_t across, double target, double min_samples,
                 double max_samples);

}  // namespace lucerna::stats
