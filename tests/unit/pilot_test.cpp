// links: session
// When the first samples of a picture are enough to choose solvers by, and what they cost.
#include <catch2/catch.hpp>

#include "session/pilot.h"

namespace pilot_tests {

using namespace lucerna;

TEST_CASE("four samples are enough for a short picture, and a thirtieth of a long one") {
  const auto complete_at = [](const plan::Goal& goal, uint32_t most) {
    session::Pilot pilot;
    for (uint32_t n = 0;; ++n) {
      pilot.note(n, 1, 0);
      if (pilot.complete(goal, {}, most)) return n;
    }
  };
  CHECK(complete_at({.samples = 64}, 64) == 4);
  CHECK(complete_at({.samples = 500}, 500) == 15);
  CHECK(complete_at({.samples = 1e6}, 1000000) == 32);
  // Both halves of the film need the same number of samples; one sample decides nothing, and waits for
  // nothing.
  CHECK(complete_at({.samples = 3}, 3) == 2);
  CHECK(complete_at({.samples = 1}, 1) == 1);
}

TEST_CASE("with a limit of time it has three hundredths of it") {
  session::Pilot pilot;
  uint32_t n = 0;
  // The first sample waits for kernels; whole samples are noted after several work items.
  do {
    pilot.note(n, 0.05, 100);
    ++n;
    pilot.note(n, n == 1 ? 0.2 : 0.05, 200);
  } while (!pilot.complete({}, 30.0, 1u << 20));
  CHECK(n == 8);
  CHECK(pilot.sample_seconds() == Approx(0.1));
  CHECK(pilot.sample_rays() == 300);
  pilot.restart();
  CHECK(pilot.sample_seconds() == 0);
  CHECK_FALSE(pilot.complete({}, 30.0, 1u << 20));
}

}  // namespace pilot_tests
