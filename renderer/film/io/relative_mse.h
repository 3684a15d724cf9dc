#pragma once
// The error of a picture against two independent references, whose own noise adds nothing to it.
#include <span>
#include <vector>

#include "base/math.h"

namespace lucerna::film {

/// Two pictures of the same view with independent noise, a colour a pixel, rows from the top.
struct ReferencePair {
  uint32_t width = 0;
  std::vector<vec3> first, second;  ///< of the same size, a multiple of `width`
};

struct RelativeMseOptions {
  double epsilon = 0.01;         ///< in squared units of the pictures; > 0
  double trimmed_share = 0.001;  ///< of the pixels; 0..1
};

/// Means over the pixels of e = mean over R, G, B of (t - r1)(t - r2) / (r^2 + epsilon), t the picture, r1
/// and r2 the references and r their mean over the eight neighbours (with the pixel itself, its own noise
/// would be in the denominator, and bright errors would count more). With noise-free references it is the
/// relative mean squared error; with noisy ones it is so in expectation, because their noise is independent,
/// and it may be below 0.
struct RelativeMse {
  double all = 0;
  /// Without the `trimmed_share` of the pixels whose eight neighbours are worst by e in the mean. Were they
  /// chosen by their own e, those would go in which the noise of both references happens to point to the same
  /// side, and with references of n samples the mean would be too low by about the squared noise of one of
  /// them times that share times some ten: 1e-4 at 256 samples of an interior. As they are chosen, nothing of
  /// the references' noise is in it, and a single wild pixel stays.
  double trimmed = 0;
};

/// `picture` is as large as either reference and finite, as they are. No pixels: 0.
RelativeMse relative_mse(std::span<const vec3> picture, const ReferencePair& references,
                         const RelativeMseOptions& options = {});

/// Standard error of RelativeMse::all, in its units, from the references' own noise, estimated from their
/// difference. Pixels count as independent; rare large values make it rather too small.
double relative_mse_noise(const ReferencePair& references, const RelativeMseOptions& options = {});

struct SeenMseOptions {
  double floor = 0.05;           ///< of the picture's median luminance; > 0
  double trimmed_share = 0.001;  ///< of the pixels; 0..1
};

/// The squared error as it is seen. Means over the pixels of e = mean over R, G, B of
/// (t - r1)(t - r2) / (l + f m)^2: l is the mean luminance over 5x5 pixels (edge pixels repeat beyond the
/// edge), m the median of l over the pixels (where that is 0, their mean) and f the floor; both of the mean
/// of the references. In expectation free of the references' noise, and may come out below 0. A picture that
/// is `sqrt(e)` = 5 % off is off by a twentieth of what the eye is adapted to.
struct SeenMse {
  double all = 0;
  /// Without the `trimmed_share` of the pixels (rounded up) that differ most from a reference, over the same
  /// (l + f m)^2: fireflies do not decide. It is the mean of two such means, one for the choice by either
  /// reference: the other one's noise knows nothing of that choice, and leaves the product's mean as it is.
  double trimmed = 0;
};

/// `picture` is as large as either reference and finite, as they are. Pixels in whose 5x5 and in whose
/// picture there is no light have no scale and count as 0. No pixels: 0.
SeenMse seen_mse(std::span<const vec3> picture, const ReferencePair& references,
                 const SeenMseOptions& options = {});

/// The standard error of SeenMse::all as relative_mse_noise() is that of RelativeMse::all.
double seen_mse_noise(const ReferencePair& references, const SeenMseOptions& options = {});

/// |difference in luminance| over (l + f m) of every pixel: the picture of an error as it is seen. The
/// references' own noise is in it.
std::vector<float> seen_difference(std::span<const vec3> picture, const ReferencePair& references,
                                   const SeenMseOptions& options = {});

}  // namespace lucerna::film
