// A unit vector in 22 bits: the octahedral map (Z. Cigolle et al., "A Survey of Efficient Representations for Independent
// Unit Vectors", JCGT 3(2), 2014), to about a tenth of a degree.
#ifndef LUCERNA_IRRADIANCE_CACHE_FACET
#define LUCERNA_IRRADIANCE_CACHE_FACET
#include "shaders/shared/irradiance_cache.h"

vec2 facet_sign(vec2 v) { return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }

uint facet_pack(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  if (n.z < 0.0) p = (1.0 - abs(p.yx)) * facet_sign(p);
  uvec2 q = uvec2(clamp((p * 0.5 + 0.5) * float(k_facet_steps) + 0.5, vec2(0.0), vec2(float(k_facet_steps))));
  return q.x | q.y << 11;
}

vec3 facet_unpack(uint bits) {
  vec2 p = vec2(bits & k_facet_steps, bits >> 11 & k_facet_steps) / float(k_facet_steps) * 2.0 - 1.0;
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * facet_sign(n.xy);
  return normalize(n);
}
#endif
