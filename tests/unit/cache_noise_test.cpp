// links: irradiance_cache
// Which records get more rays: decided by their neighbours, so the remaining light is unbiased.
#include "solvers/irradiance_cache/noise.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace cache_noise_tests {

using namespace lucerna::irradiance_cache;

TEST_CASE("records are judged by their neighbours' error and light and by their own bound") {
  CHECK(too_noisy({}, 1).empty());
  // A single record is judged by itself.
  CHECK(too_noisy(std::vector<Noise>{{.error = 0.3f, .light = 2, .bound = 0.1f}}, 0) ==
        std::vector<uint32_t>{0});
  CHECK(too_noisy(std::vector<Noise>{{.error = 0.3f, .light = 2, .bound = 0.2f}}, 0).empty());
  // Darker ones are compared with `darkest`.
  CHECK(too_noisy(std::vector<Noise>{{.error = 0.3f, .light = 2, .bound = 0.1f}}, 4).empty());

  std::vector<Noise> list(20, {.error = 0.1f, .light = 1, .bound = 0.2f});
  CHECK(too_noisy(list, 0).empty());
  // A record with a very bright sample: its neighbours get more rays, it does not.
  list[9].error = 10;
  CHECK(too_noisy(list, 0) == std::vector<uint32_t>{5, 6, 7, 8, 10, 11, 12, 13});
  // Root mean square of eight over their mean light: 10 / sqrt(8) = 3.54.
  for (Noise& n : list) n.bound = 3.6f;
  CHECK(too_noisy(list, 0).empty());
  list[7].bound = 3.5f;
  CHECK(too_noisy(list, 0) == std::vector<uint32_t>{7});
  for (Noise& n : list) n.light = 2;
  CHECK(too_noisy(list, 0).empty());
  // At the ends there are fewer neighbours: five for the second, four for the last.
  list.assign(20, {.error = 0, .light = 1, .bound = 0.48f});
  list[3].error = 1, list[16].error = 1;
  CHECK(too_noisy(list, 0) == std::vector<uint32_t>{0, 19});
}

TEST_CASE("records that stop are unbiased on average, whatever their noise") {
  // Estimates of 1 by few samples of a rarely bright value: error and light are correlated.
  constexpr int k_records = 200000, k_samples = 16;
  std::mt19937 random(7);
  std::vector<Noise> list;
  std::bernoulli_distribution bright(0.1);
  for (int i = 0; i < k_records; ++i) {
    double sum = 0, squares = 0;
    for (int s = 0; s < k_samples; ++s) {
      const double x = bright(random) ? 10 : 0;
      sum += x, squares += x * x;
    }
    const double mean = sum / k_samples, variance = std::max(0.0, squares / k_samples - mean * mean);
    list.push_back({float(std::sqrt(variance / k_samples)), float(mean), 0.75f});
  }
  const auto mean_of_stopped = [&](const std::vector<uint32_t>& going_on, size_t& stopped) {
    double sum = 0;
    stopped = 0;
    for (size_t i = 0, at = 0; i < list.size(); ++i) {
      if (at < going_on.size() && going_on[at] == i) {
        ++at;
        continue;
      }
      sum += double(list[i].light), ++stopped;
    }
    return sum / double(stopped);
  };
  size_t stopped = 0;
  const double mean = mean_of_stopped(too_noisy(list, 0.1f), stopped);
  INFO(stopped << " stop, their mean is " << mean);
  REQUIRE(stopped > k_records / 4);
  REQUIRE(stopped < 3 * k_records / 4);
  // Five standard errors, 6e-7.
  CHECK(std::abs(mean - 1) < 5 * 0.75 / std::sqrt(double(stopped)));
  // If each is judged by itself they are biased.
  std::vector<uint32_t> alone;
  for (uint32_t i = 0; i < list.size(); ++i)
    if (!too_noisy(std::span(list).subspan(i, 1), 0.1f).empty()) alone.push_back(i);
  CHECK(std::abs(mean_of_stopped(alone, stopped) - 1) > 0.1);
}

TEST_CASE("of the noisy records, at most a number are selected, the noisiest") {
  std::vector<Noise> list(40, {.error = 0.1f, .light = 1, .bound = 0.05f});
  CHECK(too_noisy(list, 0).size() == 40);
  CHECK(too_noisy(list, 0, 0).empty());
  // Equals: the first.
  CHECK(too_noisy(list, 0, 3) == std::vector<uint32_t>{0, 1, 2});
  // A noisier record makes its neighbours noisier, not itself.
  list[20].error = 0.4f;
  CHECK(too_noisy(list, 0, 4) == std::vector<uint32_t>{16, 17, 18, 19});
  // What counts is the excess over the bound: here 2, there up to 4.
  list[30].bound = 0.01f;
  CHECK(too_noisy(list, 0, 1) == std::vector<uint32_t>{30});
}

}  // namespace cache_noise_tests
