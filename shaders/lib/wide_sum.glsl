// Sums of many invocations beyond 32 bits, without 64-bit atomics, which are optional.
#ifndef LUCERNA_WIDE_SUM_GLSL
#define LUCERNA_WIDE_SUM_GLSL
#include "shaders/shared/wide_sum.h"

// Adds n to a WideSum in a buffer. An addition that takes the low word beyond its end sees so by what was there before.
#define ADD_TO_WIDE_SUM(sum, n)                                                    \
  {                                                                                \
    uint wide_sum_n = (n);                                                         \
    if (atomicAdd((sum).low, wide_sum_n) > ~wide_sum_n) atomicAdd((sum).high, 1u); \
  }
#endif
