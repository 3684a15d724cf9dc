// Propagation of record errors into the picture: format of the path notes at lookups (k_probe_errors).
#ifndef LUCERNA_IRRADIANCE_CACHE_ERROR_PROPAGATION
#define LUCERNA_IRRADIANCE_CACHE_ERROR_PROPAGATION
#include "shaders/shared/irradiance_cache/records.h"
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
#endif
