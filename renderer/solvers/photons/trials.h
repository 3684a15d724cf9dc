#pragma once
// Chooses between photons and path tracing for secondary and tertiary light of the whole picture: a pilot
// tries all combinations on a small picture and takes the most efficient one (least noise times cost), after
// P. Grittmann et al., "Efficiency-Aware Multiple Importance Sampling for Bidirectional Rendering Algorithms"
// (2022).
//
// Unlike caustics (efficiency.h), light behind a diffuse surface is found by eye paths as well as by light
// paths, so both can simply be tried.
#include <array>
#include <span>
#include <vector>

#include "film/film.h"

namespace lucerna::photons {

/// One combination and its result.
struct Trial {
  uint32_t delegated = 0;  ///< components (bits) delegated to paths; photons compute the others
  uint32_t judged = 0;     ///< components (bits) that are compared, equal in all trials
  film::Image image;       ///< two samples a pixel: one in each half
  double cost = 0;         ///< of a pixel's sample, in vertices of an eye path
  /// Per component: variance here over that in the final picture.
  ByComponent<double> variance_factor = {1, 1, 1, 1};
  /// Neighbouring pixels that read the same photons and thus share their noise; at least 1.
  double pixels_in_common = 1;

  /// Set by judge(): noise times cost, relative to the first trial. 0: no light found.
  double product = 1;
};

/// Sets `product` of all trials, and returns the best: the first one, which the user has chosen, unless
/// another has less than half of its product. The margin is needed because a short pilot sees too little of
/// rare, bright paths and underestimates their noise.
///
/// Noise: variance of a pixel over the squared luminance around it: that of its 8x8 block in the trial with
/// the least, and that of the picture, so that a block which is bright by chance does not reduce its own
/// noise.
///
/// A trial that has found no light shows no variance either. All trials estimate the same light. So if a
/// trial has less than half of what another has certainly found (three standard errors below its mean), its
/// light comes from samples too rare for the pilot, and its variance is at least n times the square of the
/// missing light, n being the number of independent samples of the block. Such a trial does not determine the
/// block's brightness.
size_t judge(std::span<Trial> trials);

}  // namespace lucerna::photons
