// What paths have brought, by slot: texels of which shared/lanes.h says where they lie.
#ifndef LUCERNA_LIB_RADIANCE
#define LUCERNA_LIB_RADIANCE
#include "lib/variants.glsl"
#include "shaders/shared/lanes.h"

uniform samplerBuffer radiance_texels;  // Radiance, k_lane_count (rgb; a: of the first groups_lit(), of the second the bias of lookups)

// Where groups are kept in short (LUCERNA_GROUP_SUMS): of which a path has light, a bit each. The others' texels are not written.
uint groups_lit(uint slot) { return floatBitsToUint(texelFetch(radiance_texels, int(radiance_texel(slot, 0u))).a); }
vec3 group_light(uint slot, uint group) {
  return texelFetch(radiance_texels, int(radiance_texel(slot, k_component_count + group))).rgb;
}
#endif
