// links: irradiance_cache
// Which candidates become records: the device chooses like a plain program on the host, bit for bit; all
// candidates are covered, few are chosen.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>

#include "kernels/gpu_support.h"
#include "solvers/irradiance_cache/placement.h"
#include "support/records.h"

namespace cache_choice_tests {

using namespace lucerna;
using namespace lucerna::irradiance_cache;

namespace {

uint32_t mix(uint32_t x) {
  x ^= x >> 16, x *= 0x7feb352du;
  x ^= x >> 15, x *= 0x846ca68bu;
  return x ^ x >> 16;
}
uint32_t priority(uint32_t seed, uint32_t v) {
  return mix(seed ^ (v * 0x9e3779b9u + 0x7f4a7c15u + (seed << 6) + (seed >> 2)));
}
int exponent_of(float x) { return int(std::bit_cast<uint32_t>(x) >> 23 & 0xff) - 127; }

uint64_t code(const vec3& p, const vec3& origin, int exponent) {
  uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float offset = p[axis] - origin[axis], scaled = offset * std::ldexp(1.0f, -exponent);
    const uint32_t cell = std::min(uint32_t(scaled), (1u << shared::k_morton_bits) - 1);
    for (uint32_t b = 0; b < shared::k_morton_bits; ++b)
      key |= uint64_t(cell >> b & 1) << (3 * b + uint32_t(axis));
  }
  return key;
}

/// The same as Placement, one candidate after the other.
Choice choose_plainly(const std::vector<Place>& points, const ChoiceOptions& o) {
  Choice all;
  if (points.empty()) return all;
  vec3 lo = points[0].position, hi = lo;
  for (const Place& p : points) lo = glm::min(lo, p.position), hi = glm::max(hi, p.position);
  const vec3 extent = hi - lo;
  const int exponent =
      exponent_of(std::max({extent.x, extent.y, extent.z, 1e-20f})) + 1 - int(shared::k_morton_bits);
  std::vector<std::pair<uint64_t, uint32_t>> order;
  for (uint32_t i = 0; i < points.size(); ++i) order.emplace_back(code(points[i].position, lo, exponent), i);
  std::sort(order.begin(), order.end());
  const std::vector<std::pair<uint64_t, uint32_t>> sorted = order;
  const auto bits = [&](uint32_t i) {
    return 3 * std::clamp(exponent_of(4 * points[i].reach) - exponent, 0, int(shared::k_morton_bits));
  };
  std::vector<uint32_t> chosen;
  for (int round = 0; round < 6; ++round) {
    chosen.clear();
    std::vector<std::pair<uint64_t, uint32_t>> kept;
    uint32_t cluster = 0;
    for (size_t first = 0; first < order.size();) {
      size_t end = first + 1;
      while (end < order.size() && end % shared::k_cluster_most != 0 &&
             (order[end].first ^ order[end - 1].first) >>
                     std::min(bits(order[end].second), bits(order[end - 1].second)) ==
                 0)
        ++end;
      if (round == 0) all.cluster.insert(all.cluster.end(), end - first, cluster++);
      std::vector<uint32_t> left, picks;
      for (size_t i = first; i < end; ++i) left.push_back(order[i].second);
      while (!left.empty()) {
        const uint32_t pick = *std::max_element(left.begin(), left.end(), [&](uint32_t a, uint32_t b) {
          return priority(o.seed, a) < priority(o.seed, b);
        });
        picks.push_back(pick);
        std::erase_if(left, [&](uint32_t c) {
          const vec3 d = points[c].position - points[pick].position, s = d * d,
                     a = points[c].normal * points[pick].normal;
          const float reach = std::min(points[c].reach, points[pick].reach);
          return c == pick ||
                 ((s.x + s.y) + s.z <= reach * reach && 1 - ((a.x + a.y) + a.z) <= o.normal_tolerance);
        });
      }
      for (size_t i = first; i < end; ++i)
        if (std::find(picks.begin(), picks.end(), order[i].second) != picks.end()) kept.push_back(order[i]);
      first = end;
    }
    for (const auto& k : kept) chosen.push_back(k.second);
    if (kept.size() == order.size()) break;
    order = kept;
  }
  for (const auto& [key, i] : sorted) all.candidates.push_back(points[i]);
  for (uint32_t i = 0; i < sorted.size(); ++i)
    if (std::find(chosen.begin(), chosen.end(), sorted[i].second) != chosen.end()) all.chosen.push_back(i);
  return all;
}

bool same(const Place& x, const Place& y) {
  return x.position == y.position && x.normal == y.normal && x.facet == y.facet && x.origin == y.origin &&
         x.reach == y.reach;
}
bool same(const std::vector<Place>& a, const std::vector<Place>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Place& x, const Place& y) { return same(x, y); });
}

struct Bench {
  test::SilentDevice silent;
  gpu::ShaderCompiler compiler;
  gpu::Stream stream{silent.device};
  Placement placement{silent.device, compiler};

  std::vector<Place> choose(const std::vector<Place>& points, const ChoiceOptions& options) {
    placement.clear();
    placement.add(stream, points);
    return placement.choose(stream, options);
  }
};

}  // namespace

TEST_CASE("the device chooses the same candidates as the host") {
  Bench bench;
  std::mt19937 random(11);
  for (const size_t count : {size_t{1}, size_t{2}, size_t{239}, size_t{240}, size_t{241}, size_t{3000}})
    for (const float offset : {0.0f, 10000.0f})
      for (const bool mixed : {false, true}) {
        std::vector<Place> points = test::box_points(count, offset, 0.3f);
        for (Place& p : points)
          if (mixed) p.reach = 0.02f * std::pow(50.0f, float(random() >> 8) / 16777216.0f);
        const ChoiceOptions options{.seed = uint32_t(count) + mixed};
        const std::vector<Place> chosen = bench.choose(points, options);
        const Choice found = bench.placement.choice(), expected = choose_plainly(points, options);
        INFO(count << " points at " << offset << (mixed ? ", mixed reach" : ""));
        CHECK(same(found.candidates, expected.candidates));
        CHECK(found.cluster == expected.cluster);
        CHECK(found.chosen == expected.chosen);
        std::vector<Place> listed;
        for (const uint32_t i : found.chosen) listed.push_back(found.candidates[i]);
        CHECK(same(chosen, listed));
        CHECK(same(bench.choose(points, options), chosen));
      }
}

TEST_CASE("every candidate is near a chosen one of the same orientation") {
  Bench bench;
  const std::vector<Place> points = test::box_points(20000, 0, 0.25f);
  const std::vector<Place> chosen = bench.choose(points, {.seed = 3});
  INFO(chosen.size() << " of " << points.size());
  size_t uncovered = 0;
  for (const Place& p : points) {
    float nearest = 1e9f;
    for (const Place& c : chosen)
      if (dot(p.normal, c.normal) > 0.98f) nearest = std::min(nearest, distance(p.position, c.position));
    // A cluster that exceeded its maximum may have dropped the candidate's representative.
    REQUIRE(nearest <= 2 * 0.25f);
    uncovered += nearest > 0.25f;
  }
  CHECK(uncovered < points.size() / 50);
  // 94 square metres; discs of that radius packed as densely as random packing allows, twice that across the
  // borders of clusters.
  CHECK(chosen.size() > 94 / (3.14159 * 0.25 * 0.25));
  CHECK(chosen.size() < 6 * 94 / (3.14159 * 0.25 * 0.25));
  CHECK_FALSE(same(chosen, bench.choose(points, {.seed = 4})));
}

TEST_CASE("too few record slots are distributed over the clusters") {
  Bench bench;
  const std::vector<Place> points = test::box_points(20000, 0, 0.1f);
  const std::vector<Place> few = bench.choose(points, {.most = 200});
  CHECK(few.size() <= 200);
  CHECK(few.size() > 150);
  // All over the box, not in one corner.
  for (int axis = 0; axis < 3; ++axis) {
    float lo = 1e9f, hi = -1e9f;
    for (const Place& p : few) lo = std::min(lo, p.position[axis]), hi = std::max(hi, p.position[axis]);
    CHECK(lo < 0.3f);
    CHECK(hi > 2.7f);
  }
  CHECK(bench.choose({}, {}).empty());
  CHECK(bench.choose(points, {.most = 0}).empty());
  // One place with many candidates: chosen once per orientation.
  std::vector<Place> one(50);
  for (size_t i = 0; i < one.size(); ++i) one[i].normal = vec3(0, i % 2 ? 1 : -1, 0), one[i].reach = 0.1f;
  CHECK(bench.choose(one, {}).size() == 2);
}

TEST_CASE("candidates are collected block by block, whatever number of blocks is probed at once") {
  // Slots are ordered by sample and block: `number` is a slot's position among all.
  constexpr uint32_t k_samples = 3, k_blocks = 4;
  const auto order = [&](uint32_t at_once) {
    Bench bench;
    for (uint32_t first = 0; first < k_blocks; first += at_once) {
      std::vector<vec4> slots;
      for (uint32_t sample = 0; sample < k_samples; ++sample)
        for (uint32_t pixel = 64 * first; pixel < 64 * (first + at_once); ++pixel) {
          const uint32_t number = (pixel / 64 * k_samples + sample) * 64 + pixel % 64;
          slots.push_back(vec4(float(number), 0, 0, 1));
          slots.push_back(vec4(0, 1, 0, 0));
        }
      gpu::Buffer buffer(bench.silent.device,
                         {.name = "slots", .bytes = slots.size() * sizeof(vec4), .texel = true});
      buffer.write(std::span<const vec4>(slots));
      bench.placement.collect(bench.stream, buffer, 64 * at_once * k_samples, k_samples, true, {});
    }
    std::vector<float> found;
    for (const Place& p : bench.placement.choice().candidates) found.push_back(p.position.x);
    return found;
  };
  std::vector<float> expected(64 * k_blocks * k_samples);
  std::iota(expected.begin(), expected.end(), 0.0f);
  for (const uint32_t at_once : {1u, 2u, 4u}) CHECK(order(at_once) == expected);
}

TEST_CASE(
    "candidates are collected in the order of their slots, including directly visible ones if requested") {
  Bench bench;
  std::vector<vec4> slots(2 * 200, vec4(0));
  std::mt19937 random(3);
  uint32_t by_origin[4][3] = {}, in_all[3] = {};
  for (uint32_t i = 0; i < 200; ++i) {
    if (random() % 2) continue;
    const uint32_t origin = random() % 3;
    ++by_origin[i / 64][origin], ++in_all[origin];
    slots[2 * i] = vec4(float(i), 0, 0, 1 + float(origin));
    slots[2 * i + 1] = vec4(0, 1, 0, std::bit_cast<float>(i));
  }
  gpu::Buffer buffer(bench.silent.device,
                     {.name = "slots", .bytes = slots.size() * sizeof(vec4), .texel = true});
  buffer.write(std::span<const vec4>(slots));
  const ReachOptions reach{
      .spacing = 0.001f, .spacing_beyond = 20, .spacing_of_distance = 0.1f, .eye = vec3(-5, 0, 0)};
  for (const bool screen_too : {true, false}) {
    bench.placement.clear();
    for (int twice = 0; twice < 2; ++twice) {
      const auto collected = bench.placement.collect(bench.stream, buffer, 200, 1, screen_too, reach);
      REQUIRE(collected.size() == 4);
      for (uint32_t k = 0; k < 3; ++k)
        for (uint32_t block = 0; block < 4; ++block) CHECK(collected[block][k] == by_origin[block][k]);
    }
    const uint32_t each = in_all[1] + in_all[2] + (screen_too ? in_all[0] : 0);
    REQUIRE(bench.placement.size() == 2 * each);
    CHECK(bench.placement.choice().candidates.size() == 2 * each);
    CHECK(bench.placement.choice().cluster.empty());
    CHECK(bench.placement.clusters() == 0);
    bench.placement.choose(bench.stream, {});
    CHECK(bench.placement.clusters() == bench.placement.choice().cluster.back() + 1);
    // Twice along a line: when sorted, each place occurs twice.
    const Choice all = bench.placement.choice();
    uint32_t at = 0;
    for (uint32_t i = 0; i < 200; ++i) {
      const uint32_t reported = uint32_t(slots[2 * i].w);
      if (reported == 0 || (reported == 1 && !screen_too)) continue;
      for (int twice = 0; twice < 2; ++twice, ++at) {
        CHECK(all.candidates[at].position.x == float(i));
        CHECK(all.candidates[at].facet == i);
        CHECK(all.candidates[at].origin == reported - 1);
        CHECK(all.candidates[at].reach ==
              Approx(std::max(reported == 3 ? 20.0f : 0.001f, 0.1f * (float(i) + 5))));
      }
    }
    CHECK(at == 2 * each);
  }
}

}  // namespace cache_choice_tests
