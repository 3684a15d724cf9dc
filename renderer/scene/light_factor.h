#pragma once
// Factors by which an edit multiplies the light of a scene.
#include <optional>
#include <vector>

#include "scene/light_groups.h"

namespace lucerna::scene {

/// Per group, the factor by which an edit multiplies its light everywhere, channel by channel (1 for groups
/// without lights). Without `groups`: one factor for all light. Defined if both scenes have the same
/// surfaces, and their lights differ in strength and colour only, within a group by the same factor. Nothing
/// otherwise, or if nothing emits. `groups`: of both scenes.
std::optional<std::vector<vec3>> light_factors(const Scene& before, const Scene& after,
                                               const LightGroups* groups = nullptr);

/// True if, up to rounding, all light of `after` is that of `before` times the factor of its group: same
/// surfaces, and lights that differ in strength and colour only. `groups`: of both scenes.
bool is_multiplied(const Scene& before, const Scene& after, const LightGroups& groups,
                   const std::vector<vec3>& factors);

/// The common factor of all groups; nothing if they differ.
std::optional<vec3> common_factor(const std::vector<vec3>& factors);

}  // namespace lucerna::scene
