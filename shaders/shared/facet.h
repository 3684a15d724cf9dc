// A unit vector in 22 bits: the octahedral map (Z. Cigolle et al., "A Survey of Efficient Representations for Independent
// Unit Vectors", JCGT 3(2), 2014), to about a tenth of a degree. Compiled by C++ and by GLSL.
#ifndef LUCERNA_SHARED_FACET_H
#define LUCERNA_SHARED_FACET_H
#include "shaders/shared/tone.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_facet_steps = 2047u;  // of the map along an axis, -1 to 1

// The map's lower half, folded over its diagonals.
LUCERNA_TONE_FUNCTION vec2 facet_fold(vec2 p) {
  return vec2((1.0f - abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f), (1.0f - abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f));
}

// The map's point of a vector, in -1..1, and the vector of a point, not of length 1.
LUCERNA_TONE_FUNCTION vec2 facet_flatten(vec3 n) {
  vec2 p = vec2(n.x, n.y) / (abs(n.x) + abs(n.y) + abs(n.z));
  return n.z < 0.0f ? facet_fold(p) : p;
}
LUCERNA_TONE_FUNCTION vec3 facet_raise(vec2 p) {
  float z = 1.0f - abs(p.x) - abs(p.y);
  if (z < 0.0f) p = facet_fold(p);
  return vec3(p.x, p.y, z);
}

LUCERNA_TONE_FUNCTION uint facet_pack(vec3 n) {
  vec2 p = facet_flatten(n);
  float most = float(k_facet_steps);
  vec2 q = clamp((p * 0.5f + 0.5f) * most + 0.5f, vec2(0.0f), vec2(most));
  return uint(q.x) | uint(q.y) << 11;
}

LUCERNA_TONE_FUNCTION vec3 facet_unpack(uint bits) {
  vec2 p = vec2(float(bits & k_facet_steps), float(bits >> 11 & k_facet_steps)) / float(k_facet_steps) * 2.0f - 1.0f;
  return normalize(facet_raise(p));
}

LUCERNA_SHARED_END
#endif
