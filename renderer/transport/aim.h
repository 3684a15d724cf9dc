#pragma once
// Which share of the light paths is aimed at which pair of lights and caster (light_source.h), from what a
// pilot tells.
#include <span>
#include <vector>

#include "shaders/shared/scene.h"

namespace lucerna::transport {

/// Shares of strata from what the pilot's paths of each have brought to the picture; 0 is that which is not
/// aimed. By the root of it, so that what is dim where nothing else is has paths too, and with a floor: a
/// tenth of what is aimed is for all pairs alike, and three more for those that have brought anything.
/// `least_unaimed`: share that paths that are not aimed keep at least. Sums to 1.
std::vector<double> aim_shares(std::span<const double> contribution, double least_unaimed);
/// ... where aimed paths bring all that is wanted, and what they miss are chance paths to the same places;
inline constexpr double k_least_unaimed_of_caustics = 1.0 / 7;
/// ... where others bring all light but caustics;
inline constexpr double k_least_unaimed_of_all = 0.5;
/// ... and where boxes are where light from afar gets in: what comes in over walls and ground outside is
/// brought by them alone, in few paths, each of which brings more the fewer of them are sent.
inline constexpr double k_least_unaimed_from_afar = 0.6;

/// By what lights are chosen where paths are not aimed, an entry each: within a group by power, among groups
/// for a pilot half by power and half evenly (`worth` empty), and then by the root of what each light has
/// brought to the picture (`worth`, by entry), with a fifth by power, a tenth for all groups alike and
/// another fifth for those that have brought anything. So a lamp in a house has paths beside the sun, which
/// lights all that is outside.
std::vector<double> light_weights(std::span<const std::vector<uint32_t>> groups,
                                  std::span<const double> power, std::span<const double> contribution);

/// A pilot's paths, all in a round of no sample.
inline constexpr uint32_t k_pilot_paths = 1u << 14, k_pilot_paths_a_stratum = 8;
inline constexpr uint32_t k_pilot_round = 0xffffffffu;

/// Whether pilots of two frames find the same: they see the same from the same place, by the same seed.
bool same_view(const shared::Frame& a, const shared::Frame& b);

}  // namespace lucerna::transport
