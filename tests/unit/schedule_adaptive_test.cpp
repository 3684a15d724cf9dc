// links: schedule
// Adaptive tiles with simulated noise: which tiles get samples, when they stop, how the device is filled.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "schedule/adaptive.h"
#include "schedule/uniform.h"

namespace schedule_adaptive_tests {

using namespace lucerna::schedule;

namespace {

/// Runs the schedule to its end; tile t has the error sigma(t) / sqrt(samples).
struct Player {
  AdaptiveSchedule schedule;
  std::map<uint32_t, uint32_t> samples;  // by block
  std::vector<WorkItem> items;

  template <class Sigma>
  void play(const Sigma& sigma, uint32_t slots) {
    while (!schedule.done()) {
      const WorkItem item = schedule.next();
      REQUIRE(item.sample_count > 0);
      REQUIRE_FALSE(item.blocks.empty());
      CHECK(item.slots() <= slots);
      std::set<uint32_t> seen;
      for (const WorkBlock& b : item.blocks) {
        CHECK(seen.insert(b.index).second);
        CHECK(b.first_sample == samples[b.index]);  // no sample twice, none skipped
        samples[b.index] += item.sample_count;
      }
      std::vector<TileErrors> errors;
      for (const uint32_t t : schedule.to_report())
        errors.push_back(
            {.paths = float(sigma(t) / std::sqrt(schedule.tiles()[t].samples + item.sample_count))});
      schedule.report(errors);
      items.push_back(item);
      REQUIRE(items.size() < 100000);
    }
  }
};

}  // namespace

TEST_CASE("every tile ends below the target or at the maximum, and easy ones at the minimum") {
  for (const uint32_t side : {8u, 16u}) {
    CAPTURE(side);
    constexpr uint32_t k_slots = 8192;
    const AdaptiveOptions options{
        .tile = side, .target_error = 0.05f, .min_samples = 32, .max_samples = 500, .slots = k_slots};
    Player p{AdaptiveSchedule(17, 11, options), {}, {}};
    // A hard corner that needs 400 samples, one that would need 10 000, the rest easy.
    const uint32_t hard = 0, hopeless = uint32_t(p.schedule.tiles().size()) - 1;
    const auto sigma = [&](uint32_t t) { return t == hard ? 1.0 : t == hopeless ? 5.0 : 0.1; };
    p.play(sigma, k_slots);
    CHECK(p.samples.size() == 17 * 11);
    for (uint32_t t = 0; t < p.schedule.tiles().size(); ++t) {
      CAPTURE(t);
      const Tile& tile = p.schedule.tiles()[t];
      for (const uint32_t b : p.schedule.blocks_of(t)) CHECK(p.samples[b] == tile.samples);
      CHECK(tile.samples % 2 == 0);  // both halves of the film alike
      CHECK(tile.samples <= 500);
      if (t == hopeless) CHECK((tile.state == TileState::capped && tile.samples == 500));
      if (t == hard) CHECK((tile.state == TileState::done && tile.samples >= 400 && tile.samples < 500));
      if (t != hopeless) CHECK(tile.error <= 0.05f);
    }
    // Only neighbours of the hard ones continued beyond the minimum, and only while these were far above the
    // target.
    CHECK(p.schedule.count(TileState::capped) == 1);
    uint32_t beyond = 0;
    for (const Tile& tile : p.schedule.tiles()) beyond += tile.samples > 32;
    CHECK(beyond == 8);
    CHECK(p.schedule.least_samples() == 32);
    CHECK(p.schedule.most_samples() == 500);
  }
}

TEST_CASE("with few tiles left the samples per pixel double, so the device stays full") {
  constexpr uint32_t k_slots = 65536;  // 128 tiles of 64 pixels at 8 samples
  Player p{
      AdaptiveSchedule(
          32, 16,
          {.tile = 8, .target_error = 0.01f, .min_samples = 16, .max_samples = 1 << 14, .slots = k_slots}),
      {},
      {}};
  p.play([](uint32_t t) { return t % 64 == 0 ? 1.0 : 0.04; }, k_slots);
  size_t full = 0, after = 0;
  for (const WorkItem& item : p.items)
    if (item.blocks.size() < 100 && item.sample_count > 16) ++after, full += 2 * item.slots() >= k_slots;
  CHECK(after > 5);
  // All except the items that end at a tile's maximum.
  CHECK(full == after);
}

TEST_CASE("returned work is issued again; the same errors give the same schedule") {
  const AdaptiveOptions options{
      .tile = 16, .target_error = 0.05f, .min_samples = 8, .max_samples = 64, .slots = 2048};
  AdaptiveSchedule a(9, 7, options), b(9, 7, options);
  for (int i = 0; !a.done(); ++i) {
    const WorkItem item = a.next();
    if (i % 3 == 0) {
      a.give_back();
      const WorkItem again = a.next();
      REQUIRE(again.sample_count == item.sample_count);
      REQUIRE(again.blocks.size() == item.blocks.size());
    }
    const WorkItem other = b.next();
    REQUIRE(other.sample_count == item.sample_count);
    REQUIRE(other.blocks.front().index == item.blocks.front().index);
    std::vector<TileErrors> errors;
    for (const uint32_t t : a.to_report()) errors.push_back({.paths = 0.02f * float(1 + t % 5)});
    a.report(errors), b.report(errors);
  }
  CHECK(b.done());
}

TEST_CASE("options at their limits") {
  // A minimum above the maximum, odd numbers, a picture of one block, very few slots.
  Player p{
      AdaptiveSchedule(
          1, 1, {.tile = 16, .target_error = 0.1f, .min_samples = 1001, .max_samples = 77, .slots = 1024}),
      {},
      {}};
  p.play([](uint32_t) { return 1e-3; }, 1024);
  CHECK(p.schedule.tiles()[0].samples == 76);
  CHECK(p.schedule.tiles()[0].state == TileState::done);
  Player infinite{
      AdaptiveSchedule(2, 2,
                       {.tile = 8, .target_error = 0.1f, .min_samples = 4, .max_samples = 16, .slots = 64}),
      {},
      {}};
  infinite.play([](uint32_t) { return INFINITY; }, 64);
  CHECK(infinite.schedule.count(TileState::capped) == 4);
  CHECK(AdaptiveSchedule().done());
}

TEST_CASE("uniform: every block once per pass, no sample twice") {
  UniformSchedule u(21, 37, 64 * 4);
  std::map<uint32_t, uint32_t> samples;
  while (!u.done()) {
    const WorkItem item = u.next();
    for (const WorkBlock& b : item.blocks) {
      CHECK(b.first_sample == samples[b.index]);
      samples[b.index] += item.sample_count;
    }
  }
  CHECK(samples.size() == 21);
  for (const auto& [block, n] : samples) CHECK(n == 37);
}

TEST_CASE("another target continues the schedule: no sample is lost or taken unnecessarily") {
  constexpr uint32_t k_slots = 8192;
  AdaptiveOptions options{
      .tile = 16, .target_error = 0.1f, .min_samples = 32, .max_samples = 2000, .slots = k_slots};
  Player p{AdaptiveSchedule(16, 12, options), {}, {}};
  const auto sigma = [](uint32_t t) { return 0.2 + 0.02 * t; };
  p.play(sigma, k_slots);
  const std::map<uint32_t, uint32_t> loose = p.samples;
  const uint32_t rounds = p.schedule.rounds();
  CHECK(rounds > 3);

  // Lower: the hardest tiles continue from their samples (Player checks each first sample).
  options.target_error = 0.05f;
  p.schedule.retarget(options);
  CHECK_FALSE(p.schedule.done());
  p.play(sigma, k_slots);
  CHECK(p.schedule.rounds() > rounds);
  uint32_t more = 0;
  for (const auto& [block, samples] : p.samples) {
    CHECK(samples >= loose.at(block));
    more += samples > loose.at(block);
  }
  CHECK(more > 0);
  CHECK(more < p.samples.size());
  for (const Tile& tile : p.schedule.tiles()) CHECK(tile.error <= 0.05f);

  // Higher, and the same again: nothing remains to do.
  const std::map<uint32_t, uint32_t> tight = p.samples;
  p.schedule.retarget(options);
  CHECK(p.schedule.done());
  options.target_error = 0.2f;
  p.schedule.retarget(options);
  CHECK(p.schedule.done());
  CHECK(p.samples == tight);

  // A smaller maximum stops tiles above the target; a larger one continues them; so does a larger minimum.
  options.target_error = 0.02f, options.max_samples = 100;
  p.schedule.retarget(options);
  p.play(sigma, k_slots);
  CHECK(p.schedule.count(TileState::capped) > 0);
  options.max_samples = 4000;
  p.schedule.retarget(options);
  CHECK_FALSE(p.schedule.done());
  p.play(sigma, k_slots);
  for (const Tile& tile : p.schedule.tiles()) CHECK(tile.error <= 0.02f);
  options.min_samples = 3000;
  p.schedule.retarget(options);
  p.play(sigma, k_slots);
  CHECK(p.schedule.least_samples() >= 3000);
  CHECK(p.schedule.most_samples() <= 4000);
}

TEST_CASE("another target during a round") {
  constexpr uint32_t k_slots = 4096;  // several items per round
  AdaptiveOptions options{
      .tile = 8, .target_error = 0.1f, .min_samples = 16, .max_samples = 2000, .slots = k_slots};
  for (const uint32_t items : {1u, 5u, 17u, 40u}) {
    Player p{AdaptiveSchedule(9, 9, options), {}, {}};
    const auto sigma = [](uint32_t t) { return 0.5 + 0.02 * t; };
    for (uint32_t i = 0; i < items; ++i) {
      const WorkItem item = p.schedule.next();
      for (const WorkBlock& b : item.blocks) p.samples[b.index] += item.sample_count;
      std::vector<TileErrors> errors;
      for (const uint32_t t : p.schedule.to_report())
        errors.push_back(
            {.paths = float(sigma(t) / std::sqrt(p.schedule.tiles()[t].samples + item.sample_count))});
      p.schedule.report(errors);
    }
    AdaptiveOptions other = options;
    other.target_error = 0.06f;
    p.schedule.retarget(other);
    p.play(sigma, k_slots);
    for (const Tile& tile : p.schedule.tiles()) {
      CHECK(tile.error <= 0.06f);
      CHECK(tile.samples >= 16);
    }
  }
}

TEST_CASE("error that samples do not reduce: a tile ends when its sum is below the target, or as limited") {
  constexpr uint32_t k_slots = 64 * 64;
  const AdaptiveOptions options{
      .tile = 8, .target_error = 0.05f, .min_samples = 16, .max_samples = 4096, .slots = k_slots};
  // The error of records and interpolation in separate tiles: zero, half of the target, almost the target,
  // more than it.
  struct Floor {
    float records, interpolation;
    bool reached;
  };
  const std::map<uint32_t, Floor> floors{
      {0, {0, 0, true}}, {4, {0.025f, 0.01f, true}}, {8, {0.045f, 0, true}}, {44, {0.08f, 0.02f, false}}};
  AdaptiveSchedule s(9, 9, options);
  while (!s.done()) {
    const WorkItem item = s.next();
    std::vector<TileErrors> errors;
    for (const uint32_t t : s.to_report()) {
      const Floor f = floors.contains(t) ? floors.at(t) : Floor{};
      errors.push_back(
          {0.4f / std::sqrt(float(s.tiles()[t].samples + item.sample_count)), f.records, f.interpolation});
    }
    s.report(errors);
  }
  for (const auto& [t, f] : floors) {
    INFO("tile " << t);
    const Tile& tile = s.tiles()[t];
    CHECK(tile.state == (f.reached ? TileState::done : TileState::capped));
    CHECK(tile.limited(0.05f) == !f.reached);
    CHECK(tile.samples < 4096);
    // Just below the target; or where further samples do not help.
    if (f.reached) CHECK(tile.sum() <= 0.0501f);
    if (!f.reached) CHECK(tile.error <= (f.records + f.interpolation) / 3);
    if (!f.reached) CHECK(tile.sum() > 0.05f);
  }
  CHECK(s.tiles()[0].samples < s.tiles()[4].samples);
  CHECK(s.tiles()[4].samples < s.tiles()[8].samples);
  // A limited tile continues only as far as samples help.
  CHECK(s.tiles()[44].samples < s.tiles()[8].samples);
  CHECK(paths_goal(0.05f, 0, 0) == 0.05f);
  CHECK(std::hypot(paths_goal(0.05f, 0.03f, 0), 0.03f) == Approx(0.05f));
  CHECK(std::hypot(paths_goal(0.05f, 0.02f, 0.01f), 0.02f) + 0.01f == Approx(0.05f));
  CHECK(paths_goal(0.05f, 0.09f, 0.03f) == Approx(0.04f));
}

TEST_CASE(
    "uniform and adaptive sampling take over from each other at any time: no sample is lost or repeated") {
  constexpr uint32_t k_across = 9, k_down = 7, k_slots = 64 * 5;
  const auto sigma = [](uint32_t t) { return 0.3 + 0.05 * t; };
  const auto uniform = [&](UniformSchedule& u, std::map<uint32_t, uint32_t>& samples, int items) {
    while (!u.done() && items-- > 0) {
      const WorkItem item = u.next();
      REQUIRE_FALSE(item.blocks.empty());
      CHECK(item.slots() <= std::max(k_slots, 64 * item.sample_count));
      for (const WorkBlock& b : item.blocks) {
        CHECK(b.first_sample == samples[b.index]);
        samples[b.index] += item.sample_count;
      }
    }
  };
  const auto counts_agree = [](const std::vector<uint32_t>& counts,
                               const std::map<uint32_t, uint32_t>& samples) {
    for (uint32_t b = 0; b < counts.size(); ++b)
      if (counts[b] != (samples.contains(b) ? samples.at(b) : 0)) return false;
    return true;
  };
  const AdaptiveOptions options{
      .tile = 16, .target_error = 0.05f, .min_samples = 16, .max_samples = 200, .slots = k_slots};
  // After any number of items: none, during a pass, or all.
  for (const int items : {0, 1, 5, 13, 14, 40, 47, 1000}) {
    CAPTURE(items);
    std::map<uint32_t, uint32_t> samples;
    UniformSchedule first(k_across * k_down, 64, k_slots);
    uniform(first, samples, items);
    CHECK(counts_agree(first.counts(), samples));
    std::vector<TileErrors> errors;
    for (uint32_t t = 0; t < 5 * 4; ++t)
      errors.push_back({.paths = float(sigma(t) / std::sqrt(std::max(1u, first.complete())))});
    Player p{AdaptiveSchedule(k_across, k_down, options, first.counts(), errors), samples, {}};
    CHECK(p.schedule.least_samples() == first.complete());
    // An item that is not executed is issued again.
    const WorkItem item = p.schedule.next();
    p.schedule.give_back();
    const WorkItem again = p.schedule.next();
    p.schedule.give_back();
    REQUIRE(item.blocks.size() == again.blocks.size());
    for (size_t i = 0; i < item.blocks.size(); ++i) CHECK(item.blocks[i].index == again.blocks[i].index);
    p.play(sigma, k_slots);
    CHECK(counts_agree(p.schedule.counts(), p.samples));
    CHECK(p.schedule.least_samples() >= 16);
    for (uint32_t t = 0; t < p.schedule.tiles().size(); ++t) {
      const Tile& tile = p.schedule.tiles()[t];
      CHECK((tile.error <= 0.05f || tile.samples >= 200));
      for (const uint32_t b : p.schedule.blocks_of(t)) CHECK(p.samples.at(b) == tile.samples);
      // No sample is taken unnecessarily.
      if (items == 1000 && sigma(t) / 8 < 0.025) CHECK(tile.samples == 64);
    }
    // Back to uniform: the other blocks catch up.
    UniformSchedule last(p.schedule.counts(), 150, k_slots);
    CHECK(last.complete() == p.schedule.least_samples());
    const std::map<uint32_t, uint32_t> before = p.samples;
    uniform(last, p.samples, 100000);
    CHECK(last.done());
    for (const auto& [block, n] : p.samples) CHECK(n == std::max(150u, before.at(block)));
  }
  // If all blocks have the same number the schedule continues as usual.
  UniformSchedule plain(12, 40, k_slots), resumed(std::vector<uint32_t>(12, 8), 40, k_slots);
  while (plain.complete() < 8) plain.next();
  while (!plain.done()) {
    const WorkItem a = plain.next(), b = resumed.next();
    CHECK(a.sample_count == b.sample_count);
    REQUIRE(a.blocks.size() == b.blocks.size());
  }
  CHECK(resumed.done());
}

TEST_CASE("items of one sample: all their blocks have the same next sample, whichever is behind") {
  constexpr uint32_t k_slots = 4096;
  AdaptiveOptions options{.tile = 16,
                          .target_error = 0.3f,
                          .min_samples = 4,
                          .max_samples = 20,
                          .slots = k_slots,
                          .one_sample = true};
  const auto all_alike = [](const Player& p) {
    for (const WorkItem& item : p.items) {
      REQUIRE(item.sample_count == 1);
      for (const WorkBlock& b : item.blocks) REQUIRE(b.first_sample == item.blocks[0].first_sample);
    }
  };
  const auto sigma = [](uint32_t t) { return 0.2 + 0.1 * double(t % 9); };
  Player p{AdaptiveSchedule(13, 9, options), {}, {}};
  p.play(sigma, k_slots);
  all_alike(p);
  // After another target tiles with more samples lie beside others with fewer.
  options.target_error = 0.001f;
  p.schedule.retarget(options);
  p.play(sigma, k_slots);
  all_alike(p);
  for (const auto& [block, samples] : p.samples) CHECK(samples == 20);
  // Taken over from counts that differ within a tile.
  std::vector<uint32_t> have(13 * 9);
  Player later{{}, {}, {}};
  for (uint32_t b = 0; b < have.size(); ++b) later.samples[b] = have[b] = (b * 7) % 11;
  const std::vector<TileErrors> errors(7 * 5, TileErrors{1, 0, 0});
  later.schedule = AdaptiveSchedule(13, 9, options, have, errors);
  later.play(sigma, k_slots);
  all_alike(later);
  for (const auto& [block, samples] : later.samples) CHECK(samples == 20);
  // Uniform.
  UniformSchedule uniform(117, 8, k_slots, true);
  std::vector<uint32_t> samples(117, 0);
  while (!uniform.done()) {
    const WorkItem item = uniform.next();
    REQUIRE(item.sample_count == 1);
    for (const WorkBlock& b : item.blocks) {
      REQUIRE(b.first_sample == item.blocks[0].first_sample);
      CHECK(b.first_sample == samples[b.index]++);
    }
  }
  for (const uint32_t n : samples) CHECK(n == 8);
}

TEST_CASE("samples requested later, more or fewer, are taken exactly once") {
  const auto run = [](UniformSchedule& u, std::vector<uint32_t>& next) {
    while (!u.done()) {
      const WorkItem item = u.next();
      for (const WorkBlock& b : item.blocks) {
        CHECK(b.first_sample == next[b.index]);
        next[b.index] += item.sample_count;
      }
    }
  };
  std::vector<uint32_t> have(12, 0);
  UniformSchedule u(12, 64, 64 * 64);
  run(u, have);
  for (const uint32_t more : {70u, 71u, 128u}) {
    u.set_samples(more);
    run(u, have);
    CHECK(u.complete() == more);
    CHECK(have == std::vector<uint32_t>(12, more));
  }
  u.set_samples(8);
  CHECK(u.done());
  CHECK(u.complete() == 128);
  CHECK(u.counts() == have);
  // Also during a pass.
  u.set_samples(200);
  for (const WorkBlock& b : u.next().blocks) have[b.index] = u.counts()[b.index];
  u.set_samples(8);
  CHECK(u.done());
  CHECK(u.counts() == have);
  u.set_samples(300);
  run(u, have);
  CHECK(have == std::vector<uint32_t>(12, 300));
}

TEST_CASE("uniform passes end at every power of two, whatever fits into an item") {
  for (const uint32_t slots : {64u, 64u * 100, 64u * 1000, 64u * 12 * 27}) {
    UniformSchedule u(12, 600, slots);
    std::vector<uint32_t> ends;
    while (!u.done()) {
      u.next();
      if (ends.empty() || ends.back() != u.complete()) ends.push_back(u.complete());
    }
    for (uint32_t power = 1; power <= 512; power *= 2)
      CHECK(std::find(ends.begin(), ends.end(), power) != ends.end());
    CHECK(u.complete() == 600);
  }
}

}  // namespace schedule_adaptive_tests
