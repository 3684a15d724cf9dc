// Cache parameters of the kernels, and the minimum record radius: some pixels as seen from the camera, at most the maximum
// radius.
#ifndef LUCERNA_IRRADIANCE_CACHE_LEAST_RADIUS
#define LUCERNA_IRRADIANCE_CACHE_LEAST_RADIUS
#include "shaders/shared/irradiance_cache/records.h"

layout(scalar) readonly buffer CacheBlock { CacheFrame cache; };

// Flags of a record (k_record_*), stored in its texel 2. A crowded record has the minimum reach.
bool record_flagged_crowded(float flags) { return (floatBitsToUint(flags) & k_record_crowded) != 0u; }
float record_flags(float before, bool crowds) {
  return uintBitsToFloat(floatBitsToUint(before) | (crowds ? k_record_crowded : 0u));
}

float least_radius(vec3 position) {
  return min(cache.least_of_distance * (cache.parallel != 0u ? 1.0 : distance(position, cache.eye)), cache.least_most);
}
#endif
