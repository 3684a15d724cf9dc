// links: gpu
// The low-discrepancy points of shaders/lib/sampler.glsl: stratified within a pixel, and independent between
// pixels, halves, pads and seeds.
#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <functional>
#include <set>

#include "gpu/stream.h"
#include "kernels/statistics_support.h"

namespace sampler_sobol_tests {

using namespace lucerna;
using namespace lucerna::test;

namespace {

struct Place {
  uint32_t pixel, sample, seed, pad;
  uint32_t width = 64;  ///< of the picture; used by coherent sampling only
};
struct Point {
  uint32_t bits[2];
  float unit[2];
};

gpu::Device& device() {
  static gpu::Device instance({"", true});
  return instance;
}

std::vector<Point> points(const std::vector<Place>& places, const gpu::Defines& defines = {}) {
  static gpu::ShaderCompiler compiler;
  const gpu::Kernel kernel(device(), compiler,
                           std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/sampler_probe.comp",
                           defines);
  gpu::Buffer in(device(), {"places", places.size() * sizeof(Place)}),
      out(device(), {"points", places.size() * sizeof(Point)});
  in.write(std::span<const Place>(places));
  gpu::Resources resources;
  resources.set("Places", in);
  resources.set("Points", out);
  gpu::Stream stream(device());
  const auto count = static_cast<uint32_t>(places.size());
  stream.dispatch(kernel, resources, count, gpu::groups_for(count, 64));
  stream.run();
  return out.read_all<Point>();
}

/// Points of one half of a pixel: `count` from index `first` of that half's sequence.
std::vector<Place> run_of(uint32_t pixel, uint32_t half, uint32_t seed, uint32_t pad, uint32_t first,
                          uint32_t count) {
  std::vector<Place> places;
  for (uint32_t i = first; i < first + count; ++i) places.push_back({pixel, 2 * i + half, seed, pad});
  return places;
}

/// Shapes (2^-a x 2^-b, a + b = k) with a cell that does not contain exactly one of the 2^k points.
int uneven_shapes(const Point* p, int k) {
  int uneven = 0;
  std::vector<bool> seen;
  for (int a = 0; a <= k; ++a) {
    seen.assign(size_t(1) << k, false);
    bool even = true;
    for (size_t i = 0; i < seen.size(); ++i) {
      const uint64_t x = uint64_t(p[i].bits[0]) >> (32 - a), y = uint64_t(p[i].bits[1]) >> (32 - (k - a));
      const size_t cell = (x << (k - a)) | y;
      even = even && !seen[cell];
      seen[cell] = true;
    }
    uneven += !even;
  }
  return uneven;
}

/// Significance of the histogram of pairs on a grid of `cells` x `cells` for independent uniform numbers:
/// neither less even than random, nor more even (a lattice).
double uniform_tail(const std::vector<std::pair<uint32_t, uint32_t>>& pairs, uint32_t cells) {
  std::vector<double> observed(size_t(cells) * cells, 0.0);
  for (const auto& [x, y] : pairs)
    observed[(uint64_t(x) * cells >> 32) * cells + (uint64_t(y) * cells >> 32)] += 1;
  const double each = double(pairs.size()) / double(observed.size());
  const double p = chi_square(observed, std::vector<double>(observed.size(), each)).p;
  return 2 * std::min(p, 1 - p);
}

}  // namespace

TEST_CASE("every aligned run of 2^k points has one in each elementary interval") {
  constexpr uint32_t k_run = 1 << 12;
  for (const uint32_t pixel : {0u, 1u, 518399u})
    for (const uint32_t half : {0u, 1u})
      for (const uint32_t pad : {0u, 5u, 331u, 0x10000u})
        for (const uint32_t first : {0u, 3 * k_run, 1u << 19}) {
          const auto p = points(run_of(pixel, half, pixel + pad, pad, first, k_run));
          for (const int k : {1, 2, 3, 5, 8, 12}) {
            int uneven = 0;
            for (size_t at = 0; at < p.size(); at += size_t(1) << k) uneven += uneven_shapes(&p[at], k);
            INFO("pixel " << pixel << ", half " << half << ", pad " << pad << ", first " << first << ", k "
                          << k);
            CHECK(uneven == 0);
          }
        }
}

TEST_CASE("every aligned run of 2^20 points has one in each elementary interval") {
  const auto p = points(run_of(77, 1, 3, 4, 0, 1 << 20));
  CHECK(uneven_shapes(p.data(), 20) == 0);
}

TEST_CASE("a point is its bits, and less than 1") {
  for (const Point& p : points(run_of(4711, 0, 9, 1, 0, 1 << 14)))
    for (int d = 0; d < 2; ++d) {
      const float expected = static_cast<float>(p.bits[d] >> 8) * 0x1p-24f;
      if (p.unit[d] != expected || !(p.unit[d] < 1)) FAIL(p.unit[d] << " for " << p.bits[d]);
    }
  const auto ends = points({{0xffffffffu, 0, 0, 0}, {0xffffff00u, 0xffu, 0, 0}}, {{"TEST_UNIT", "1"}});
  CHECK(ends[0].unit[0] == 1 - 0x1p-24f);
  CHECK(ends[0].unit[1] == 0);
  CHECK(ends[1].unit[0] == 1 - 0x1p-24f);
  CHECK(ends[1].unit[1] == 0);
}

TEST_CASE("pixels, halves, pads and seeds are independent: chi^2 over pairs") {
  // Each pair of places gives one pair of numbers; the places differ in one respect, and another respect
  // counts.
  struct Relation {
    const char* name;
    std::function<std::pair<Place, Place>(uint32_t)> pair;
  };
  const Relation relations[] = {{"neighbouring pixels",
                                 [](uint32_t i) {
                                   return std::pair{Place{2 * i, 0, 1, 0}, Place{2 * i + 1, 0, 1, 0}};
                                 }},
                                {"pixels a row apart",
                                 [](uint32_t i) {
                                   return std::pair{Place{i, 6, 1, 3}, Place{i + 1920, 6, 1, 3}};
                                 }},
                                {"the halves of a pixel",
                                 [](uint32_t i) {
                                   return std::pair{Place{i, 0, 1, 2}, Place{i, 1, 1, 2}};
                                 }},
                                {"the halves, later",
                                 [](uint32_t i) {
                                   return std::pair{Place{i, 998, 1, 2}, Place{i, 999, 1, 2}};
                                 }},
                                {"seeds, same pixel",
                                 [](uint32_t i) {
                                   return std::pair{Place{5, 4, i, 0}, Place{5, 4, i + 1, 0}};
                                 }},
                                {"seeds, all pixels",
                                 [](uint32_t i) {
                                   return std::pair{Place{i, 0, 0, 0}, Place{i, 0, 1, 0}};
                                 }},
                                {"pads of one vertex",
                                 [](uint32_t i) {
                                   return std::pair{Place{i, 2, 7, 4}, Place{i, 2, 7, 5}};
                                 }},
                                {"pixel and direction",
                                 [](uint32_t i) {
                                   return std::pair{Place{i, 2, 7, 0}, Place{i, 2, 7, 5}};
                                 }},
                                {"the same pad, one vertex on",
                                 [](uint32_t i) {
                                   return std::pair{Place{i, 2, 7, 5}, Place{i, 2, 7, 10}};
                                 }},
                                {"null events",
                                 [](uint32_t i) {
                                   return std::pair{Place{i, 2, 7, 0x10000}, Place{i, 2, 7, 0x10001}};
                                 }},
                                {"late samples",
                                 [](uint32_t i) {
                                   return std::pair{Place{i, 1 << 20, 7, 5}, Place{i, (1 << 20) + 2, 7, 9}};
                                 }},
                                {"pixel and seed changed alike", [](uint32_t i) {
                                   return std::pair{Place{i, 0, i, 0}, Place{i + 1, 0, i + 1, 0}};
                                 }}};
  constexpr uint32_t k_pairs = 1 << 17;
  Jury jury;
  for (const Relation& relation : relations) {
    std::vector<Place> places;
    for (uint32_t i = 0; i < k_pairs; ++i) {
      const auto [a, b] = relation.pair(i);
      places.push_back(a), places.push_back(b);
    }
    const auto p = points(places);
    for (const int d : {0, 1})
      for (const int e : {0, 1}) {
        std::vector<std::pair<uint32_t, uint32_t>> pairs;
        for (uint32_t i = 0; i < k_pairs; ++i) pairs.emplace_back(p[2 * i].bits[d], p[2 * i + 1].bits[e]);
        jury.add(fmt::format("{}, dimensions {} and {}", relation.name, d, e), uniform_tail(pairs, 64));
      }
    // The two dimensions of one point.
    std::vector<std::pair<uint32_t, uint32_t>> own;
    for (uint32_t i = 0; i < k_pairs; ++i) own.emplace_back(p[2 * i].bits[0], p[2 * i].bits[1]);
    jury.add(fmt::format("{}, one point", relation.name), uniform_tail(own, 64));
  }
  CHECK(jury.verdict() == "");
}

TEST_CASE("within a pixel, pads and halves are shuffled independently: chi^2 up to sample 2^20") {
  // One of sixteen successive points: then the strata of two pads determine nothing together, and pairs of
  // sixteenths are independent and uniform.
  constexpr uint32_t k_pairs = 1 << 15, k_step = 16;
  struct Pair {
    uint32_t half_a, pad_a, half_b, pad_b;
  };
  Jury jury;
  for (const uint32_t pixel : {0u, 1u, 1000003u})
    for (const Pair& pair :
         {Pair{0, 0, 0, 5}, Pair{0, 5, 0, 10}, Pair{1, 4, 1, 5}, Pair{0, 5, 1, 5}, Pair{0, 0, 1, 0}}) {
      std::vector<Place> places;
      for (uint32_t i = 0; i < k_pairs; ++i) {
        places.push_back({pixel, 2 * k_step * i + pair.half_a, 1, pair.pad_a});
        places.push_back({pixel, 2 * k_step * i + pair.half_b, 1, pair.pad_b});
      }
      const auto p = points(places);
      for (const int d : {0, 1})
        for (const int e : {0, 1}) {
          std::vector<std::pair<uint32_t, uint32_t>> pairs;
          for (uint32_t i = 0; i < k_pairs; ++i) pairs.emplace_back(p[2 * i].bits[d], p[2 * i + 1].bits[e]);
          jury.add(fmt::format("pixel {}, half {} pad {} dimension {} and half {} pad {} dimension {}", pixel,
                               pair.half_a, pair.pad_a, d, pair.half_b, pair.pad_b, e),
                   uniform_tail(pairs, 16));
        }
    }
  CHECK(jury.verdict() == "");
}

TEST_CASE(
    "coherent sampling: a pixel's points stay even, its tile's are shared, its neighbour tile's differ") {
  for (const char* side : {"3", "4"}) {
    const gpu::Defines coherent{{"LUCERNA_COHERENT", side}};
    const uint32_t tile = 1u << std::stoul(side);
    CAPTURE(tile);
    for (const uint32_t pixel : {0u, 777u})
      for (const uint32_t half : {0u, 1u}) {
        const auto p = points(run_of(pixel, half, 5, 5, 0, 1 << 12), coherent);
        for (const int k : {1, 2, 3, 5, 8, 12}) CHECK(uneven_shapes(p.data(), k) == 0);
      }
    // One sample of all pixels of 1024 tiles in a picture 16 tiles wide.
    const uint32_t width = 16 * tile, rows = 64 * tile;
    std::vector<Place> places;
    for (uint32_t pixel = 0; pixel < width * rows; ++pixel) places.push_back({pixel, 6, 3, 5, width});
    const auto p = points(places, coherent);
    Jury jury;
    for (const int d : {0, 1}) {
      std::vector<std::pair<uint32_t, uint32_t>> beside, across, low, own;
      size_t apart = 0, alike = 0;
      for (uint32_t i = 0; i + 1 < p.size(); i += 2) {
        const uint32_t a = p[i].bits[d], b = p[i + 1].bits[d];  // side by side in one tile
        apart += a >> 28 != b >> 28;
        alike += a == b;
        low.emplace_back(a << 4, b << 4);
      }
      CHECK(apart == 0);
      CHECK(alike < 3);
      jury.add(fmt::format("dimension {}, digits below the shared ones", d), uniform_tail(low, 64));
      // One pixel of each tile, compared with the tile to the right and the one below.
      for (uint32_t y = 0; y + tile < rows; y += tile)
        for (uint32_t x = 0; x + tile < width; x += tile) {
          const uint32_t i = y * width + x;
          beside.emplace_back(p[i].bits[d], p[i + tile].bits[d]);
          across.emplace_back(p[i].bits[d], p[i + tile * width].bits[d]);
          own.emplace_back(p[i].bits[0], p[i].bits[1]);
        }
      jury.add(fmt::format("dimension {}, tiles side by side", d), uniform_tail(beside, 8));
      jury.add(fmt::format("dimension {}, tiles above each other", d), uniform_tail(across, 8));
      jury.add("one pixel's two dimensions over tiles", uniform_tail(own, 8));
    }
    CHECK(jury.verdict() == "");
  }
}

TEST_CASE("no two purposes of a path draw from the same pad") {
  std::vector<Place> places;
  for (uint32_t depth = 0; depth <= 64; ++depth)
    for (uint32_t what = 0; what < 5; ++what) places.push_back({12, 34, 56, depth * 256 + what});
  std::set<std::pair<uint32_t, uint32_t>> seen;
  for (const Point& p : points(places, {{"TEST_VERTEX", "1"}})) {
    seen.insert({p.bits[0], p.bits[1]});
    CHECK(p.unit[0] == static_cast<float>(p.bits[0] >> 8) * 0x1p-24f);
  }
  // Pixel, lens, and the null events of some vertices beside them.
  std::vector<Place> others{{12, 34, 56, 0}, {12, 34, 56, 1}};
  for (uint32_t depth = 0; depth <= 64; ++depth)
    for (const uint32_t null : {0u, 1u, 255u}) others.push_back({12, 34, 56, 0x10000 + depth * 256 + null});
  for (const Point& p : points(others)) seen.insert({p.bits[0], p.bits[1]});
  CHECK(seen.size() == places.size() + others.size());
}

TEST_CASE("there were no validation messages: sampler sobol") { CHECK(device().validation_messages() == 0); }

}  // namespace sampler_sobol_tests
