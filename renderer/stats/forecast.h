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
  double error = 0;    ///< as the scheduler has it (film::TileError::relative)
  double samples = 0;  ///< a pixel
  double pixels = 0;
  bool open = true;  ///< still given samples
};

/// Error at which the tiles' measure saturates: with few samples of rare light one half of the film holds
/// nearly all of a pixel, and the difference of the halves says no more than that. Measured: 0.63 describes
/// the tiles of cornell and atrium from 8 samples on.
inline constexpr double k_saturated_error = 0.63;

/// Samples a pixel at which a tile's error comes to `target`, for independent samples:
///   1 / error^2 = samples / s^2 + 1 / k_saturated_error^2,
/// s the noise of one sample; generalized to the exponent p by raising the growth to 1 / (2 p).
double samples_to(const TileProgress& tile, double target, double exponent = 0.5);

/// Paths of the whole adaptive render: those there are, and for every open tile those that bring its error
/// under the target and its neighbours' (`across` tiles in a row) under twice the target, within the minimum
/// and maximum. The middle is the independent samples' law, which the hard tiles follow that the time goes
/// to, however the easy ones converge; fitting the exponent to a tenth of a render was worse on every scene.
/// Heavy tails are not foreseen: light that no sample has met yet raises the total above the band.
Band total_paths(std::span<const TileProgress> tiles, uint32_t across, double target, double min_samples,
                 double max_samples);

}  // namespace lucerna::stats
