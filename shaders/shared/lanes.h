// Where light is summed: a lane for each light group and component. Read by C++ and GLSL.
//
// The automaton gives the component of a path, the light that it meets its group. There is one group; more of them make
// the path's radiance and the film wider, and nothing else.
#ifndef LUCERNA_SHARED_LANES_H
#define LUCERNA_SHARED_LANES_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_component_count = 4u;
LUCERNA_CONST uint k_group_count = 1u;
LUCERNA_CONST uint k_lane_count = k_group_count * k_component_count;

/// k_lane_count where there is no such component: it is summed nowhere.
LUCERNA_INLINE uint lane_of(uint group, uint component) {
  return component < k_component_count ? group * k_component_count + component : k_lane_count;
}

/// Of a path slot's radiance, in radiance_texels.
LUCERNA_INLINE uint radiance_texel(uint slot, uint lane) { return slot * k_lane_count + lane; }

LUCERNA_SHARED_END
#endif
