// links: schedule
// Balanced sampling with simulated noise: where samples go, and what that does to the squared error.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "schedule/balanced.h"

namespace schedule_balanced_tests {

using namespace lucerna::schedule;

namespace {

constexpr uint32_t k_across = 16, k_down = 12;

std::vector<uint32_t> none() { return std::vector<uint32_t>(k_across * k_down, 0); }

/// Runs the schedule to its end; a sample of block b has the variance variance(b).
template <class Variance>
std::vector<WorkItem> play(BalancedSchedule& s, const Variance& variance) {
  std::vector<WorkItem> items;
  std::vector<uint32_t> samples = s.counts();
  while (!s.done()) {
    if (s.waits()) {
      CHECK(s.next().blocks.empty());
      std::vector<float> squares;
      for (uint32_t b = 0; b < samples.size(); ++b)
        squares.push_back(samples[b] > 0 ? float(variance(b) / samples[b]) : 0.0f);
      s.judge(squares);
      continue;
    }
    const WorkItem item = s.next();
    REQUIRE_FALSE(item.blocks.empty());
    CHECK(item.slots() <= s.options().slots);
    std::set<uint32_t> seen;
    for (const WorkBlock& b : item.blocks) {
      CHECK(seen.insert(b.index).second);
      CHECK(b.first_sample == samples[b.index]);  // no sample twice, none skipped
      samples[b.index] += item.sample_count;
    }
    items.push_back(item);
    REQUIRE(items.size() < 100000);
  }
  CHECK(samples == s.counts());
  return items;
}

template <class Variance>
double squared_error(const std::vector<uint32_t>& samples, const Variance& variance) {
  double sum = 0;
  for (uint32_t b = 0; b < samples.size(); ++b) sum += variance(b) / samples[b];
  return sum / double(samples.size());
}

/// The right half of the picture has nine times the variance.
double on_the_right(uint32_t b) { return b % k_across >= k_across / 2 ? 9.0 : 1.0; }

}  // namespace

TEST_CASE("samples are proportional to the root of the variance, and the squared error is near its least") {
  BalancedSchedule s(k_across, {.samples = 400}, none());
  play(s, on_the_right);
  CHECK(s.mean_samples() >= 400);
  CHECK(s.mean_samples() < 425);
  const double calm = s.counts()[5 * k_across + 2], noisy = s.counts()[5 * k_across + 13];
  CHECK(noisy / calm > 2.7);
  CHECK(noisy / calm < 3.3);
  // Least: (mean of the roots)^2 / n. Here 2^2 = 4, where uniform sampling has 5.
  CHECK(squared_error(s.counts(), on_the_right) * s.mean_samples() < 1.06 * 4);
  CHECK(squared_error(std::vector<uint32_t>(k_across * k_down, 400), on_the_right) * 400 == Approx(5));
}

TEST_CASE("a block's own errors decide nothing about it") {
  const uint32_t middle = 6 * k_across + 7;
  const auto with = [&](double variance) {
    BalancedSchedule s(k_across, {.samples = 200}, none());
    play(s, [&](uint32_t b) { return b == middle ? variance : 1.0; });
    return s.counts();
  };
  const std::vector<uint32_t> calm = with(1), noisy = with(50);
  CHECK(noisy[middle] <= calm[middle]);
  for (const uint32_t beside : {middle - 1, middle + 1, middle - k_across, middle + k_across})
    CHECK(noisy[beside] > 1.5 * calm[beside]);
}

TEST_CASE("equal noise everywhere: equal samples everywhere") {
  BalancedSchedule s(k_across, {.samples = 200}, none());
  play(s, [](uint32_t) { return 0.3; });
  for (const uint32_t n : s.counts()) CHECK(n == s.least_samples());
  // Without any noise too (a black picture).
  BalancedSchedule dark(k_across, {.samples = 64}, none());
  play(dark, [](uint32_t) { return 0.0; });
  for (const uint32_t n : dark.counts()) CHECK(n == dark.least_samples());
}

TEST_CASE("all pixels get the first samples, single ones at first; no block is forgotten later") {
  BalancedSchedule s(k_across, {.samples = 256, .first = 16}, none());
  const auto variance = [](uint32_t b) { return b < 2 ? 1e6 : 1e-6; };
  const std::vector<WorkItem> items = play(s, variance);
  std::vector<uint32_t> passes;
  for (const WorkItem& item : items)
    if (item.blocks.front().first_sample < 16 && item.blocks.size() > 1) passes.push_back(item.sample_count);
  passes.resize(5);
  CHECK(passes == std::vector<uint32_t>{1, 1, 2, 4, 8});
  // A block whose neighbours have found no noise has half of the mean at least.
  CHECK(s.least_samples() >= 128);
  CHECK(s.counts()[0] > 1000);
}

TEST_CASE("the same errors give the same schedule, and a round does not depend on the device's size") {
  const auto variance = [](uint32_t b) { return 1.0 + b % 7 * (b % 5); };
  BalancedSchedule a(k_across, {.samples = 100}, none()), b(k_across, {.samples = 100}, none()),
      small(k_across, {.samples = 100, .slots = 2048}, none());
  const auto one = play(a, variance), other = play(b, variance), many = play(small, variance);
  REQUIRE(one.size() == other.size());
  CHECK(many.size() > one.size());
  CHECK(a.counts() == b.counts());
  CHECK(a.counts() == small.counts());
  CHECK(a.rounds() == small.rounds());
}

TEST_CASE("a copy made before an item repeats it") {
  BalancedSchedule s(k_across, {.samples = 8}, none());
  s.next();
  const BalancedSchedule before = s;
  const WorkItem item = s.next();
  s = before;
  const WorkItem again = s.next();
  CHECK(again.sample_count == item.sample_count);
  REQUIRE(again.blocks.size() == item.blocks.size());
  CHECK(again.blocks.front().first_sample == item.blocks.front().first_sample);
}

TEST_CASE("a picture with samples continues: blocks behind catch up, none is repeated") {
  std::vector<uint32_t> have = none();
  for (uint32_t b = 0; b < have.size(); ++b) have[b] = b % 3 == 0 ? 5 : b % 3 == 1 ? 2 : 33;
  BalancedSchedule s(k_across, {.samples = 50}, have);
  play(s, [](uint32_t) { return 1.0; });
  CHECK(s.least_samples() >= 33);
  CHECK(s.mean_samples() >= 50);
  // More than wanted already: nothing to do, until more is wanted.
  BalancedSchedule rich(k_across, {.samples = 20}, s.counts());
  CHECK(rich.done());
  CHECK(rich.next().blocks.empty());
  rich.set_samples(60);
  CHECK_FALSE(rich.done());
  play(rich, [](uint32_t) { return 1.0; });
  CHECK(rich.mean_samples() >= 60);
}

TEST_CASE("only blocks of the region get samples; tiny pictures and few slots") {
  std::vector<uint32_t> have = none();
  BalancedSchedule s(k_across, {.samples = 40, .region = {2, 3, 5, 6}}, have);
  play(s, on_the_right);
  CHECK(s.most_samples() >= 40);
  CHECK(s.most_samples() < 60);
  have[0] = 1000;  // outside
  CHECK(BalancedSchedule(k_across, {.samples = 40, .region = {2, 3, 5, 6}}, have).most_samples() == 0);
  for (uint32_t b = 0; b < s.counts().size(); ++b) {
    const uint32_t x = b % k_across, y = b / k_across;
    CHECK((s.counts()[b] > 0) == (x >= 2 && x < 5 && y >= 3 && y < 6));
  }
  BalancedSchedule nothing(k_across, {.samples = 40, .region = {20, 20, 21, 21}}, none());
  CHECK(nothing.done());
  CHECK(nothing.least_samples() == 0);
  BalancedSchedule one(1, {.samples = 3, .slots = 64}, {0});
  play(one, [](uint32_t) { return 1.0; });
  CHECK(one.counts()[0] == 3);
}

}  // namespace schedule_balanced_tests
