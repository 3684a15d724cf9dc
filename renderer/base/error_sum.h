#pragma once
// The sum of errors by source.
#include <cmath>

namespace lucerna {

/// hypot(paths, records) + interpolation. Noise of paths and noise of the records they read are independent,
/// so their variances add. Interpolation is the bias of lookups (between records, blur of photons); its sign
/// is unknown, so it is added on top. All are 0 or more.
template <class Real>
Real error_sum(Real paths, Real records, Real interpolation) {
  return std::hypot(paths, records) + interpolation;
}

}  // namespace lucerna
