#pragma once
// Which share of the light paths is aimed at which pair of lights and caster.
#include <span>
#include <vector>

namespace lucerna::photons {

/// Shares of strata from what the pilot's photons of each have brought to the picture; 0 is that which is not
/// aimed. By the root of it, so that what is dim where nothing else is has photons too, and with a floor: a
/// tenth of what is aimed is for all pairs alike, and three more for those that have brought anything.
/// `caustics_alone`: paths that are not aimed bring little else; they keep at least a seventh, and half where
/// they bring all other light. Sums to 1.
std::vector<double> aim_shares(std::span<const double> worth, bool caustics_alone);

}  // namespace lucerna::photons
