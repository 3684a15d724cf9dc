// links: session
// When drafts get samples: a first one at once, a few while the picture fills, more while it has to wait, and
// what share of the time they take.
#include <catch2/catch.hpp>

#include "session/draft_plan.h"

using lucerna::session::DraftPlan;
using Next = DraftPlan::Next;

TEST_CASE("a picture that is begun gets a draft at once, a filled one none") {
  for (const bool preparing : {false, true}) {
    DraftPlan plan;
    plan.worked(0.001);
    CHECK(plan.next(preparing, false) == Next::coarse);
    CHECK(plan.next(preparing, true) == Next::nothing);
    plan.drawn(Next::coarse, 1);
    plan.restart();
    CHECK(plan.next(preparing, false) == Next::coarse);
  }
}

TEST_CASE("what surfaces pixels show is asked after the first draft, of pictures that are not filled") {
  DraftPlan plan;
  CHECK(plan.next(false, false, true) == Next::coarse);
  plan.drawn(Next::coarse, 0.1);
  CHECK(plan.next(false, false, true) == Next::sight);
  CHECK(plan.next(true, false, true) == Next::sight);
  CHECK(plan.next(false, true, true) == Next::nothing);
  const uint32_t before = plan.coarse_samples();
  plan.drawn(Next::sight, 0.1);
  CHECK(plan.coarse_samples() == before);
  CHECK(plan.next(false, false, false) == Next::coarse);
}

TEST_CASE("while the picture's samples come there are four of the coarse draft, whatever they take") {
  DraftPlan plan;
  int drawn = 0;
  for (int step = 0; step < 100; ++step) {
    const Next next = plan.next(false, false, false);
    if (next == Next::nothing) {
      plan.worked(0.1);
      continue;
    }
    CHECK(next == Next::coarse);
    plan.drawn(next, 10);
    ++drawn;
  }
  CHECK(drawn == 4);
}

TEST_CASE("while the samples wait drafts of a good picture take half of the time, then less, and end") {
  constexpr double k_good = 0.05;
  DraftPlan plan;
  double drafts = 0, work = 0, halved = 0;
  uint32_t coarse = 0, fine = 0;
  for (int step = 0; step < 100000; ++step) {
    const Next next = plan.next(true, false, false, k_good);
    if (next == Next::nothing) {
      plan.worked(0.02), work += 0.02;
      continue;
    }
    plan.drawn(next, 0.3), drafts += 0.3;
    ++(next == Next::coarse ? coarse : fine);
    if (fine == 4) halved = drafts / (drafts + work);
  }
  CHECK(halved == Approx(0.5).margin(0.15));
  CHECK(coarse == 4);
  CHECK(fine == 64);
  // All of the 68 samples together within a tenth of the time that they are spread over.
  CHECK(drafts / 0.3 == Approx(68));
}

TEST_CASE("while the samples wait drafts of a rough picture take most of the time, for some seconds") {
  for (const std::optional<double> error : {std::optional<double>(), std::optional(0.2)}) {
    DraftPlan plan;
    double drafts = 0, work = 0, drafts_at_9 = 0;
    for (int step = 0; step < 4000; ++step) {
      if (drafts + work < 9) drafts_at_9 = drafts;
      // Better light begins drafts anew, but does not hold up the work any longer.
      if (step % 100 == 99) plan.light_changed();
      if (const Next next = plan.next(true, false, false, error); next == Next::nothing) {
        plan.worked(0.02), work += 0.02;
      } else {
        plan.drawn(next, 0.1), drafts += 0.1;
      }
    }
    CHECK(drafts_at_9 == Approx(6).margin(0.5));
    CHECK(drafts / (drafts + work) < 0.35);
  }
}

TEST_CASE("a draft that begins anew is no coarser than the one that there was") {
  DraftPlan plan;
  plan.drawn(Next::coarse, 0.1);
  plan.light_changed();
  CHECK(plan.next(true, false, false) == Next::coarse);  // there was no finer one
  CHECK_FALSE(plan.begun());
  plan.drawn(Next::coarse, 0.1);
  plan.drawn(Next::fine, 0.1);
  plan.light_changed();
  CHECK_FALSE(plan.begun());
  CHECK(plan.next(true, false, false) == Next::fine);
  CHECK(plan.next(false, false, false) == Next::coarse);  // the picture's own samples come now
  plan.drawn(Next::fine, 0.1);
  CHECK(plan.begun());
  CHECK((plan.coarse_samples() == 0 && plan.shows_fine()));
  plan.worked(10);
  CHECK(plan.next(true, false, false) == Next::fine);
  plan.restart();
  CHECK(plan.next(true, false, false) == Next::coarse);
}

TEST_CASE("surfaces, the last coarse draft and every fine one of twice the samples are shown at once") {
  DraftPlan plan;
  plan.drawn(Next::coarse, 0.1);
  CHECK_FALSE(plan.news());
  plan.drawn(Next::sight, 0.1, false);
  CHECK_FALSE(plan.news());  // a piece of them
  plan.drawn(Next::sight, 0.1);
  CHECK(plan.news());
  plan.drawn(Next::coarse, 0.1);
  CHECK_FALSE(plan.news());
  plan.drawn(Next::coarse, 0.1), plan.drawn(Next::coarse, 0.1);
  CHECK(plan.news());  // the last of them
  int shown = 0;
  for (int i = 0; i < 64; ++i) {
    plan.drawn(Next::fine, 0.1);
    shown += plan.news();
    CHECK(plan.shows_fine() == (i > 0));  // one sample is no better than four of a quarter of the pixels
  }
  CHECK(shown == 6);
}
