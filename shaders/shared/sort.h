// Parameters of prefix sums and radix sorts. Read by C++ and GLSL.
#ifndef LUCERNA_SHARED_SORT_H
#define LUCERNA_SHARED_SORT_H
#include "shaders/shared/compat.h"
LUCERNA_SHARED_BEGIN

/// An entry of a sort by 32-bit keys. Two are a texel.
struct SortPair {
  uint key;
  uint value;
};

/// An entry of a sort by 64-bit keys (high, low). One is a texel.
struct SortEntry64 {
  uint low;
  uint high;
  uint value;
  uint unused;         ///< not kept
};

struct ScanPush {
  uint count;          ///< elements; the maximum if the count is read from a buffer
  uint count_at;       ///< word of ScanCount with the number; k_sort_count_here: `count` is used
  uint total_at;       ///< word of ScanTotal for the total
};

struct SortPush {
  uint count;          ///< entries; the maximum if the count is read from a buffer
  uint count_at;       ///< word of SortCount with the number; k_sort_count_here: `count` is used
  uint shift;          ///< the digit is (word >> shift) & (bins - 1)
  uint bins;           ///< a power of two
  uint high_word;      ///< 1: of the upper half of a 64-bit key
};

LUCERNA_CONST uint k_sort_count_here = 0xffffffffu;

LUCERNA_SHARED_END
#endif
