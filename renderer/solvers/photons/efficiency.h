#pragma once
// Chooses where photons are more efficient than path tracing for caustics (less variance × time).
//
// A pilot estimates the second moment of one sample of both techniques, after P. Grittmann et al.,
// "Efficiency-Aware Multiple Importance Sampling for Bidirectional Rendering Algorithms" (2022): a path found
// by one technique provides the moments of all others, from the contribution that they would have given it.
// Light paths, which find caustics well, thus show how rarely and how bright eye paths would find them.
// Regions of the picture are then chosen to minimize noise times cost of the whole.
#include <span>
#include <vector>

#include "shaders/shared/photons/photons.h"

namespace lucerna::photons {

/// Costs in units of an eye path's vertex with its light sample, measured on `glass`, `teapot` and `atrium`
/// with lavapipe, within a fifth: a pixel's sample without caustics; continuing a path for other light;
/// continuing it for caustics only; a lookup; a light path with its photons.
inline constexpr double k_cost_base = 2, k_cost_tail = 3, k_cost_onward = 0.4, k_cost_lookup = 2,
                        k_cost_light_path = 1.5;
/// Round of a typical finished picture: radii fall slowly.
inline constexpr uint32_t k_typical_round = 16;

/// In these units.
struct EfficiencyCosts {
  double base = 0;    ///< of a pixel's sample without its caustics
  double lookup = 0;  ///< additional cost of a photon lookup
  double onward = 0;  ///< of continuing a path for caustics only; 0: it continues anyway
  double paths = 0;   ///< of light paths, per pixel and round; 0: they are traced anyway
};

/// Results of the pilot, and parameters of later rounds.
struct EfficiencyPilot {
  std::span<const shared::PhotonLookup> lookups;  ///< one per pixel, row by row; carried 0: none
  uint32_t width = 0, height = 0;                 ///< of the pilot's picture
  std::span<const shared::PhotonContribution> photons;
  std::span<const double> gain;  ///< per photon: probability of its path in a round over that in the pilot
  double paths = 0;              ///< paths of a round over those of the pilot
  shared::PhotonFrame around{};  ///< radii for counting photons in the pilot ...
  shared::PhotonFrame round{};   ///< ... and in rounds
};

/// Caustics at one place: mean of one sample, and its variance with either technique, in luminance.
struct Moments {
  double mean = 0, photons = 0, paths = 0;
  uint32_t found = 0;  ///< pilot photons used for it
};
/// One per lookup; 0 without a lookup.
std::vector<Moments> caustic_moments(const EfficiencyPilot& pilot);

/// Means over the pixels of a region and its neighbours.
struct Region {
  double mean = 0, photons = 0, paths = 0;  ///< as Moments
  double weight = 0;                        ///< weight of a variance: relative to the brightness
  double found = 0;                         ///< photons found per lookup
};

struct Regions {
  uint32_t width = 0, height = 0;
  std::vector<Region> all;
  std::vector<float> delegated;  ///< share of samples whose caustics paths compute: 0 or 1, row by row
  bool nowhere = false;          ///< photons compute no region
  bool scarce = false;           ///< the pilot found too few photons for a decision
  double by_photons = 1;         ///< share of the picture
  double gain = 1;               ///< estimated efficiency gain over photons everywhere
};
/// `moments`: of a picture of width x height pixels. Regions are 2x2 pixels, each judged with its eight
/// neighbours; regions with few photons are delegated to paths. `moments` must only contain light that paths
/// can find.
Regions choose_regions(std::span<const Moments> moments, uint32_t width, uint32_t height,
                       const EfficiencyCosts& costs);

}  // namespace lucerna::photons
