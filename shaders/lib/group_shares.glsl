// Shares of the light groups in light that is stored as a sum of all groups, channel by channel (LUCERNA_GROUP_SUMS).
#ifndef LUCERNA_LIB_GROUP_SHARES
#define LUCERNA_LIB_GROUP_SHARES
#include "shaders/shared/lanes.h"
#include "lib/math.glsl"

const uint k_group_texels = (k_group_count + 3u) / 4u;  // texels of shares: four groups each

// Shares of the channels, 0 to 1, in one word: mantissas of nine bits under one power of 2, 2^0 to 2^-31. A share of 1 is kept
// exactly, all others to within 2^-9 of the largest channel's.
uint share_pack(vec3 share) {
  share = clamp(share, 0.0, 1.0);
  uint exponent = clamp(126u - min(floatBitsToUint(max3(share)) >> 23u, 126u), 0u, 31u);
  uvec3 m = min(uvec3(round(share * uintBitsToFloat((127u + exponent) << 23u) * 511.0)), uvec3(511u));
  return m.x | m.y << 9u | m.z << 18u | exponent << 27u;
}
vec3 share_unpack(uint bits) {
  vec3 m = vec3(bits & 511u, bits >> 9u & 511u, bits >> 18u & 511u);
  return m * (uintBitsToFloat((127u - (bits >> 27u)) << 23u) / 511.0);
}
#endif
