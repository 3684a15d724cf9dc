#pragma once
// Where photons are worth their time for caustics: where counting them has less noise for its time than
// following paths from the eye until these happen to meet the light.
//
// Of both ways a pilot tells the second moment of one sample, after P. Grittmann et al., "Efficiency-Aware
// Multiple Importance Sampling for Bidirectional Rendering Algorithms" (2022): any path that one technique
// has found tells of all others' moments, by what they would have made of it. So light paths alone, which
// find caustics well, tell how rarely and how bright paths from the eye would find them. Regions of the
// picture are then chosen so that noise times cost of the whole is least.
#include <span>
#include <vector>

#include "shaders/shared/photons/photons.h"

namespace lucerna::photons {

/// What is done costs, in units of a vertex of a path from the eye with its light sample: measured on
/// `glass`, `teapot` and `atrium` with lavapipe, to a fifth. A pixel's sample without caustics; what is
/// traced on for other light; following a path on for caustics alone; a lookup; a light path with its
/// photons.
inline constexpr double k_cost_base = 2, k_cost_tail = 3, k_cost_onward = 0.4, k_cost_lookup = 2,
                        k_cost_light_path = 1.5;
/// Of a picture that is waited for: radii fall slowly.
inline constexpr uint32_t k_typical_round = 16;

/// In those units.
struct EfficiencyCosts {
  double base = 0;    ///< a pixel's sample, whatever brings its caustics
  double lookup = 0;  ///< of photons, beside that; spared where paths bring caustics
  double onward = 0;  ///< following a path on for caustics alone; 0: it goes on anyway
  double paths = 0;   ///< light paths of a round, a pixel; 0: they are sent anyway
};

/// What is known of the pilot and of the rounds to come.
struct EfficiencyPilot {
  std::span<const shared::PhotonLookup> lookups;  ///< a pixel each, row by row; carried 0: none
  uint32_t width = 0, height = 0;                 ///< of that picture
  std::span<const shared::PhotonContribution> photons;
  std::span<const double> gain;  ///< a photon each: how likely its path is in a round, over in the pilot
  double paths = 0;              ///< paths of a round over those of the pilot
  shared::PhotonFrame around{};  ///< within whose radii photons are counted here ...
  shared::PhotonFrame round{};   ///< ... and within which rounds will count them
};

/// Of one place: the mean of what one sample brings of caustics, and the variance of that, in luminance.
struct Moments {
  double mean = 0, photons = 0, paths = 0;
  uint32_t found = 0;  ///< photons of the pilot that tell of it
};
/// One a lookup, 0 where there is none.
std::vector<Moments> caustic_moments(const EfficiencyPilot& pilot);

/// What is known of a region and its neighbours: means over their pixels.
struct Region {
  double mean = 0, photons = 0, paths = 0;  ///< as Moments
  double weight = 0;                        ///< what a variance counts, which is relative
  double found = 0;                         ///< photons that a lookup has found
};

struct Regions {
  uint32_t width = 0, height = 0;
  std::vector<Region> all;
  std::vector<float> delegated;  ///< share of samples in which paths bring caustics: 0 or 1, row by row
  bool nowhere = false;          ///< photons: all are left
  bool scarce = false;           ///< the pilot has found too few photons to say anything
  double by_photons = 1;         ///< share of the picture
  double gain = 1;               ///< of efficiency, over photons everywhere; as the pilot sees it
};
/// `moments`: of a picture of width x height pixels. Regions are of 2x2 of these, each judged with its eight
/// neighbours; where a lookup has found few photons, paths have it. `moments` are of light that paths find.
Regions choose_regions(std::span<const Moments> moments, uint32_t width, uint32_t height,
                       const EfficiencyCosts& costs);

}  // namespace lucerna::photons
