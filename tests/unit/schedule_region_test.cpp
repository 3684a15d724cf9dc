// links: schedule
// Regions: their text, their pixels and blocks, and schedules that give samples to them alone.
#include <catch2/catch.hpp>
#include <map>

#include "base/error.h"
#include "schedule/adaptive.h"
#include "schedule/region.h"
#include "schedule/uniform.h"

namespace schedule_region_tests {

using namespace lucerna;
using namespace lucerna::schedule;
using Catch::Contains;

TEST_CASE("a region is read from its text and written so that it is read again") {
  CHECK_FALSE(parse_region("", "x"));
  CHECK_FALSE(parse_region("  ", "x"));
  const auto r = parse_region("0.25, 0.5,0.125,0.25", "x");
  REQUIRE(r);
  CHECK(*r == Region{0.25, 0.5, 0.125, 0.25});
  CHECK(parse_region(region_text(*r), "x") == r);
  CHECK(*parse_region("-0.5,0.75,1,1", "x") == Region{0, 0.75, 0.5, 0.25});
  for (const char* text : {"1", "a,b,c,d", "0,0,1", "0,0,1,1,1", "0,0,nan,1", "0,0,inf,1", "0,0,1,",
                           "0 0 1 1", "0,0,1,1x", ",,,"})
    CHECK_THROWS_WITH(parse_region(text, "here"),
                      Contains("here: '") && Contains("expected LEFT,TOP,WIDTH,HEIGHT"));
  for (const char* text : {"0,0,0,1", "0,0,1,-1", "1,0,1,1", "0,2,1,1", "-1,0,1,1"})
    CHECK_THROWS_WITH(parse_region(text, "here"), Contains("nothing of it is in the picture"));
}

TEST_CASE("a region has the nearest pixels, and all blocks that contain one of them") {
  CHECK(pixels_of({0.25, 0.5, 0.5, 0.25}, 64, 48) == Rectangle{16, 24, 48, 36});
  CHECK(pixels_of({0, 0, 1, 1}, 17, 9) == Rectangle{0, 0, 17, 9});
  CHECK(pixels_of({0.999, 0.999, 1e-6, 1e-6}, 20, 20) == Rectangle{19, 19, 20, 20});
  CHECK(pixels_of({0.3, 0.3, 1e-9, 1e-9}, 1, 1) == Rectangle{0, 0, 1, 1});
  // Any pixels are found again in their fractions, as --region passes them.
  for (const uint32_t size : {7u, 640u, 32768u})
    for (uint32_t at = 0; at < size; at += 1 + size / 50) {
      const Region part{at / double(size), at / double(size), 1 / double(size), 1 / double(size)};
      CHECK(pixels_of(*parse_region(region_text(part), ""), size, size) == Rectangle{at, at, at + 1, at + 1});
    }
  CHECK(blocks_of({16, 24, 48, 36}) == Rectangle{2, 3, 6, 5});
  CHECK(blocks_of({7, 7, 9, 9}) == Rectangle{0, 0, 2, 2});
  CHECK(blocks_of(Rectangle{}).right >= (1u << 28));
  CHECK(indices_of({1, 1, 3, 3}, 3, 2) == std::vector<uint32_t>{4, 5});
  CHECK(indices_of({}, 2, 2) == std::vector<uint32_t>{0, 1, 2, 3});
}

namespace {

/// Adds the samples of an item; checks that none is repeated or left out.
void take(const WorkItem& item, std::map<uint32_t, uint32_t>& samples) {
  for (const WorkBlock& b : item.blocks) {
    CHECK(b.first_sample == samples[b.index]);
    samples[b.index] += item.sample_count;
  }
}

}  // namespace

TEST_CASE("uniform sampling of a region leaves the rest alone, and continues with all") {
  for (const bool one : {false, true}) {
    CAPTURE(one);
    std::map<uint32_t, uint32_t> samples;
    UniformSchedule whole(std::vector<uint32_t>(6, 0), 100, 640, one);
    while (whole.complete() < 2) take(whole.next(), samples);
    UniformSchedule part(whole.counts(), {1, 4}, 16, 640, one);
    CHECK(part.complete() == samples[1]);
    const std::map<uint32_t, uint32_t> before = samples;
    while (!part.done()) take(part.next(), samples);
    CHECK(part.complete() == 16);
    for (uint32_t b = 0; b < 6; ++b) {
      CHECK(samples[b] == (b == 1 || b == 4 ? 16 : before.at(b)));
      CHECK(part.counts()[b] == samples[b]);
    }
    part.set_samples(20);
    while (!part.done()) take(part.next(), samples);
    CHECK(samples[4] == 20);
    // Another region begins where these blocks are; the first keeps its samples.
    UniformSchedule other(part.counts(), {0, 1}, 12, 640, one);
    CHECK(other.complete() == before.at(0));
    while (!other.done()) take(other.next(), samples);
    CHECK(samples[0] == 12);
    CHECK(samples[1] == 20);
    UniformSchedule all(other.counts(), 20, 640, one);
    while (!all.done()) take(all.next(), samples);
    for (uint32_t b = 0; b < 6; ++b) CHECK(samples[b] == 20);
  }
}

TEST_CASE("adaptive sampling of a region leaves other tiles alone, whatever their error") {
  // 3x3 tiles of 2x2 blocks; the region is one block of the tile in the middle.
  AdaptiveOptions options{.tile = 16,
                          .target_error = 0.05f,
                          .min_samples = 8,
                          .max_samples = 64,
                          .slots = 4096,
                          .region = {3, 3, 4, 4}};
  std::vector<uint32_t> have(36, 4);
  have[0] = 3;  // a block behind the others of a tile that rests
  const std::vector<TileErrors> errors(9, {.paths = 1});
  AdaptiveSchedule s(6, 6, options, have, errors);
  CHECK(s.sampled_tiles() == 1);
  CHECK(s.least_samples() == 4);
  CHECK(s.counts() == have);
  std::map<uint32_t, uint32_t> samples;
  for (uint32_t b = 0; b < 36; ++b) samples[b] = have[b];
  float error = 1;
  const auto play = [&] {
    while (!s.done()) {
      take(s.next(), samples);
      s.report(std::vector<TileErrors>(s.to_report().size(), {.paths = error *= 0.3f}));
    }
  };
  play();
  CHECK(s.tiles()[4].state == TileState::done);
  const uint32_t reached = s.most_samples();
  CHECK(reached > 8);
  CHECK(s.least_samples() == reached);
  for (uint32_t b = 0; b < 36; ++b) {
    CAPTURE(b);
    const uint32_t x = b % 6, y = b / 6;
    CHECK(samples[b] == (x / 2 == 1 && y / 2 == 1 ? reached : have[b]));
    CHECK(s.counts()[b] == samples[b]);
  }
  CHECK(s.count(TileState::resting) == 8);
  // Another target asks the region only.
  error = 1, options.max_samples = 2 * reached, options.target_error = 1e-6f;
  s.retarget(options);
  CHECK_FALSE(s.done());
  play();
  CHECK(s.most_samples() == 2 * reached);
  CHECK(samples[35] == 4);
  // Without a region the rest catches up, the block behind too.
  options.region = {}, options.max_samples = 16;
  AdaptiveSchedule all(6, 6, options, s.counts(), errors);
  CHECK(all.sampled_tiles() == 9);
  while (!all.done()) {
    take(all.next(), samples);
    all.report(std::vector<TileErrors>(all.to_report().size(), {.paths = 1}));
  }
  CHECK(samples[0] == 16);
  CHECK(samples[35] == 16);
}

}  // namespace schedule_region_tests
