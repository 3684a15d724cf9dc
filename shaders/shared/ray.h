// A ray and its hit, as they lie in the queues. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_RAY_H
#define LUCERNA_SHARED_RAY_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

LUCERNA_CONST uint k_no_hit = 0xffffffffu;

/// World space; `direction` is unit to within rounding. Hits count for 0 < t < tmax. tmax <= 0: a dead ray (no hit).
struct Ray {
  vec3 origin;
  float tmax;
  vec3 direction;
  uint slot;       ///< path slot that owns it; tracers do not touch it
};

/// `prim` is the primitive id, or k_no_hit; then the rest is undefined. The hit point is
/// (1-u-v)*p0 + u*p1 + v*p2. For Query::any_opaque only `prim` is defined.
struct Hit {
  float t;
  uint prim;
  float u, v;
};

LUCERNA_SHARED_END
#ifdef __cplusplus
static_assert(sizeof(lucerna::shared::Ray) == 32 && sizeof(lucerna::shared::Hit) == 16);
#endif
#endif
