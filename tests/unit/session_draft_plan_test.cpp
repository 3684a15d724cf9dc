// links: session
// When preview samples are drawn: the first immediately, a few while the picture fills, more while it waits;
// and their share of the time.
#include <catch2/catch.hpp>

#include "session/draft_plan.h"

namespace session_draft_plan_tests {

using lucerna::session::DraftPlan;
using Next = DraftPlan::Next;

TEST_CASE("a new picture gets a preview sample immediately, a filled one none") {
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

TEST_CASE("primary visibility is traced after the first preview sample of an unfilled picture") {
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

TEST_CASE("while the picture's samples arrive there are four coarse preview samples, whatever they take") {
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

TEST_CASE("while the picture waits, previews with low error take half of the time, then a third") {
  constexpr double k_good = 0.05;
  DraftPlan plan;
  double drafts = 0, work = 0, halved = 0;
  uint32_t coarse = 0, fine = 0;
  for (int step = 0; step < 10000; ++step) {
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
  CHECK(fine > 64);
  CHECK(drafts / (drafts + work) == Approx(1 / 3.0).margin(0.01));
}

TEST_CASE("while the picture waits, previews with high error take most of the time, for some seconds") {
  for (const std::optional<double> error : {std::optional<double>(), std::optional(0.2)}) {
    DraftPlan plan;
    double drafts = 0, work = 0, drafts_at_9 = 0;
    for (int step = 0; step < 4000; ++step) {
      if (drafts + work < 9) drafts_at_9 = drafts;
      // Changed light restarts the preview, but does not delay the work further.
      if (step % 100 == 99) plan.light_changed();
      if (const Next next = plan.next(true, false, false, error); next == Next::nothing) {
        plan.worked(0.02), work += 0.02;
      } else {
        plan.drawn(next, 0.1), drafts += 0.1;
      }
    }
    CHECK(drafts_at_9 == Approx(6).margin(0.5));
    CHECK(drafts / (drafts + work) < 0.36);
  }
}

TEST_CASE("a restarted preview is no coarser than the previous one") {
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
  CHECK(plan.next(false, false, false) == Next::coarse);  // the picture's own samples arrive now
  plan.drawn(Next::fine, 0.1);
  CHECK(plan.begun());
  CHECK((plan.coarse_samples() == 0 && plan.shows_fine()));
  plan.worked(10);
  CHECK(plan.next(true, false, false) == Next::fine);
  plan.restart();
  CHECK(plan.next(true, false, false) == Next::coarse);
}

TEST_CASE("visibility, the last coarse sample and every doubling of fine samples are shown immediately") {
  DraftPlan plan;
  plan.drawn(Next::coarse, 0.1);
  CHECK_FALSE(plan.news());
  plan.drawn(Next::sight, 0.1, false);
  CHECK_FALSE(plan.news());  // a part of them
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
    CHECK(plan.shows_fine() == (i > 0));  // one sample is no better than four at a quarter of the pixels
  }
  CHECK(shown == 6);
}

}  // namespace session_draft_plan_tests
