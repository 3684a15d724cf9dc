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
  return component < k_component_count ? group * k_component_count + component : k_no_lane;
}

// Texel of a path slot's radiance in radiance_texels: of a lane, or with compact groups of a component or of
// k_component_count + group (lib/radiance.glsl). One buffer for all: a separate buffer for groups made shading a tenth
// slower on a CPU, which waits for memory there.
uint radiance_texel(uint slot, uint lane) { return slot * k_lane_count + lane; }
#endif

LUCERNA_SHARED_END
#endif
