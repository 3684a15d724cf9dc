#pragma once
// The radius of photons over rounds.
#include <cmath>
#include <cstdint>

namespace lucerna::photons {

/// r_round / r_0 of the global radius of stochastic progressive photon mapping: r^2 of a round over that of
/// the one before is (i + alpha) / (i + 1), i = 1, 2, ... (C. Knaus and M. Zwicker 2011, equation 15), which
/// gives Gamma(n + alpha) / (Gamma(1 + alpha) Gamma(n + 1)), n = round + 1. Rounds are then simply averaged:
/// their variance falls with n^-alpha, their bias with n^(alpha - 1). alpha: 0..1, 1 leaves the radius as it
/// is.
inline double radius_ratio(uint32_t round, double alpha) {
  const double n = double(round) + 1;
  return std::exp(0.5 * (std::lgamma(n + alpha) - std::lgamma(1 + alpha) - std::lgamma(n + 1)));
}

}  // namespace lucerna::photons
