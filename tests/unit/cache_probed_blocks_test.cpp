// links: irradiance_cache
// Which blocks of the picture a pass probes, and the estimate of gaps in the whole picture from them.
#include "solvers/irradiance_cache/probed_blocks.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <set>

namespace cache_probed_blocks_tests {

using namespace lucerna::irradiance_cache;

namespace {

double stood_for(const ProbedBlocks& blocks) {
  double sum = 0;
  for (uint32_t i = 0; i < blocks.list().size(); ++i) sum += blocks.stands_for(i);
  return sum;
}

}  // namespace

TEST_CASE(
    "the first passes probe all blocks, later ones blocks with gaps, their neighbours, and a part of the "
    "rest") {
  ProbedBlocks blocks;
  for (uint32_t pass = 0; pass < ProbedBlocks::k_all_over; ++pass) {
    blocks.begin(20, 10, pass);
    REQUIRE(blocks.list().size() == 200);
    CHECK(stood_for(blocks) == 200);
    blocks.note(0), blocks.note(5 * 20 + 7);
    blocks.end();
  }
  std::set<uint32_t> seen;
  for (uint32_t pass = 2; pass < 6; ++pass) {
    blocks.begin(20, 10, pass);
    CHECK(blocks.list().size() < 70);
    CHECK(stood_for(blocks) == Approx(200));
    CHECK(std::is_sorted(blocks.list().begin(), blocks.list().end()));
    const std::set<uint32_t> now(blocks.list().begin(), blocks.list().end());
    CHECK(now.size() == blocks.list().size());
    for (const uint32_t near : {0u, 1u, 20u, 21u, 86u, 87u, 88u, 106u, 107u, 108u, 126u, 127u, 128u})
      CHECK(now.count(near) == 1);
    seen.insert(now.begin(), now.end());
    blocks.note(0), blocks.note(5 * 20 + 7);
    blocks.end();
  }
  CHECK(seen.size() == 200);  // all blocks in turn
  blocks.begin(10, 20, 6);    // another picture
  CHECK(blocks.list().size() == 200);
}

TEST_CASE("a cancelled pass keeps the estimate of the previous one") {
  ProbedBlocks blocks;
  blocks.begin(8, 8, 1);
  blocks.note(9);
  blocks.end();
  blocks.begin(8, 8, 2);
  const auto list = blocks.list();
  blocks.note(50);
  blocks.begin(8, 8, 2);
  CHECK(blocks.list() == list);
}

TEST_CASE("the estimated share of gaps is unbiased over the turns") {
  // Unknown blocks have random gaps, some many.
  std::mt19937 random(5);
  std::vector<double> gaps(40 * 24);
  for (double& a : gaps) a = random() % 50 == 0 ? double(random() % 30) : 0;
  const double truth = std::accumulate(gaps.begin(), gaps.end(), 0.0);
  ProbedBlocks blocks;
  double sum = 0;
  for (uint32_t turn = 0; turn < 4; ++turn) {
    blocks.begin(40, 24, 1);
    for (uint32_t b = 0; b < 200; ++b) blocks.note(b);
    blocks.end();
    blocks.begin(40, 24, 4 + turn);
    for (uint32_t i = 0; i < blocks.list().size(); ++i)
      sum += blocks.stands_for(i) * gaps[blocks.list()[i]] / 4;
  }
  CHECK(sum == Approx(truth).epsilon(0.02));
}

TEST_CASE("pictures of one block or one row are probed too") {
  ProbedBlocks blocks;
  for (uint32_t pass = 0; pass < 8; ++pass) {
    blocks.begin(1, 1, pass);
    CHECK(blocks.list() == std::vector<uint32_t>{0});
    CHECK(blocks.stands_for(0) == 1);
    blocks.end();
  }
  for (uint32_t pass = 0; pass < 8; ++pass) {
    blocks.begin(9, 1, pass);
    CHECK_FALSE(blocks.list().empty());
    CHECK(stood_for(blocks) == Approx(9));
    blocks.end();
  }
}

}  // namespace cache_probed_blocks_tests
