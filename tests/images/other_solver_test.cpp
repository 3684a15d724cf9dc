// links: session
// A solver unknown to the program (support/ambient/ambient.h), registered by this file only: its light, its
// components, what changes invalidate, and that the other solvers stay unchanged.
#include <catch2/catch.hpp>

#include "solvers/registry.h"
#include "support/ambient/ambient.h"
#include "support/folder.h"
#include "support/render.h"
#include "support/rooms.h"

namespace other_solver_tests {

using namespace lucerna;

namespace {

const bool k_added = (solvers::add(lucerna::ambient::type()), true);

/// The inside of an emissive box of a single albedo without gloss.
scene::Scene closed_room() {
  scene::Scene s;
  s.name = "closed room";
  s.materials = {test::diffuse(vec3(0.5f, 0.25f, 0.75f), vec3(1))};
  test::add_box(s, vec3(-1), vec3(1));
  s.cameras = {test::looking_down({0, 0.5f, 0}, 1)};
  return s;
}

test::Result furnace(const test::Settings& settings, uint32_t samples = 16) {
  return test::render(closed_room(), settings, samples, 16);
}

}  // namespace

TEST_CASE("a solver of the tests is a choice of its component only, and its options are settings") {
  REQUIRE(k_added);
  REQUIRE(solvers::find("ambient"));
  CHECK_NOTHROW(plan::Settings().set("components.tertiary", "ambient"));
  CHECK_THROWS(plan::Settings().set("components.secondary", "ambient"));
  CHECK(plan::Settings().real("ambient.radiance") == 0.5);
  CHECK(solvers::owner_of("ambient.radiance") == &lucerna::ambient::info());
  // The list is in use: registration is closed.
  CHECK_THROWS_AS(solvers::add(lucerna::ambient::type()), std::logic_error);
}

TEST_CASE("its light is looked up at the second diffuse vertex, and no other component changes") {
  const test::Result path = furnace({});
  const test::Result ambient = furnace({{"components.tertiary", "ambient"}, {"ambient.radiance", "2"}});
  // A closed room of one albedo: the lookup at the second vertex returns albedo x radiance, times the first
  // vertex's albedo.
  const vec3 albedo = closed_room().materials[0].base_color;
  for (const vec3& light : ambient.image.components[2])
    for (int c = 0; c < 3; ++c) CHECK(light[c] == Approx(2 * albedo[c] * albedo[c]).epsilon(1e-4));
  for (const int c : {0, 1, 3}) CHECK(test::identical(path.image.components[c], ambient.image.components[c]));
  CHECK_FALSE(ambient.bias_known[2]);
  CHECK(ambient.bias_known[1]);
}

TEST_CASE("a component computed by two solvers is refused, and the previous settings stay") {
  session::Renderer r(test::renderer_options());
  r.set_size(16, 16);
  r.set_scene(std::make_shared<scene::Scene>(closed_room()));
  test::set(r, {{"components.tertiary", "ambient"}});
  const int made = lucerna::ambient::AmbientSolver::made;
  // The records of a cached secondary component include tertiary light.
  CHECK_THROWS_WITH(test::set(r, {{"components.secondary", "cache"}, {"cache.rays", "64"}}),
                    Catch::Contains("components.tertiary: light of the words") &&
                        Catch::Contains("would be counted twice: by 'cache'") &&
                        Catch::Contains("by 'ambient'"));
  CHECK(r.settings().text("components.secondary") == "path");
  CHECK(r.solver("ambient"));
  CHECK_FALSE(r.solver("cache"));
  CHECK(lucerna::ambient::AmbientSolver::made == made);  // before any solver allocates memory
  CHECK(r.step());
}

TEST_CASE("changes invalidate what its table says; other solvers' settings invalidate nothing") {
  session::Renderer r(test::renderer_options());
  r.set_size(16, 16);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/furnace-closed/furnace-closed.gltf");
  test::set(r, {{"components.tertiary", "ambient"}});
  const double first = r.solvers().figure("begun");
  r.set_camera(r.camera());
  CHECK(r.solvers().figure("begun") == first);
  r.restart();
  CHECK(r.solvers().figure("begun") == first + 1);
  CHECK_FALSE(solvers::invalidated_by_setting(lucerna::ambient::info(), "cache.rays").any());
  CHECK_FALSE(solvers::invalidated_by_setting(*solvers::find("cache"), "ambient.radiance").any());
  CHECK(solvers::invalidated_by_setting(lucerna::ambient::info(), "ambient.radiance") ==
        solvers::k_invalidates_all);
  // Another solver's setting restarts the picture but keeps this solver's work; its own setting restarts its
  // work.
  test::set(r, {{"cache.rays", "64"}});
  CHECK(r.solvers().figure("begun") == first + 1);
  test::set(r, {{"ambient.radiance", "3"}});
  CHECK(r.solvers().statistics().at("ambient").at("radiance") == 3.0);
}

TEST_CASE("its view is drawn over the picture, and its report and figures are published") {
  session::Renderer r(test::renderer_options());
  r.set_size(32, 32);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/furnace-closed/furnace-closed.gltf");
  test::set(r, {{"components.tertiary", "ambient"}, {"samples", "1"}});
  test::finish(r);
  const std::vector<uint8_t> plain = r.output().picture(false);
  test::set(r, {{"overlay.ambient", "small"}});
  const std::vector<uint8_t> shown = r.output().picture(false);
  const size_t middle = 4 * (16 * 32 + 16);
  CHECK(std::abs(int(shown[middle]) - 255) < 2);
  CHECK(std::abs(int(shown[middle + 1]) - 64) < 3);
  CHECK(std::equal(plain.begin(), plain.begin() + 4 * 32 * 8, shown.begin()));
  const auto reports = r.solvers().reports();
  REQUIRE(reports.size() == 1);
  CHECK(reports[0]->solver == "ambient");
  CHECK(r.solvers().statistics().at("ambient").at("radiance") == 0.5);
}

TEST_CASE("its command and its file change its light; a file of another kind is refused") {
  const test::Folder folder;
  session::Renderer r(test::renderer_options());
  r.set_size(16, 16);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/furnace-closed/furnace-closed.gltf");
  test::set(r, {{"components.tertiary", "ambient"}, {"samples", "1"}});
  const auto light = [&] {
    r.restart();
    return test::mean(test::finish(r).components[2]);
  };
  const double once = light();
  CHECK(once > 0);
  const auto file = folder.path / "a.ambient", other = folder.path / "b.ambient";
  r.solvers().save("ambient", file);
  r.solvers().command("ambient", "double");
  CHECK(light() == Approx(2 * once));
  r.solver_load("ambient", file);
  CHECK(light() == Approx(once));
  write_file(other.string(), "none");
  CHECK_THROWS_WITH(r.solver_load("ambient", other), Catch::Contains("b.ambient: is not a radiance"));
  CHECK(light() == Approx(once));
}

}  // namespace other_solver_tests
