// links: commands
// Commands that give samples to a region only.
#include "workspace_bench.h"

namespace region_commands_tests {

using namespace lucerna;
using Catch::Contains;

TEST_CASE("region.set and region.clear change a setting; each is one step of undo and a line of the script") {
  test::WorkspaceBench b;
  CHECK_THAT(b.failure("region.set 0 0 1 1"), Contains("no scene is open"));
  CHECK_THAT(b.failure("region.clear"), Contains("there is no region"));
  b.open();
  CHECK_THAT(b.failure("region.set 0.5 0.5"), Contains("width is missing"));
  CHECK_THAT(b.failure("region.set 0.5 0.5 2 0.5"), Contains("expected a number from 0 to 1 picture widths"));
  CHECK_THAT(b.failure("region.set 0.5 0.5 0 0.5"), Contains("nothing of it is in the picture"));
  b.run("region.set 0.25 0.5 0.5 0.25");
  CHECK(b.work.open.setting("sampling.region") == "0.25,0.5,0.5,0.25");
  b.run("region.set 0 0 0.5 0.5");
  b.run("undo");
  CHECK(b.work.open.setting("sampling.region") == "0.25,0.5,0.5,0.25");
  b.run("region.clear");
  CHECK(b.work.open.setting("sampling.region").empty());
  b.run("undo");
  CHECK(b.work.open.setting("sampling.region") == "0.25,0.5,0.5,0.25");
  CHECK(b.settled());
}

}  // namespace region_commands_tests
