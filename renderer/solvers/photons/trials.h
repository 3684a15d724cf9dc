#pragma once
// Whether photons are worth their time for secondary and tertiary light of the whole picture: a pilot tries
// the ways that there are on a small one, and the one with the least noise times cost is taken, after
// P. Grittmann et al., "Efficiency-Aware Multiple Importance Sampling for Bidirectional Rendering
// Algorithms" (2022).
//
// Unlike caustics (worth.h) light that has met a diffuse surface before is found by paths from the eye as
// well as by those from lights, so that both can simply be tried.
#include <array>
#include <span>
#include <vector>

#include "film/film.h"

namespace lucerna::photons {

/// One way, and what came of it.
struct Trial {
  uint32_t delegated = 0;  ///< components (bits) that paths from the eye bring in it; the others: photons
  uint32_t judged = 0;     ///< components (bits) that are compared, the same in all trials
  film::Image image;       ///< two samples a pixel: one in each half
  double cost = 0;         ///< of a pixel's sample, in vertices of a path from the eye
  /// By how much the variance of each component is less in the picture to come than here.
  std::array<double, film::k_components> variance_factor = {1, 1, 1, 1};
  /// Neighbouring pixels that read the same photons, and so have their noise in common; at least 1.
  double pixels_in_common = 1;

  /// Set by judge(): noise times cost, over that of the first trial. 0: nothing was found.
  double product = 1;
};

/// Sets `product` of all, and returns which is the best: the first one, which a person has asked for, unless
/// another has less than half of its product. For a pilot sees too little of rare and bright paths, and so
/// takes what is found by chance for better than it is.
///
/// Noise is the variance of a pixel over the square of the luminance around (of its block of 8x8 pixels, in
/// that trial which has the least, and of the picture), so that what is bright by chance does not excuse
/// itself.
///
/// A trial that has found nothing shows no variance either. All trials estimate the same light; so where one
/// has less than half of what another one has certainly found (three standard errors below its mean), its
/// light comes by samples too rare to be met by so few, and its variance is at least n times the square of
/// what is missing, n: independent samples of the block. Such a trial does not say how bright the block is.
size_t judge(std::span<Trial> trials);

}  // namespace lucerna::photons
