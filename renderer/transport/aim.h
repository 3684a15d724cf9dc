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
/// `caustics_alone`: paths that are not aimed bring little else; they keep at least a seventh, and half where
/// they bring all other light. Sums to 1.
std::vector<double> aim_shares(std::span<const double> worth, bool caustics_alone);

/// A pilot's paths, all in a round of no sample.
inline constexpr uint32_t k_pilot_paths = 1u << 14, k_pilot_paths_a_stratum = 8;
inline constexpr uint32_t k_pilot_round = 0xffffffffu;

/// Whether pilots of two frames find the same: they see the same from the same place, by the same seed.
bool same_view(const shared::Frame& a, const shared::Frame& b);

}  // namespace lucerna::transport
