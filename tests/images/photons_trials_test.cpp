// links: session
// Secondary and tertiary light of the whole picture by photons, or by paths from the eye where these have
// far less noise for their time.
#include <catch2/catch.hpp>

#include "solvers/photons/solver.h"
#include "support/caustics.h"

using namespace lucerna;
using test::with;

namespace {

constexpr uint32_t k_secondary = 1u << 1, k_tertiary = 1u << 2;

test::Settings photons_for(std::initializer_list<const char*> components, const char* per_round) {
  test::Settings s{{"components.caustic", "off"}, {"photons.per_round", per_round}};
  for (const char* c : components) s[std::string("components.") + c] = "photons";
  return s;
}
/// So few photons that paths are better, and so many that these are.
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

TEST_CASE("where photons are far from worth it paths bring the light, and the picture is theirs to the bit",
          "[photons_trials]") {
  const scene::Scene room = test::block_room();
  const film::Image path = Session(room, {{"components.caustic", "off"}}).image();
  Session all(room, photons_for({"secondary", "tertiary"}, k_few));
  CHECK(test::identical(all.image(), path));
  CHECK(all.solver().left() == (k_secondary | k_tertiary));
  CHECK(all.r.samples() == 4);
  CHECK(all.solver().map().figures().photons == 0);
  Session secondary(room, photons_for({"secondary"}, k_few));
  CHECK(test::identical(secondary.image(), path));
  CHECK(secondary.solver().left() == k_secondary);
  // Where paths gather, a map of so few photons is known nowhere, and both ways are the same.
  Session tertiary(room, photons_for({"tertiary"}, k_few));
  tertiary.image();
  CHECK(tertiary.solver().left() == 0);
}

TEST_CASE("where photons are worth it they bring the light", "[photons_trials]") {
  const scene::Scene room = test::block_room();
  for (const test::Settings& how :
       {photons_for({"secondary", "tertiary"}, k_many), photons_for({"tertiary"}, k_many)}) {
    Session s(room, how);
    const film::Image image = s.image();
    CHECK(s.solver().left() == 0);
    CHECK(test::identical(image, Session(room, with(how, {{"photons.worth", "false"}})).image()));
  }
}

TEST_CASE("the choice is the same however work is cut, and is made anew when light changes",
          "[photons_trials]") {
  const scene::Scene room = test::block_room();
  const test::Settings few = photons_for({"secondary", "tertiary"}, k_few);
  Session s(room, few);
  const film::Image first = s.image();
  test::set(s.r, {{"path.batch", "1024"}});
  CHECK(test::identical(first, s.image()));
  // Without the choice, and with it again.
  test::set(s.r, {{"photons.worth", "false"}});
  const film::Image photons = s.image();
  CHECK(s.solver().left() == 0);
  CHECK_FALSE(test::identical(first.components[1], photons.components[1]));
  test::set(s.r, {{"photons.worth", "true"}});
  CHECK(test::identical(first, s.image()));
  // Many photons: another answer; and few again.
  test::set(s.r, {{"photons.per_round", k_many}});
  s.image();
  CHECK(s.solver().left() == 0);
  test::set(s.r, {{"photons.per_round", k_few}});
  CHECK(test::identical(first, s.image()));
  // A lamp twice as bright gives the same choice and twice the light; another camera the picture of a fresh
  // start.
  scene::Scene bright = room;
  bright.lights[0].intensity *= 2.0f;
  s.r.set_light(0, bright.lights[0]);
  const film::Image twice = s.image();
  CHECK(s.solver().left() == (k_secondary | k_tertiary));
  CHECK(test::mean(twice.components[2]) == Approx(2 * test::mean(first.components[2])).epsilon(1e-4));
  CHECK(test::identical(twice, Session(bright, few).image()));
}

TEST_CASE("beside caustics of photons the choice is that of the other light alone", "[photons_trials]") {
  // A block of mirrors.
  scene::Scene s = test::block_room(true);
  s.materials[0].double_sided = true, s.environment = {}, s.environment.given = true;
  s.materials[1] = {}, s.materials[1].metallic = 1, s.materials[1].roughness = 0;
  const test::Settings all{{"components.secondary", "photons"},
                           {"components.tertiary", "photons"},
                           {"components.caustic", "photons"}};
  Session few(s, with(all, {{"photons.per_round", k_few}}), 64);
  const film::Image left = few.image();
  CHECK(few.solver().left() == (k_secondary | k_tertiary));
  // Caustics are of photons still: paths do not find what a mirror makes of a point.
  CHECK(test::mean(left.components[3]) > 0);
  CHECK(test::mean(Session(s, {}, 64).image().components[3]) == 0);
}

TEST_CASE("cancelled trials are tried again", "[photons_trials]") {
  const scene::Scene room = test::block_room();
  const test::Settings few = photons_for({"secondary", "tertiary"}, k_few);
  const film::Image whole = Session(room, few).image();
  Session s(room, few);
  uint32_t asked = 0;
  for (uint32_t step = 0; !s.r.done() && step < 100000; ++step) s.r.step([&] { return ++asked % 41 == 0; });
  CHECK(test::identical(whole, s.r.image()));
}
