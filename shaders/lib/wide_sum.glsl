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

// Adds high * 2^32 + low to a LongSum in a buffer: what goes beyond a word's end is carried to the next, in whatever order.
#define ADD_TO_LONG_SUM(sum, low_word, high_word)                                                           \
  {                                                                                                         \
    uint long_sum_low = (low_word), long_sum_high = (high_word);                                            \
    bool long_sum_carry = long_sum_low > 0u && atomicAdd((sum).low, long_sum_low) > ~long_sum_low;          \
    if (long_sum_high > 0u && atomicAdd((sum).middle, long_sum_high) > ~long_sum_high) atomicAdd((sum).high, 1u); \
    if (long_sum_carry && atomicAdd((sum).middle, 1u) == 0xffffffffu) atomicAdd((sum).high, 1u);            \
  }

// A number of 0 ... 2^64 as its two words, rounded down.
uvec2 two_words(float x) {
  float high = floor(x * (1.0 / 4294967296.0));
  return uvec2(uint(x - high * 4294967296.0), uint(high));
}
#endif
