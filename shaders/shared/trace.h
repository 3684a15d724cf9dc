// Parameters of the tracing kernels. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_TRACE_H
#define LUCERNA_SHARED_TRACE_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// Row i of [0, count) is the ray queue[i] where use_queue != 0, else the ray i.
struct TracePush {
  uint count;
  uint use_queue;
};

// The queries, numbered as lucerna::bvh::Query.
LUCERNA_CONST uint k_query_closest = 0u;
LUCERNA_CONST uint k_query_any_opaque = 1u;
LUCERNA_CONST uint k_query_closest_non_opaque = 2u;

LUCERNA_SHARED_END
#endif
