#pragma once
// What an edit of lights is known to do to all light, or to that of their groups.
#include <optional>
#include <vector>

#include "scene/light_groups.h"

namespace lucerna::scene {

/// What the light of each group is multiplied by everywhere, channel by channel, by index of the group (1 for
/// groups without lights); without `groups` what all light is, alone. Of two scenes with the same surfaces,
/// whose lights are the same but for strength and colour, those of a group all alike. Nothing where that
/// cannot be said, or where nothing shines. `groups`: of both.
std::optional<std::vector<vec3>> light_factors(const Scene& before, const Scene& after,
                                               const LightGroups* groups = nullptr);

/// True if all light of `after` is that of `before` times the factor of its group, but for rounding: surfaces
/// are the same, and lights are but for strength and colour. `groups`: of both.
bool is_multiplied(const Scene& before, const Scene& after, const LightGroups& groups,
                   const std::vector<vec3>& factors);

/// Of all groups alike; nothing where they differ.
std::optional<vec3> common_factor(const std::vector<vec3>& factors);

}  // namespace lucerna::scene
