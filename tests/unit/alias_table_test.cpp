// links: upload
// Alias tables: their stated probabilities are those with which the device chooses, for any weights.
#include "upload/alias_table.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace alias_table_tests {

using namespace lucerna;

namespace {

/// The probability of coin_below() in shaders/lib/sampler.glsl: the share of all 32-bit values below p.
double coin(float p) {
  return p < 0.5f ? std::ceil(double(p) * 0x1p32) / 0x1p32 : std::ceil(double(p) * 0x1p24) / 0x1p24;
}

}  // namespace

TEST_CASE("a table's probabilities equal those of its coins, for weights of any ratio") {
  std::mt19937 random(2);
  std::vector<std::vector<double>> lists{
      {1e-16, 1}, {1e-8, 1e8, 1, 1e-30}, {1e-300, 1e300}, {0, 1e-12, 0, 1}, {3e7, 1, 2, 1e-9, 0.5}};
  lists.emplace_back();
  for (int i = 0; i < 5000; ++i) lists.back().push_back(std::exp2(double(random() % 120) - 60));
  for (const std::vector<double>& weights : lists) {
    const std::vector<vec4> table = upload::build_alias_table(weights);
    REQUIRE(table.size() == weights.size());
    const double n = double(weights.size());
    std::vector<double> chosen(weights.size(), 0.0);
    double total = 0, sum = 0;
    for (const double w : weights) total += w;
    for (size_t i = 0; i < table.size(); ++i) {
      chosen[i] += coin(table[i].x) / n;
      chosen[std::bit_cast<uint32_t>(table[i].y)] += (1 - coin(table[i].x)) / n;
    }
    size_t wrong = 0, far = 0, impossible = 0;
    for (size_t i = 0; i < table.size(); ++i) {
      const double p = table[i].z;
      sum += p;
      wrong += std::abs(chosen[i] - p) > 1e-6 * p;
      wrong += table[i].w != table[std::bit_cast<uint32_t>(table[i].y)].z;
      far += std::abs(p - weights[i] / total) > 0x1p-24 * std::max(weights[i] / total, 1 / n);
      impossible += (weights[i] > 0) != (p > 0);
    }
    INFO("of " << weights.size());
    CHECK(wrong == 0);
    CHECK(far == 0);
    CHECK(impossible == 0);
    CHECK(sum == Approx(1).epsilon(1e-6));
  }
}

}  // namespace alias_table_tests
