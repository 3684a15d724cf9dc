// links: session
// A solver that the program does not know (support/ambient/ambient.h), registered by this file alone: its
// light, its components, what changes spoil of it, and that nothing of the other solvers changes beside it.
#include <catch2/catch.hpp>

#include "solvers/registry.h"
#include "support/ambient/ambient.h"
#include "support/render.h"

using namespace lucerna;

namespace {

const bool k_added = (solvers::add(test::ambient_type()), true);

test::Result furnace(const test::Settings& settings, uint32_t samples = 16) {
  return test::render(
      {.scene = "furnace-closed", .width = 16, .height = 16, .samples = samples, .settings = settings});
}

double solver_figure(session::Renderer& r, const char* name) { return r.figure(name); }

}  // namespace

TEST_CASE(
    "a solver of the tests' own is a choice of its component alone, with its options among the settings") {
  REQUIRE(k_added);
  REQUIRE(solvers::find("ambient"));
  CHECK_NOTHROW(plan::Settings().set("components.tertiary", "ambient"));
  CHECK_THROWS(plan::Settings().set("components.secondary", "ambient"));
  CHECK(plan::Settings().real("ambient.radiance") == 0.5);
  CHECK(solvers::owner_of("ambient.radiance") == &test::ambient_info());
  // The list is in use: it is too late for more.
  CHECK_THROWS_AS(solvers::add(test::ambient_type()), std::logic_error);
}

TEST_CASE("its light is looked up at the second diffuse vertex, and no other component changes") {
  const test::Result path = furnace({});
  const test::Result ambient = furnace({{"components.tertiary", "ambient"}, {"ambient.radiance", "2"}});
  // A closed room of one albedo: what the second vertex looks up is albedo x radiance, times the first one's
  // albedo.
  for (size_t i = 0; i < ambient.image.samples.size(); ++i) {
    const vec3 albedo = ambient.image.albedo[i];
    for (int c = 0; c < 3; ++c)
      CHECK(ambient.image.components[2][i][c] == Approx(2 * albedo[c] * albedo[c]).epsilon(1e-4));
  }
  for (const int c : {0, 1, 3}) CHECK(test::identical(path.image.components[c], ambient.image.components[c]));
  CHECK_FALSE(ambient.bias_known[2]);
  CHECK(ambient.bias_known[1]);
}

TEST_CASE("beside the irradiance cache it takes over what is deeper") {
  const test::Settings cached{
      {"components.secondary", "cache"}, {"cache.rays", "64"}, {"cache.max_rays", "64"}};
  const test::Result off = furnace([&] {
    test::Settings s = cached;
    s["components.tertiary"] = "off";
    return s;
  }());
  const test::Result both = furnace([&] {
    test::Settings s = cached;
    s["components.tertiary"] = "ambient";
    return s;
  }());
  for (const int c : {0, 1, 3})
    CHECK(test::mean(both.image.components[c]) == Approx(test::mean(off.image.components[c])).margin(1e-6));
}

TEST_CASE("changes spoil of it what its table says; those of other solvers' settings nothing") {
  session::Renderer r(test::renderer_options());
  r.set_size(16, 16);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/furnace-closed/furnace-closed.gltf");
  test::set(r, {{"components.tertiary", "ambient"}, {"components.secondary", "cache"}, {"cache.rays", "64"}});
  const double first = solver_figure(r, "begun");
  r.set_camera(r.camera());
  CHECK(solver_figure(r, "begun") == first);
  r.restart();
  CHECK(solver_figure(r, "begun") == first + 1);
  CHECK_FALSE(solvers::spoiled_by_setting(test::ambient_info(), "cache.rays").any());
  CHECK_FALSE(solvers::spoiled_by_setting(*solvers::find("cache"), "ambient.radiance").any());
  CHECK(solvers::spoiled_by_setting(test::ambient_info(), "ambient.radiance") == solvers::k_spoils_all);
  // Its own setting makes it anew, and leaves the records where they are.
  while (r.preparing()) REQUIRE(r.step());
  const uint32_t records = test::cache(r)->status().records;
  REQUIRE(records > 0);
  test::set(r, {{"ambient.radiance", "3"}});
  CHECK(test::cache(r)->ready());
  CHECK(test::cache(r)->status().records == records);
}

TEST_CASE("its view is drawn over the picture, and its report and figures are told") {
  session::Renderer r(test::renderer_options());
  r.set_size(32, 32);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/furnace-closed/furnace-closed.gltf");
  test::set(r, {{"components.tertiary", "ambient"}, {"samples", "1"}});
  test::finish(r);
  const std::vector<uint8_t> plain = r.picture(false);
  test::set(r, {{"overlay.ambient", "true"}});
  const std::vector<uint8_t> shown = r.picture(false);
  const size_t middle = 4 * (16 * 32 + 16);
  CHECK(std::abs(int(shown[middle]) - 255) < 2);
  CHECK(std::abs(int(shown[middle + 1]) - 64) < 3);
  CHECK(std::equal(plain.begin(), plain.begin() + 4 * 32 * 8, shown.begin()));
  const auto reports = r.reports();
  REQUIRE(reports.size() == 1);
  CHECK(reports[0]->solver == "ambient");
  CHECK(r.solver_statistics().at("ambient").at("radiance") == 0.5);
}
