#pragma once
// Evaluates the pilot of a picture: energy and noise of each component from a few path-traced samples.
#include "film/film.h"
#include "solvers/prospect.h"

namespace lucerna::pilot {

/// Of a picture with `samples` per pixel, half of them in each half. Sets energy and variance of the
/// components.
///
/// Variance: of one sample's luminance, from the two halves, over the squared luminance around the pixel: the
/// mean of its 8x8 block, plus a twentieth of the blocks' median, since darkness hides noise. A pixel counts
/// with at most k_most_variance, because no error of a finished picture is larger than the light itself.
inline constexpr double k_most_variance = 256;
solvers::Findings evaluate(const film::Image& image, uint32_t samples);

}  // namespace lucerna::pilot
