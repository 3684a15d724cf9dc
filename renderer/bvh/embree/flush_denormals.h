#pragma once
#include <pmmintrin.h>
#include <xmmintrin.h>

namespace lucerna::bvh {

/// While it lives, this thread treats denormals as zero. They cost hundreds of cycles and are negligible at
/// the scale of a scene; Embree requires this.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

}  // namespace lucerna::bvh
