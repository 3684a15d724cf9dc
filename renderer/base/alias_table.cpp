#include "base/alias_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lucerna {
namespace {

/// The nearest probability that coin_below() of shaders/lib/sampler.glsl represents exactly; above 0 for one
/// above 0.
double as_coin(double p, bool possible) {
  const double steps = p < 0.5 ? 0x1p32 : 0x1p24;
  const double nearest = double(float(std::round(p * steps) / steps));
  return possible ? std::max(nearest, 0x1p-32) : nearest;
}

}  // namespace

std::vector<vec4> build_alias_table(std::span<const double> weights) {
  double total = 0;
  for (double w : weights) total += w;
  if (!(total > 0)) return {};
  const size_t n = weights.size();
  std::vector<double> scaled(n);
  std::vector<uint32_t> small, large, alias(n);
  for (size_t i = 0; i < n; ++i) {
    scaled[i] = weights[i] / total * double(n);
    alias[i] = uint32_t(i);
    (scaled[i] < 1 ? small : large).push_back(uint32_t(i));
  }
  while (!small.empty() && !large.empty()) {
    const uint32_t s = small.back(), l = large.back();
    small.pop_back();
    alias[s] = l;
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] < 1) large.pop_back(), small.push_back(l);
  }
  // Entries left by rounding choose themselves; those of weight zero never do.
  for (uint32_t i : large) scaled[i] = 1;
  uint32_t heaviest = 0;
  for (size_t i = 0; i < n; ++i)
    if (weights[i] > weights[heaviest]) heaviest = uint32_t(i);
  for (uint32_t i : small) {
    if (weights[i] > 0)
      scaled[i] = 1;
    else
      scaled[i] = 0, alias[i] = heaviest;
  }
  // Probabilities are those of the coins: a relative weight of 1e-16 is chosen more often than that.
  std::vector<double> pmf(n, 0.0);
  for (size_t i = 0; i < n; ++i) {
    scaled[i] = as_coin(scaled[i], weights[i] > 0);
    pmf[i] += scaled[i] / double(n), pmf[alias[i]] += (1 - scaled[i]) / double(n);
  }
  std::vector<vec4> table(n);
  for (size_t i = 0; i < n; ++i)
    table[i] = vec4(float(scaled[i]), std::bit_cast<float>(alias[i]), float(pmf[i]), float(pmf[alias[i]]));
  return table;
}

}  // namespace lucerna
