// links: irradiance_cache
// Where building pauses for a user who watches, and which part of the placement is drawn.
#include "solvers/irradiance_cache/stages.h"

#include <catch2/catch.hpp>

#include "shaders/shared/irradiance_cache/placement_view.h"
#include "solvers/irradiance_cache/placement.h"
#include "solvers/irradiance_cache/placement_view.h"

namespace cache_stages_tests {

using namespace lucerna;
using namespace lucerna::irradiance_cache;

namespace {

/// Ends stages of passes of `each` stages until building waits; returns how many have ended.
int go(Pauses& pauses, int& at, int each, int most = 100) {
  int ended = 0;
  while (!pauses.waits() && ended < most) pauses.ended(++at % each == 0), ++ended;
  return ended;
}

std::vector<Place> row(size_t count, uint32_t origin) {
  std::vector<Place> places;
  for (size_t i = 0; i < count; ++i) places.push_back({vec3(float(i), 0, 0), vec3(0, 1, 0), 0, origin});
  return places;
}

}  // namespace

TEST_CASE("building waits after every stage, every pass, or never, as set") {
  Pauses pauses;
  int at = 0;
  CHECK(go(pauses, at, 5) == 100);
  at = 0;
  pauses.set(PauseAfter::stage);
  CHECK_FALSE(pauses.waits());  // applies from the next end of a stage
  for (int i = 0; i < 12; ++i) {
    CHECK(go(pauses, at, 5) == 1);
    pauses.step();
  }
  CHECK(go(pauses, at, 5) == 1);  // the 13th
  pauses.set(PauseAfter::pass);
  CHECK(pauses.waits());  // where it does
  pauses.step();
  CHECK(go(pauses, at, 5) == 1);  // a step is one stage, whatever is set
  CHECK(at == 14);
  pauses.dropped();
  CHECK(go(pauses, at, 5) == 1);
  CHECK(at == 15);
  pauses.dropped();
  CHECK(go(pauses, at, 5) == 5);
  CHECK(at == 20);
  pauses.set(PauseAfter::off);
  CHECK_FALSE(pauses.waits());
  CHECK(go(pauses, at, 5) == 100);
}

TEST_CASE("a step waits at the next end of a stage; run continues to the end") {
  Pauses pauses;
  int at = 0;
  pauses.step();
  CHECK(go(pauses, at, 5) == 1);
  pauses.set(PauseAfter::off);  // no change: building does not continue
  CHECK(pauses.waits());
  pauses.step();
  CHECK(go(pauses, at, 5) == 1);
  pauses.set(PauseAfter::stage);
  pauses.run();
  CHECK(go(pauses, at, 5) == 100);
  pauses.complete();
  CHECK_FALSE(pauses.waits());
  CHECK(go(pauses, at, 5) == 1);  // the setting applies to the next build
  pauses.run();
  pauses.step();  // the last request wins
  CHECK(go(pauses, at, 5) == 1);
  pauses.complete();
  CHECK_FALSE(pauses.waits());
}

TEST_CASE("a stage is named with its level and pass") {
  CHECK(stage_words({.stage = BuildStage::choose, .pass = 1}) == "choose, pass 2");
  CHECK(stage_words({.stage = BuildStage::evaluate, .level = 3}) == "evaluate level 3, pass 1");
}

TEST_CASE("the known and requested part of the placement is drawn") {
  const std::vector<Place> candidates = row(6, shared::k_origin_world),
                           tried = row(3, shared::k_origin_world);
  const std::vector<uint32_t> cluster{0, 0, 1, 1, 2, 2}, kept{1};
  const std::vector<float> radii{0.5f, 0.25f, 0.125f};
  PlacementShown placement;
  CHECK(placement_drawn(PlacementShow::stage, placement) == PlacementShow::off);
  placement.candidates = candidates;
  CHECK(placement_drawn(PlacementShow::off, placement) == PlacementShow::off);
  for (const PlacementShow show : {PlacementShow::stage, PlacementShow::clusters, PlacementShow::chosen})
    CHECK(placement_drawn(show, placement) == PlacementShow::candidates);
  placement.cluster = cluster, placement.tried = tried;
  CHECK(placement_drawn(PlacementShow::stage, placement) == PlacementShow::clusters);
  CHECK(placement_drawn(PlacementShow::candidates, placement) == PlacementShow::candidates);
  placement.radii = radii;
  CHECK(placement_drawn(PlacementShow::stage, placement) == PlacementShow::chosen);
  CHECK(placement_drawn(PlacementShow::clusters, placement) == PlacementShow::clusters);

  uint32_t rings = 0;
  const auto kind = [](const shared::PlacedPoint& p) { return p.bits & shared::k_placed_mask; };
  std::vector<shared::PlacedPoint> points =
      placement_points(PlacementShow::candidates, placement, 100, rings);
  REQUIRE(points.size() == 6);
  CHECK(rings == 0);
  CHECK((points[0].bits >> shared::k_placed_origin_shift & 3u) == shared::k_origin_world);
  points = placement_points(PlacementShow::clusters, placement, 100, rings);
  REQUIRE(points.size() == 9);
  CHECK(rings == 0);
  CHECK(kind(points[0]) == shared::k_placed_tried);
  CHECK(kind(points[8]) == shared::k_placed_candidate);
  CHECK(points[8].bits >> shared::k_placed_cluster_shift == 3);
  // Measured but not thinned: rings for all of them.
  points = placement_points(PlacementShow::chosen, placement, 100, rings);
  REQUIRE(points.size() == 3);
  CHECK(rings == 3);
  CHECK(points[2].radius == 0.125f);
  placement.kept = kept;
  points = placement_points(PlacementShow::chosen, placement, 100, rings);
  REQUIRE(points.size() == 3);
  REQUIRE(rings == 1);
  CHECK(kind(points[0]) == shared::k_placed_chosen);
  CHECK(points[0].position.x == 1);
  CHECK(points[0].radius == 0.25f);
  CHECK(kind(points[1]) == shared::k_placed_rejected);
  // Limited by the room: tested candidates stay, others are dropped evenly.
  points = placement_points(PlacementShow::clusters, placement, 6, rings);
  REQUIRE(points.size() == 6);
  CHECK(kind(points[2]) == shared::k_placed_tried);
  CHECK(points[4].position.x == 2);
}

}  // namespace cache_stages_tests
