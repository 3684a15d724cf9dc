// What kernels are told of the cache, and the least radius of its records: some pixels wide as the camera sees it, and no
// more than the greatest.
#ifndef LUCERNA_IRRADIANCE_CACHE_LEAST_RADIUS
#define LUCERNA_IRRADIANCE_CACHE_LEAST_RADIUS
#include "shaders/shared/irradiance_cache/records.h"

layout(scalar) readonly buffer CacheBlock { CacheFrame cache; };

// A record's flags (k_record_*) as they lie in its texel 2. One that crowds reaches no further than it must.
bool record_flagged_crowded(float flags) { return (floatBitsToUint(flags) & k_record_crowded) != 0u; }
float record_flags(float before, bool crowds) {
  return uintBitsToFloat(floatBitsToUint(before) | (crowds ? k_record_crowded : 0u));
}

float least_radius(vec3 position) {
  return min(cache.least_of_distance * (cache.parallel != 0u ? 1.0 : distance(position, cache.eye)), cache.least_most);
}
#endif
