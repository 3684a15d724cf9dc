#pragma once
// Error of a picture relative to two independent references, without the references' own noise.
#include <span>
#include <vector>

#include "base/math.h"

namespace lucerna::film {

/// Two pictures of the same view with independent noise, a colour a pixel, rows from the top.
struct ReferencePair {
  uint32_t width = 0;
  std::vector<vec3> first, second;  ///< of equal size, a multiple of `width`
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
  /// Without the `trimmed_share` of the pixels whose eight neighbours have the largest mean e. A choice by
  /// the pixels' own e would remove those in which the noise of both references happens to agree, and the
  /// mean would be too low by about ten times that share times the squared noise of one reference: 1e-4 at
  /// 256 samples of an interior. This choice is independent of the references' noise, but keeps a single
  /// outlier.
  double trimmed = 0;
};

/// `picture` is as large as either reference, all finite. No pixels: 0.
RelativeMse relative_mse(std::span<const vec3> picture, const ReferencePair& references,
                         const RelativeMseOptions& options = {});

/// Standard error of RelativeMse::all, in its units, from the references' own noise, estimated from their
/// difference. Pixels count as independent; with rare large values it is too small.
double relative_mse_noise(const ReferencePair& references, const RelativeMseOptions& options = {});

struct SeenMseOptions {
  double floor = 0.05;           ///< over the picture's median luminance; > 0
  double trimmed_share = 0.001;  ///< of the pixels; 0..1
};

/// The squared error as seen. Means over the pixels of e = mean over R, G, B of (t - r1)(t - r2) / (l + f
/// m)^2: l is the mean luminance over 5x5 pixels (edge pixels repeat beyond the edge), m the median of l over
/// the pixels (if 0, their mean) and f the floor; both of the mean of the references. Its expectation is free
/// of the references' noise; values may be below 0. At `sqrt(e)` = 5 % the error is a twentieth of the
/// luminance to which the eye is adapted.
struct SeenMse {
  double all = 0;
  /// Without the `trimmed_share` of the pixels (rounded up) with the largest difference from a reference,
  /// over the same (l + f m)^2, so that fireflies do not dominate. Mean of two such means, with the choice by
  /// either reference: the noise of the other one is independent of the choice, so the expected product is
  /// unchanged.
  double trimmed = 0;
};

/// `picture` is as large as either reference, all finite. Pixels have no scale and count as 0 if neither
/// their 5x5 neighbourhood nor the picture has light. No pixels: 0.
SeenMse seen_mse(std::span<const vec3> picture, const ReferencePair& references,
                 const SeenMseOptions& options = {});

/// Standard error of SeenMse::all, like relative_mse_noise().
double seen_mse_noise(const ReferencePair& references, const SeenMseOptions& options = {});

/// |difference in luminance| over (l + f m) of every pixel: the picture of the error as seen, including the
/// references' own noise.
std::vector<float> seen_difference(std::span<const vec3> picture, const ReferencePair& references,
                                   const SeenMseOptions& options = {});

}  // namespace lucerna::film
