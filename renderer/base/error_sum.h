#pragma once
// What a relative error comes to by where it comes from.
#include <cmath>

namespace lucerna {

/// hypot(paths, records) + interpolation: the noise of the paths and that of the records which they read are
/// independent of each other, so that their variances add up; what lookups are off by in the mean, between
/// records or by the blur of photons, has a sign that nobody knows, and is added to what they come to. All 0
/// or more.
template <class Real>
Real error_sum(Real paths, Real records, Real interpolation) {
  return std::hypot(paths, records) + interpolation;
}

}  // namespace lucerna
