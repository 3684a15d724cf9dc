// links: commands
// Commands that trace, list and follow paths of a pixel, and explain noise.
#include "workspace_bench.h"

namespace path_commands_tests {

using namespace lucerna;
using Catch::Contains;

TEST_CASE("inspect.trace traces the paths of a pixel; inspect.follow follows one") {
  test::WorkspaceBench b;
  CHECK_THAT(b.failure("inspect.trace 0.5 0.5"), Contains("no scene is open"));
  CHECK_THAT(b.failure("inspect.follow 1"), Contains("no paths are traced"));
  b.open();
  b.run("wait_samples 4");
  CHECK_THAT(b.failure("inspect.trace 2 0.5"), Contains("expected a number from 0 to 1 picture widths"));
  CHECK_THAT(b.failure("inspect.trace 0.5 0.5 0"), Contains("from 1 to 4096"));
  b.run("inspect.trace 0.5 0.5 9");
  REQUIRE(b.work.traced);
  REQUIRE(b.work.traced->paths);
  CHECK(b.work.traced->paths->paths[0].pixel == 18 * 64 + 32);
  // The last one is blocked; the brightest is the one before.
  CHECK(b.work.traced->order[0] == 7);
  const auto value = [&](const std::string& name) { return b.work.values.read(b.work, {name, {}}); };
  CHECK(value("paths.count") == "9");
  CHECK(value("paths.lost") == "0");
  CHECK_THROWS_WITH(value("paths.followed"), Contains("no path is followed"));
  CHECK(b.work.traced->shown().path == -1);
  CHECK_THAT(b.failure("inspect.follow 10"), Contains("there is no path 10; 9 are traced"));
  CHECK_THAT(b.failure("inspect.follow 1 4"), Contains("path 1 has no event 4; it has 4"));
  b.run("inspect.follow 1 2");
  CHECK(b.work.traced->shown().path == 7);
  CHECK(b.work.traced->shown().vertex == 2);
  CHECK_THAT(value("paths.followed"), Contains("EDL primary 0.8"));
  b.run("inspect.follow 0");
  CHECK(b.work.traced->shown().path == -1);
  b.run("inspect.untrace");
  CHECK_FALSE(b.work.traced);
}

TEST_CASE("inspect.noise explains the noise of a rectangle; inspect.cure sets what would reduce it") {
  test::WorkspaceBench b;
  CHECK_THAT(b.failure("inspect.noise"), Contains("no scene is open"));
  CHECK_THAT(b.failure("inspect.cure"), Contains("no noise is explained"));
  b.open();
  b.run("wait_samples 4");
  CHECK_THAT(b.failure("inspect.noise 0.1 2"), Contains("expected a number from 0 to 1 picture heights"));
  b.run("inspect.noise 0.25");
  CHECK(b.work.noise->lo == vec2(0.25f, 0));
  CHECK(b.work.noise->hi == vec2(1));
  b.run("inspect.noise 0.25 0.5 0.5 0.9");
  REQUIRE(b.work.noise);
  REQUIRE(b.work.noise->report);
  CHECK(b.work.noise->hi == vec2(0.75f, 1));
  CHECK_FALSE(b.work.noise->whole_picture());
  const auto value = [&](const std::string& name) { return b.work.values.read(b.work, {name, {}}); };
  CHECK(value("noise.component") == "caustic");
  CHECK(value("noise.cure") == "components.caustic photons");
  CHECK_THAT(value("noise.text"), Contains("Caustic light makes 90 % of the noise here"));
  b.run("inspect.cure");
  CHECK(b.work.open.setting("components.caustic") == "photons");
  b.run("inspect.noise");
  CHECK(b.work.noise->whole_picture());
}

}  // namespace path_commands_tests
