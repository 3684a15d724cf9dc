// links: session
// White furnaces through the whole renderer: surfaces of albedo 1 under (or inside) radiance 1 must
// disappear, for every roughness and lobe. Blocks of 10x10 pixels; the bound is 1 % plus four standard errors
// of the block, from the two independent halves of the film.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/render.h"

namespace furnace_tests {

using namespace lucerna;

namespace {

void check_is_one(const std::string& scene, uint32_t samples) {
  const test::Result r = test::render({.scene = scene, .width = 200, .height = 160, .samples = samples});
  // Few samples with the validation layers.
  CHECK(test::render({.scene = scene, .width = 200, .height = 160, .samples = 1}).validation_messages == 0);
  CHECK(r.stats.dropped == 0);
  double total = 0;
  size_t count = 0;
  for (uint32_t by = 0; by < 16; ++by)
    for (uint32_t bx = 0; bx < 20; ++bx) {
      double sum = 0, squares = 0;
      for (uint32_t y = 0; y < 10; ++y)
        for (uint32_t x = 0; x < 10; ++x) {
          const size_t i = size_t(by * 10 + y) * 200 + bx * 10 + x;
          const vec3 all = test::sum_at(r.image, i);
          REQUIRE(std::isfinite(all.x + all.y + all.z));
          CHECK(all.x == all.y);  // nothing here has a colour
          double odd = 0;
          for (const auto& half : r.image.odd_half) odd += half[i].x;
          // The halves' difference is twice the error of their mean.
          const double error = odd - all.x;
          sum += all.x, squares += error * error;
        }
      const double mean = sum / 100, standard_error = std::sqrt(squares) / 100;
      INFO(scene << ": block " << bx << ", " << by << " mean " << mean << " +- " << standard_error);
      CHECK(std::abs(mean - 1) < 0.01 + 4 * standard_error);
      total += sum, count += 100;
    }
  INFO(scene << ": mean " << total / double(count));
  CHECK(std::abs(total / double(count) - 1) < 0.003);
}

}  // namespace

TEST_CASE("open furnace: albedo 1 under radiance 1") { check_is_one("furnace-open", 64); }
TEST_CASE("closed furnace: walls emit 1/2 and reflect 1/2, albedo 1 inside") {
  check_is_one("furnace-closed", 64);
}

}  // namespace furnace_tests
