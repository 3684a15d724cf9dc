// Sums that 32 bits may not hold. Read by C++ and GLSL; shaders/lib/wide_sum.glsl adds to them.
#ifndef LUCERNA_SHARED_WIDE_SUM_H
#define LUCERNA_SHARED_WIDE_SUM_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// high * 2^32 + low.
struct WideSum {
  uint low, high;
};

/// high * 2^64 + middle * 2^32 + low.
struct LongSum {
  uint low, middle, high;
};

#ifdef __cplusplus
inline uint64_t value(const WideSum& sum) { return uint64_t{sum.high} << 32 | sum.low; }
inline double value(const LongSum& sum) {
  return (double(sum.high) * 4294967296.0 + double(sum.middle)) * 4294967296.0 + double(sum.low);
}
#endif

LUCERNA_SHARED_END
#endif
