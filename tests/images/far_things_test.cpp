// links: session
// An object far outside a closed room, invisible from inside, changes no bit of the picture, whichever solver
// computes it: no radius, cell or margin scales with the scene's extent.
#include "support/caustics.h"

namespace far_things_tests {

using namespace lucerna;

namespace {

/// A closed room with a lamp under its ceiling, a glass ball of radius `size` metres on its floor and the
/// camera near it; if `away` is not 0, a wall outside at that distance.
scene::Scene room(float away, float size = 0.3f) {
  scene::Scene s;
  s.name = "room";
  s.materials = {test::diffuse({0.7f, 0.6f, 0.5f}), test::diffuse(vec3(0), vec3(20)), {}};
  s.materials[2].metallic = 0, s.materials[2].roughness = 0, s.materials[2].transmission = 1;
  s.materials[2].thickness = 1;
  test::add_box(s, {-2, 0, -2}, {2, 2.5f, 2});
  test::add_quad(s, {-0.5f, 2.45f, -0.5f}, {1, 0, 0}, {0, 0, 1}, 1);
  test::add_ball(s, {0, 1.1f * size, 0}, size, 2, 12);
  if (away > 0) test::add_quad(s, {away, 0, 0}, {0, 10, 0}, {0, 0, 10}, 0);
  scene::Camera front;
  front.yfov = 0.9f, front.to_world[3] = vec4(0, 1.5f * size, 5 * size, 1);
  s.cameras = {front};
  s.environment.given = true;
  return s;
}

void check_same(const test::Settings& settings, float size = 0.3f,
                const std::vector<float>& distances = {2e4f, 1e5f}) {
  const test::Result alone = test::render(room(0, size), settings, 4, 32, false);
  for (const float away : distances) {
    INFO("a wall at " << away << " m");
    const test::Result beside = test::render(room(away, size), settings, 4, 32, false);
    CHECK(test::identical(alone.image, beside.image));
    CHECK(alone.stats.rays == beside.stats.rays);
  }
}

}  // namespace

TEST_CASE("far objects do not change path tracing, with either tracer") {
  check_same({{"tracer", "compute-bvh"}});
  check_same({{"tracer", "host"}});
}
TEST_CASE("far objects do not change photons and their radius, near a ball of five millimetres") {
  check_same({{"components.caustic", "photons"}, {"photons.efficiency", "false"}}, 0.005f);
}
TEST_CASE("far objects do not change photons behind a diffuse vertex") {
  check_same({{"components.tertiary", "photons"},
              {"components.caustic", "photons"},
              {"photons.efficiency", "false"}});
}
TEST_CASE("far objects do not change records") {
  for (const char* metric : {"split-sphere", "hessian"})
    check_same(
        {{"components.secondary", "cache"}, {"components.tertiary", "cache"}, {"cache.metric", metric}}, 0.3f,
        {1e5f});
}
TEST_CASE("under a sun a far object gets at most half of the light paths and no light") {
  const test::Settings photons{{"components.caustic", "photons"},
                               {"photons.efficiency", "false"},
                               {"photons.aim", "false"},
                               {"photons.per_round", "100000"}};
  const test::Settings light{
      {"components.caustic", "light"}, {"light.aim", "false"}, {"light.per_round", "100000"}};
  scene::Scene beside = test::turned_sun();
  test::add_quad(beside, {2e4f, 0, 0}, {0, 10, 0}, {0, 0, 10}, 0);
  for (const test::Settings& settings : {photons, light}) {
    const test::MeanOf alone = test::mean_of(test::render(test::turned_sun(), settings, 8, 32).image, 3),
                       both = test::mean_of(test::render(beside, settings, 8, 32).image, 3);
    CHECK(both.value.x == Approx(alone.value.x).epsilon(0.02));
    CHECK(both.noise.x < 3 * alone.noise.x + 0.002 * alone.value.x);
  }
}
TEST_CASE("far objects do not change light tracing") { check_same({{"components.caustic", "light"}}); }

}  // namespace far_things_tests
