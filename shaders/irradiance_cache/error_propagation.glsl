// Propagation of record errors into the picture: format of the path notes at lookups (k_probe_errors), and the random signs
// of the records' errors.
#ifndef LUCERNA_IRRADIANCE_CACHE_ERROR_PROPAGATION
#define LUCERNA_IRRADIANCE_CACHE_ERROR_PROPAGATION
#include "shaders/shared/irradiance_cache/records.h"
#include "lib/hash.glsl"
#include "lib/math.glsl"

// Packed colour of any magnitude: 8 bits for each channel relative to the largest, 8 bits for a shared power of 2.
uint throughput_pack(vec3 color) {
  float most = max3(color);
  float power = clamp(ceil(log2(max(most, 1e-30))), -127.0, 127.0);
  return most > 0.0 ? packUnorm4x8(vec4(color * exp2(-power), (power + 127.0) / 255.0)) : 0u;
}
vec3 throughput_unpack(uint bits) {
  vec4 c = unpackUnorm4x8(bits);
  return bits == 0u ? vec3(0.0) : c.rgb * exp2(round(c.a * 255.0) - 127.0);
}

// Random signs +1 or -1 for lanes 4 group .. 4 group + 3, independent between records and lanes: a hash of the record's
// number.
vec4 record_signs(uint record, uint group) {
  uint x = hash_mix(record + 0x9e3779b9u) >> (4u * group);
  return 1.0 - 2.0 * vec4(uvec4(x, x >> 1, x >> 2, x >> 3) & 1u);
}
#endif
