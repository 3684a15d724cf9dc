#pragma once
// Convergence of errors: slopes on logarithmic axes with confidence intervals, and noise and bias of pictures
// from renders with different seeds. Pure arithmetic.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solvers/photons/radius.h"

namespace lucerna::bench {

/// Exponent of y as a power of x, by least squares of the logarithms. None if fewer than two points have both
/// above 0, or all have the same x.
std::optional<double> log_slope(std::span<const double> x, std::span<const double> y);

/// Half width of a 95 % interval in standard errors, for a standard error estimated from `degrees` + 1
/// values: Student's t (Cornish-Fisher expansion; M. Abramowitz and I. Stegun 1964, 26.7.5), to
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

/// Errors by round, as root mean squares over the pixels in units of their mean luminance. 0: lost in noise.
struct ErrorCurves {
  std::vector<double> noise;  ///< of one render: deviation between renders
  std::vector<double> bias;   ///< of the mean of infinitely many renders
  std::vector<double> error;  ///< of one render against the truth
};

/// Error curves of two renders or more. All parts are unbiased before the root is taken: the noise is the
/// variance between renders, the squared bias the mean over all pairs of renders of the product of their
/// differences from their own truths, which is free of both noises. `mask`: not 0 for the pixels that count,
/// at least one. `without`: omitted render.
ErrorCurves error_curves(std::span<const SeedPictures> renders, std::span<const uint8_t> mask,
                         std::optional<size_t> without = {});

/// Slopes of the three curves over `x` (one per picture), with jackknife intervals over renders (R. Miller
/// 1974). nullopt for a curve below the noise at a point, in whole or with a render left out, and with fewer
/// than three renders.
std::array<std::optional<Slope>, 3> error_slopes(std::span<const double> x,
                                                 std::span<const SeedPictures> renders,
                                                 std::span<const uint8_t> mask);

/// Expected noise and bias of rounds.
using photons::RadiusLaw;

/// The median of values with a 95 % interval of the true median (order statistics, by the sign test; all
/// values if there are too few).
Slope median95(std::vector<double> values);

}  // namespace lucerna::bench
