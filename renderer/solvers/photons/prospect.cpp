// What photons promise for a scene, before one is traced.
#include "paths/automaton.h"
#include "solvers/photons/info.h"

namespace lucerna::photons {

namespace {

// Measured with the default settings at 320x180 (lucerna bench auto): cost of a round's light paths and
// lookups, in samples (1.5 in `glass`, 1.7 and 4.6 in two interiors), and the share of the variance of
// caustics that they leave (below 0.05 in `glass`, 0.16 and 0.36 there).
constexpr double k_round = 2, k_left = 0.1;

}  // namespace

std::optional<solvers::Prospect> prospect(const solvers::Findings& findings, uint32_t components) {
  // Of interreflection, photons are seldom ahead of paths and never of records.
  if (components != paths::k_caustic_bit) return std::nullopt;
  return solvers::Prospect{.sample = k_round,
                           .variance = k_left * findings.components[paths::k_caustic].variance};
}

}  // namespace lucerna::photons
