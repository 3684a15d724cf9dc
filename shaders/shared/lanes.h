// Lanes of radiance: one for each light group and component. Read by C++ and GLSL.
//
// The automaton provides the component of a path, the light it meets its group. The number of groups is compiled in
// (LUCERNA_LIGHT_GROUPS; less than 2: groups are not separate); more groups enlarge path radiance and film. With compact
// groups (LUCERNA_GROUP_SUMS) light is summed twice: by component over all groups, and by group over all components.
#ifndef LUCERNA_SHARED_LANES_H
#define LUCERNA_SHARED_LANES_H
#include "shaders/shared/compat.h"
#ifndef LUCERNA_LIGHT_GROUPS
#define LUCERNA_LIGHT_GROUPS 0
#endif
#ifndef LUCERNA_GROUP_SUMS
#define LUCERNA_GROUP_SUMS 0
#endif
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_component_count = 4u;
LUCERNA_CONST uint k_component_none = k_component_count;  ///< in packed tables: no component
LUCERNA_CONST uint k_ends_on_diffuse = 1u << 31;          ///< bit of a packed table (paths/automaton.h, pack())
LUCERNA_CONST uint k_all_components = (1u << k_component_count) - 1u;  ///< a bit each
LUCERNA_INLINE bool is_component(uint c) { return c < k_component_count; }
LUCERNA_CONST uint k_most_groups = 16u;

#ifndef __cplusplus
const uint k_group_count = LUCERNA_LIGHT_GROUPS > 1 ? LUCERNA_LIGHT_GROUPS : 1;
const uint k_no_lane = k_group_count * k_component_count;  // no lane: light is not summed
#if LUCERNA_GROUP_SUMS
const uint k_lane_count = k_component_count + k_group_count;
#else
const uint k_lane_count = k_no_lane;
#endif

// k_no_lane if there is no such component.
uint lane_of(uint group, uint component) {
  return is_component(component) ? group * k_component_count + component : k_no_lane;
}

uint component_of_lane(uint lane) { return lane % k_component_count; }
uint group_of_lane(uint lane) { return lane / k_component_count; }

// Texel of a path slot's radiance in radiance_texels: of a lane; with compact groups of a component, and of
// a group behind these (lib/radiance.glsl). One buffer for all: a separate buffer for groups made shading a tenth slower on a
// CPU, which waits for memory there.
uint radiance_texel(uint slot, uint lane) { return slot * k_lane_count + lane; }
uint group_texel(uint slot, uint group) { return radiance_texel(slot, k_component_count + group); }
#endif

LUCERNA_SHARED_END
#ifdef __cplusplus
#include <array>
namespace lucerna {
/// A value for each component, in the order of paths::k_component_names.
template <class T>
using ByComponent = std::array<T, shared::k_component_count>;
/// Their numbers, for loops.
inline constexpr ByComponent<uint32_t> k_components = {0, 1, 2, 3};
}  // namespace lucerna
#endif
#endif
