#pragma once
// How fast an error falls: slopes on log axes with their confidence, and noise and bias of pictures that were
// rendered several times with other seeds. Pure arithmetic.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solvers/photons/radius.h"

namespace lucerna::bench {

/// The power of x that y falls or grows with, by least squares on the logarithms. Nothing where fewer than
/// two points have both above 0, or all have the same x.
std::optional<double> log_slope(std::span<const double> x, std::span<const double> y);

/// Half the width of a 95 % interval in standard errors, for a standard error that is itself known from
/// `degrees` + 1 values: Student's t (Cornish-Fisher expansion; M. Abramowitz and I. Stegun 1964, 26.7.5), to
/// 3 % from two degrees on. Infinite below one.
double student_t95(size_t degrees);

/// A slope and its 95 % interval.
struct Slope {
  double value = 0, low = 0, high = 0;
};

/// One render: luminance of each pixel after each of several rounds, and an independent noisy estimate of the
/// truth (empty: no bias is measured).
struct SeedPictures {
  std::vector<std::vector<float>> after;
  std::vector<float> truth;
};

/// By round, as root mean squares over the pixels in units of their mean luminance. 0: lost in noise.
struct ErrorCurves {
  std::vector<double> noise;  ///< of one render: by how much renders differ
  std::vector<double> bias;   ///< of the mean of infinitely many renders
  std::vector<double> error;  ///< of one render against the truth
};

/// Of two renders or more. All parts are unbiased before the root is taken: the noise is the variance between
/// renders, and the squared bias the mean over all pairs of two renders of the product of their differences
/// from their own truths, in which neither their noise nor the truths' is left. `mask`: the pixels that
/// count, at least one, where not 0. `without`: the render to leave out.
ErrorCurves error_curves(std::span<const SeedPictures> renders, std::span<const uint8_t> mask,
                         std::optional<size_t> without = {});

/// Slopes of the three curves over `x` (one per picture), with jackknife intervals over renders (R. Miller
/// 1974). nullopt for a curve below the noise at a point, in whole or with a render left out, and with fewer
/// than three renders.
std::array<std::optional<Slope>, 3> error_slopes(std::span<const double> x,
                                                 std::span<const SeedPictures> renders,
                                                 std::span<const uint8_t> mask);

/// What noise and bias of rounds are expected to be.
using photons::RadiusLaw;

/// The median of values with the interval that holds the true median in at least 95 % (order statistics, by
/// the sign test; all of them where there are too few for that).
Slope median95(std::vector<double> values);

}  // namespace lucerna::bench
