// Radiance of paths by slot; layout of the texels: shared/lanes.h.
#ifndef LUCERNA_LIB_RADIANCE
#define LUCERNA_LIB_RADIANCE
#include "lib/variants.glsl"
#include "shaders/shared/lanes.h"

uniform samplerBuffer radiance_texels;  // Radiance, k_lane_count (rgb; a: of the first groups_lit(), of the second the bias of lookups)

// With compact groups (LUCERNA_GROUP_SUMS): bits of the groups of which a path has light. Texels of other groups are not
// written.
uint groups_lit(uint slot) { return floatBitsToUint(texelFetch(radiance_texels, int(radiance_texel(slot, 0u))).a); }
vec3 group_light(uint slot, uint group) {
  return texelFetch(radiance_texels, int(group_texel(slot, group))).rgb;
}
#endif
