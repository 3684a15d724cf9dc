#pragma once
// Radius of photons over the rounds.
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lucerna::photons {

/// r_round / r_0 of the global radius of stochastic progressive photon mapping. The ratio of r^2 between
/// successive rounds is (i + alpha) / (i + 1), i = 1, 2, ... (C. Knaus and M. Zwicker 2011, equation 15),
/// which gives Gamma(n + alpha) / (Gamma(1 + alpha) Gamma(n + 1)), n = round + 1. Rounds are simply averaged:
/// their variance falls with n^-alpha, their bias with n^(alpha - 1). alpha: 0..1; 1: constant radius.
inline double radius_ratio(uint32_t round, double alpha) {
  const double n = double(round) + 1;
  return std::exp(0.5 * (std::lgamma(n + alpha) - std::lgamma(1 + alpha) - std::lgamma(n + 1)));
}

/// Radius of rounds as seen from the camera, and the expected errors: variance of a round is proportional to
/// 1 / r^2, and bias to r^2 where the light is at most quadratic within a disc.
struct RadiusLaw {
  double first = 1, floor = 0, alpha = 2.0 / 3;  ///< pixels, pixels, 0..1
  double at(uint32_t round) const { return std::max(floor, first * radius_ratio(round, alpha)); }
  /// Of the mean of rounds >= 1, relative to one round of radius `first`.
  double noise(uint32_t rounds) const {
    double sum = 0;
    for (uint32_t i = 0; i < rounds; ++i) sum += 1 / square(i);
    return std::sqrt(sum) / double(rounds);
  }
  double bias(uint32_t rounds) const {
    double sum = 0;
    for (uint32_t i = 0; i < rounds; ++i) sum += square(i);
    return sum / double(rounds);
  }

 private:
  double square(uint32_t round) const {
    const double r = at(round) / first;
    return r * r;
  }
};

}  // namespace lucerna::photons
