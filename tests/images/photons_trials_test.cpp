// links: session
// Secondary and tertiary light of the whole picture by photons, or by path tracing where that is far more
// efficient.
#include <catch2/catch.hpp>

#include "solvers/photons/solver.h"
#include "support/caustics.h"

namespace photons_trials_tests {

using namespace lucerna;
using test::with;

namespace {

constexpr uint32_t k_secondary = 1u << 1, k_tertiary = 1u << 2;

test::Settings photons_for(std::initializer_list<const char*> components, const char* per_round) {
  test::Settings s{{"components.caustic", "off"}, {"photons.per_round", per_round}};
  for (const char* c : components) s[std::string("components.") + c] = "photons";
  return s;
}
/// Few enough photons that paths are more efficient, and enough that photons are.
constexpr const char *k_few = "64", *k_many = "300000";

struct Session {
  session::Renderer r;
  Session(const scene::Scene& scene, const test::Settings& settings, uint32_t samples = 4)
      : r(test::renderer_options(samples <= test::k_validated_samples)) {
    r.set_size(32, 32);
    r.set_scene(std::make_shared<scene::Scene>(scene));
    test::set(r, with({{"samples", std::to_string(samples)}, {"path.batch", test::k_batch}}, settings));
  }
  film::Image image() {
    film::Image i = test::finish(r);
    CHECK(r.device().validation_messages() == 0);
    CHECK(r.stats().dropped == 0);
    return i;
  }
  const photons::PhotonSolver& solver() { return dynamic_cast<photons::PhotonSolver&>(*r.solver("photons")); }
};

}  // namespace

TEST_CASE("where path tracing is far more efficient it computes the light: its picture, bit for bit",
          "[photons_trials]") {
  const scene::Scene room = test::block_room();
  const film::Image path = Session(room, {{"components.caustic", "off"}}).image();
  Session all(room, photons_for({"secondary", "tertiary"}, k_few));
  CHECK(test::identical(all.image(), path));
  CHECK(all.solver().delegated_components() == (k_secondary | k_tertiary));
  CHECK(all.r.samples() == 4);
  CHECK(all.solver().map().figures().photons == 0);
  Session secondary(room, photons_for({"secondary"}, k_few));
  CHECK(test::identical(secondary.image(), path));
  CHECK(secondary.solver().delegated_components() == k_secondary);
  // Paths that gather find no valid irradiance with so few photons, so both ways are the same.
  Session tertiary(room, photons_for({"tertiary"}, k_few));
  tertiary.image();
  CHECK(tertiary.solver().delegated_components() == 0);
}

TEST_CASE("where photons are more efficient they compute the light", "[photons_trials]") {
  const scene::Scene room = test::block_room();
  for (const test::Settings& how :
       {photons_for({"secondary", "tertiary"}, k_many), photons_for({"tertiary"}, k_many)}) {
    Session s(room, how);
    const film::Image image = s.image();
    CHECK(s.solver().delegated_components() == 0);
    CHECK(test::identical(image, Session(room, with(how, {{"photons.efficiency", "false"}})).image()));
  }
}

TEST_CASE("the choice does not depend on work items, and is made again when light changes",
          "[photons_trials]") {
  const scene::Scene room = test::block_room();
  const test::Settings few = photons_for({"secondary", "tertiary"}, k_few);
  Session s(room, few);
  const film::Image first = s.image();
  test::set(s.r, {{"path.batch", "1024"}});
  CHECK(test::identical(first, s.image()));
  // Without the choice, and with it again.
  test::set(s.r, {{"photons.efficiency", "false"}});
  const film::Image photons = s.image();
  CHECK(s.solver().delegated_components() == 0);
  CHECK_FALSE(test::identical(first.components[1], photons.components[1]));
  test::set(s.r, {{"photons.efficiency", "true"}});
  CHECK(test::identical(first, s.image()));
  // Many photons change the choice; few restore it.
  test::set(s.r, {{"photons.per_round", k_many}});
  s.image();
  CHECK(s.solver().delegated_components() == 0);
  test::set(s.r, {{"photons.per_round", k_few}});
  CHECK(test::identical(first, s.image()));
  // A lamp twice as bright gives the same choice and twice the light; the picture equals that of a new
  // session.
  scene::Scene bright = room;
  bright.lights[0].intensity *= 2.0f;
  s.r.set_light(0, bright.lights[0]);
  const film::Image twice = s.image();
  CHECK(s.solver().delegated_components() == (k_secondary | k_tertiary));
  CHECK(test::mean(twice.components[2]) == Approx(2 * test::mean(first.components[2])).epsilon(1e-4));
  CHECK(test::identical(twice, Session(bright, few).image()));
}

TEST_CASE("with caustics of photons the choice depends on the other light only", "[photons_trials]") {
  // A mirrored block.
  scene::Scene s = test::block_room(true);
  s.materials[0].double_sided = true, s.environment = {}, s.environment.given = true;
  s.materials[1] = {}, s.materials[1].metallic = 1, s.materials[1].roughness = 0;
  const test::Settings all{{"components.secondary", "photons"},
                           {"components.tertiary", "photons"},
                           {"components.caustic", "photons"}};
  Session few(s, with(all, {{"photons.per_round", k_few}}), 64);
  const film::Image left = few.image();
  CHECK(few.solver().delegated_components() == (k_secondary | k_tertiary));
  // Photons still compute caustics: paths cannot find the mirror's caustic of a point lamp.
  CHECK(test::mean(left.components[3]) > 0);
  CHECK(test::mean(Session(s, {}, 64).image().components[3]) == 0);
}

TEST_CASE("cancelled trials are repeated", "[photons_trials]") {
  const scene::Scene room = test::block_room();
  const test::Settings few = photons_for({"secondary", "tertiary"}, k_few);
  const film::Image whole = Session(room, few).image();
  Session s(room, few);
  uint32_t calls = 0;
  for (uint32_t step = 0; !s.r.done() && step < 100000; ++step) s.r.step([&] { return ++calls % 41 == 0; });
  CHECK(test::identical(whole, s.r.image()));
}

namespace {

/// A room with a mirrored block: camera paths cannot find part of the light of its point lamp.
scene::Scene mirror_room() {
  scene::Scene s = test::block_room(true);
  s.materials[0].double_sided = true, s.environment = {}, s.environment.given = true;
  s.materials[1] = {}, s.materials[1].metallic = 1, s.materials[1].roughness = 0;
  return s;
}

void check_same_light(const film::Image& a, const film::Image& b, size_t component, double tolerance) {
  const test::MeanOf x = test::mean_of(a, int(component), 0, 0, a.width, a.height),
                     y = test::mean_of(b, int(component), 0, 0, b.width, b.height);
  for (int c = 0; c < 3; ++c) {
    CAPTURE(component, c, x.value[c], x.noise[c], y.value[c], y.noise[c]);
    CHECK(std::abs(x.value[c] - y.value[c]) <
          4 * std::hypot(x.noise[c], y.noise[c]) + tolerance * y.value[c]);
  }
}

}  // namespace

TEST_CASE("where paths are chosen photons compute the light that paths cannot find", "[photons_trials]") {
  const scene::Scene room = mirror_room();
  const test::Settings all{{"components.secondary", "photons"},
                           {"components.tertiary", "photons"},
                           {"components.caustic", "photons"}};
  const film::Image truth =
      Session(room, with(all, {{"photons.per_round", k_many}, {"photons.efficiency", "false"}}), 16).image();
  Session chosen(room, with(all, {{"photons.per_round", k_few}}), 1024);
  const film::Image image = chosen.image();
  REQUIRE(chosen.solver().delegated_components() == (k_secondary | k_tertiary));
  const film::Image paths = Session(room, {}, 64).image();
  // Paths miss part of the tertiary light and all caustics.
  CHECK(test::mean(paths.components[2]) < 0.96 * test::mean(truth.components[2]));
  CHECK(test::mean(paths.components[3]) == 0);
  for (const size_t c : {1u, 2u, 3u}) check_same_light(image, truth, c, 0.02);
  // Only tertiary light, with path traced secondary light: from irradiance maps, and where the maps have no
  // value.
  for (const char* paths : {"16384", "64"}) {
    INFO(paths << " light paths");
    Session gathers(
        room,
        {{"components.tertiary", "photons"}, {"components.caustic", "off"}, {"photons.per_round", paths}},
        64);
    check_same_light(gathers.image(), truth, 2, 0.03);
  }
}

TEST_CASE("records whose rays find no irradiance include the light that paths cannot find",
          "[photons_trials]") {
  scene::Scene room = mirror_room();
  const auto compare = [&] {
    const test::Settings all{{"components.secondary", "photons"},
                             {"components.tertiary", "photons"},
                             {"components.caustic", "off"},
                             {"photons.per_round", k_many},
                             {"photons.efficiency", "false"}};
    const film::Image truth = Session(room, all, 16).image();
    Session records(room,
                    {{"components.secondary", "cache"},
                     {"components.tertiary", "photons"},
                     {"components.caustic", "off"}},
                    16);
    check_same_light(records.image(), truth, 2, 0.04);
  };
  compare();
  // The map never has values on transmitting surfaces.
  room.materials[0].diffuse_transmission = 0.1f;
  compare();
}

TEST_CASE("a house on wide ground has its light, and photons do not report darkness as exact",
          "[photons_trials]") {
  // Four metres of walls around a block, under a sun; the ground is two kilometres wide. The camera sees a
  // wall in the shade, which the ground lights.
  scene::Scene s;
  s.name = "house";
  s.materials = {test::diffuse(vec3(0.6f))};
  test::add_quad(s, {-1000, 0, 1000}, {2000, 0, 0}, {0, 0, -2000});
  test::add_box(s, {-2, 0, -2}, {2, 3, 2});
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = vec3(3)}};
  s.lights[0].direction = normalize(vec3(0, -0.857f, -0.514f));
  scene::Camera camera;
  camera.yfov = 0.5f;
  camera.to_world = mat4(vec4(-1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, -1, 0), vec4(0, 1.5f, -6, 1));
  s.cameras = {camera};
  s.environment.given = true;
  const test::Settings photons{{"components.secondary", "photons"}, {"components.tertiary", "photons"}};
  const film::Image paths = Session(s, {}, 64).image();
  Session chosen(s, photons, 64);
  const film::Image image = chosen.image();
  for (const size_t c : {1u, 2u}) check_same_light(image, paths, c, 0);
  // With photons forced many arrive, although an unaimed path finds the house with a probability of one in
  // 100,000.
  Session forced(s, with(photons, {{"photons.efficiency", "false"}}), 1);
  forced.image();
  CHECK(forced.solver().map().figures().photons > 50);
}

TEST_CASE("light without photons is unknown, and keeps the picture unfinished", "[photons_trials]") {
  // So few light paths that none arrives; wide ground where they are lost.
  scene::Scene s = test::block_room();
  test::add_quad(s, {-3000, -1, 3000}, {6000, 0, 0}, {0, 0, -6000});
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = vec3(3)}};
  s.lights[0].direction = {0, -1, 0};
  Session blind(s,
                {{"components.secondary", "photons"},
                 {"components.tertiary", "photons"},
                 {"photons.efficiency", "false"},
                 {"photons.per_round", "1"},
                 {"sampling.mode", "adaptive"},
                 {"sampling.min_samples", "4"},
                 {"sampling.max_samples", "8"}},
                8);
  blind.image();
  CHECK(blind.r.image_error().relative_sum() >= 1);
  REQUIRE(blind.r.sampling().adaptive());
  CHECK(blind.r.sampling().adaptive()->count(schedule::TileState::done) == 0);
  // With paths the same darkness is known to be exact: the room is closed.
  Session paths(s, {}, 8);
  paths.image();
  CHECK(paths.r.image_error().relative_sum() == 0);
}

}  // namespace photons_trials_tests
