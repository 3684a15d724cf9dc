// Common to the kernels of the radix sort.
#ifndef LUCERNA_LIB_SORT
#define LUCERNA_LIB_SORT
#include "shaders/shared/sort.h"
#include "lib/invocation.glsl"
#include "lib/runs.glsl"

#ifndef LUCERNA_SORT_GROUP
#define LUCERNA_SORT_GROUP 8
#define LUCERNA_SORT_BINS 2048
#define LUCERNA_SORT_WANTED 64
#define LUCERNA_SORT_LEAST 256
#endif

layout(local_size_x = LUCERNA_SORT_GROUP) in;
layout(push_constant, scalar) uniform Push { SortPush push; };
layout(scalar) readonly buffer SortCount { uint sort_count_words[]; };
uniform usamplerBuffer sort_in;

uint sort_count() {
  return counted(sort_count_words);
}
uint sort_run_length(uint count) { return run_length(count, LUCERNA_SORT_LEAST, LUCERNA_SORT_WANTED); }
uint digit(uint word) { return (word >> push.shift) & (push.bins - 1u); }

// Every invocation has its own counters, so that no synchronization is needed. On lavapipe a private array is the
// fastest place for them: twice as fast as shared memory, three times as fast as a storage buffer.
uint counters[LUCERNA_SORT_BINS];
uint take(uint bin) {
  uint value = counters[bin];
  counters[bin] = value + 1u;
  return value;
}
#endif
