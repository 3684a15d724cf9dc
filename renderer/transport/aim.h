#pragma once
// Shares of light paths aimed at each pair of lights and caster (light_source.h), from a pilot's
// contributions.
#include <span>
#include <vector>

#include "shaders/shared/scene.h"

namespace lucerna::transport {

/// Shares of strata from the contributions of the pilot's paths; stratum 0 is unaimed. Proportional to their
/// square root, so that dim regions get paths too, with a floor: a tenth of the aimed paths is spread over
/// all pairs, and three more tenths over those with a contribution. `least_unaimed`: minimum unaimed share.
/// The sum is 1.
std::vector<double> aim_shares(std::span<const double> contribution, double least_unaimed);
/// ... if aimed paths find all wanted light, and unaimed ones add chance paths to the same places;
inline constexpr double k_least_unaimed_of_caustics = 1.0 / 7;
/// ... if unaimed paths find all light but caustics;
inline constexpr double k_least_unaimed_of_all = 0.5;
/// ... and if boxes are entrances of distant light: only unaimed paths find light that enters over walls and
/// ground outside, and each of them contributes more the fewer there are.
inline constexpr double k_least_unaimed_from_afar = 0.6;

/// Probabilities of lights for unaimed paths, one per entry. Within a group by power. Among groups: for a
/// pilot (`contribution` empty) half by power and half uniform; then by the square root of each group's
/// contribution to the picture (`contribution`, by entry), with a fifth by power, a tenth uniform and another
/// fifth uniform over groups with a contribution. Thus a lamp in a house gets paths beside the sun, which
/// lights everything outside.
std::vector<double> light_weights(std::span<const std::vector<uint32_t>> groups,
                                  std::span<const double> power, std::span<const double> contribution);

/// Paths of a pilot, all in one round that belongs to no sample.
inline constexpr uint32_t k_pilot_paths = 1u << 14, k_pilot_paths_a_stratum = 8;
/// ... and of one that aims at a wide ground: about one in a hundred of its paths goes from there through an
/// opening, so a smaller pilot misses that light, and its strata get only the floor of aim_shares().
inline constexpr uint32_t k_ground_pilot_paths_a_stratum = 1u << 12, k_most_ground_pilot_paths = 1u << 18;
inline constexpr uint32_t k_pilot_round = 0xffffffffu;

/// True if pilots of two frames give the same result: equal view and seed.
bool same_view(const shared::Frame& a, const shared::Frame& b);

}  // namespace lucerna::transport
