// Common to the kernels of the prefix sum.
#ifndef LUCERNA_LIB_SCAN
#define LUCERNA_LIB_SCAN
#include "shaders/shared/sort.h"
#include "lib/invocation.glsl"
#include "lib/runs.glsl"

#ifndef LUCERNA_SCAN_GROUP
#define LUCERNA_SCAN_GROUP 8
#define LUCERNA_SCAN_WANTED 64
#define LUCERNA_SCAN_LEAST 64
#endif

layout(push_constant, scalar) uniform Push { ScanPush push; };
layout(scalar) readonly buffer ScanCount { uint scan_count_words[]; };
uniform usamplerBuffer scan_in;

uint scan_count() {
  return counted(scan_count_words);
}
uint scan_run_length(uint count) { return run_length(count, LUCERNA_SCAN_LEAST, LUCERNA_SCAN_WANTED); }

// Four elements from a multiple of 4; 0 beyond the end.
uvec4 scan_fetch(uint at, uint end) {
  uvec4 v = texelFetch(scan_in, int(at >> 2));
  uint left = end - at;
  return uvec4(v.x, left > 1u ? v.y : 0u, left > 2u ? v.z : 0u, left > 3u ? v.w : 0u);
}
#endif
