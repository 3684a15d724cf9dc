#pragma once
// Alias tables (Walker 1977, built as Vose 1991): constant-time choice of i with probability w_i / sum w.
#include <span>
#include <vector>

#include "base/math.h"

namespace lucerna {

/// One texel an entry: (threshold, bits of the alias index, pmf of this entry, pmf of the alias). Entry i is
/// chosen uniformly, then i itself when a uniform number is below the threshold, else its alias.
/// Probabilities are those of the device's choice: they differ from w_i / sum w by up to 2^-24 / n,
/// and are above 0 for every weight above 0. Weights are >= 0 and finite; all zero (or none): an
/// empty table.
std::vector<vec4> build_alias_table(std::span<const double> weights);

}  // namespace lucerna
