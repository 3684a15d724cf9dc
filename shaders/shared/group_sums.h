// Compact light of groups (GroupSum): three 18-bit mantissas and one exponent in 64 bits. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_GROUP_SUMS_H
#define LUCERNA_SHARED_GROUP_SUMS_H
#include "shaders/shared/film.h"
LUCERNA_SHARED_BEGIN
#ifdef __cplusplus
using glm::uintBitsToFloat;
#endif

LUCERNA_CONST uint k_group_sum_bits = 18u;  ///< of a mantissa

/// The float 2^n has the bits (n + 127) << 23: stored as the exponent, 1 to 237; 0 for no light.
LUCERNA_INLINE uint group_sum_exponent(GroupSum s) { return s.high >> 22u; }
LUCERNA_INLINE uvec3 group_sum_mantissas(GroupSum s) {
  return uvec3(s.low & 0x3ffffu, s.low >> 18u | (s.high & 0xfu) << 14u, s.high >> 4u & 0x3ffffu);
}
LUCERNA_INLINE GroupSum group_sum(uvec3 mantissas, uint exponent) {
  GroupSum s;
  s.low = mantissas.x | mantissas.y << 18u;
  s.high = mantissas.y >> 14u | mantissas.z << 4u | exponent << 22u;
  return s;
}
/// Exact radiance.
LUCERNA_INLINE vec3 group_sum_value(GroupSum s) {
  return vec3(group_sum_mantissas(s)) * uintBitsToFloat(group_sum_exponent(s) << 23u);
}

LUCERNA_INLINE float group_ratio(float mixed, float all, float whole) { return all > 0.0f ? mixed / all : whole; }
/// Factor from the light of all groups to their mix. A channel too dim for the sums gets the factor of the others; 1 without
/// light.
LUCERNA_INLINE vec3 group_ratio(vec3 mixed, vec3 all) {
  float whole = group_ratio(mixed.x + mixed.y + mixed.z, all.x + all.y + all.z, 1.0f);
  return vec3(group_ratio(mixed.x, all.x, whole), group_ratio(mixed.y, all.y, whole), group_ratio(mixed.z, all.z, whole));
}

LUCERNA_SHARED_END
#endif
