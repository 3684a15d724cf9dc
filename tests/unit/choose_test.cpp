// links: plan
// Solvers chosen for components with the setting auto: by facts, and by the findings of a pilot.
#include <catch2/catch.hpp>

#include "plan/choose.h"
#include "session/choice_review.h"
#include "solvers/registry.h"

namespace choose_tests {

using namespace lucerna;
using plan::Choice, plan::Goal, plan::SceneFacts, plan::Settings;
using solvers::Findings;

namespace {

/// A lit diffuse triangle, with a mirror beside it if wanted.
scene::Scene room(bool mirror, bool lamp) {
  scene::Scene s;
  s.materials.resize(2);
  for (scene::Material& m : s.materials) m.metallic = 0, m.roughness = 1;
  if (mirror) s.materials[1].metallic = 1, s.materials[1].roughness = 0.01f, s.materials[1].name = "mirror";
  scene::Primitive p;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.triangles = {{0, 1, 2}};
  s.meshes = {scene::Mesh{"mesh", {p, [&] {
                                     scene::Primitive q = p;
                                     q.material = 1;
                                     return q;
                                   }()}}};
  s.instances = {{"node", 0, mat4(1), false}};
  if (lamp)
    s.lights.resize(1);
  else
    s.environment.radiance = vec3(1);
  return s;
}

Settings all_auto() {
  Settings settings;
  for (const char* key :
       {"components.primary", "components.secondary", "components.tertiary", "components.caustic"})
    settings.set(key, "auto");
  return settings;
}

Findings findings(double primary, double secondary, double tertiary, double caustic) {
  Findings f;
  const double variance[] = {primary, secondary, tertiary, caustic};
  for (size_t c = 0; c < 4; ++c) f.components[c] = {.energy = 0.25, .variance = variance[c]};
  f.pixels = 320 * 180;
  return f;
}

}  // namespace

TEST_CASE("explicit solvers are kept, and need no pilot") {
  Settings settings;
  settings.set("components.tertiary", "photons");
  settings.set("components.caustic", "off");
  const SceneFacts facts = plan::facts_of(room(true, false));
  CHECK_FALSE(plan::undecided(facts, settings));
  const auto choices = plan::choose(facts, settings, nullptr, {});
  CHECK(choices[0].solver == "path");
  CHECK(choices[2].solver == "photons");
  CHECK(choices[3].solver == "off");
  for (const Choice& c : choices) CHECK(c.reason.empty());
}

TEST_CASE("facts decide where no pilot is needed: nothing to compute, and light that paths cannot find") {
  const Settings settings = all_auto();
  const SceneFacts plain = plan::facts_of(room(false, false));
  CHECK(plan::undecided(plain, settings));  // interreflection
  const auto before = plan::choose(plain, settings, nullptr, {});
  CHECK(before[3].solver == "path");
  CHECK(before[3].reason.find("the scene has none") == 0);
  CHECK(before[1].solver == "path");  // until the pilot
  // A lamp without size, and a mirror.
  const SceneFacts focused = plan::facts_of(room(true, true));
  const auto choices = plan::choose(focused, settings, nullptr, {});
  CHECK(choices[3].solver == "photons");
  CHECK(choices[3].reason.find("'mirror'") != std::string::npos);
  // Dark: no component is called for.
  scene::Scene dark = room(true, false);
  dark.environment.radiance = vec3(0);
  CHECK_FALSE(plan::undecided(plan::facts_of(dark), settings));
}

TEST_CASE("interreflection goes to the cache where it has the noise and there is time for records") {
  const SceneFacts facts = plan::facts_of(room(true, false));
  const Settings settings = all_auto();
  const Findings noisy = findings(0.5, 5, 20, 0.1);
  const auto with_time = plan::choose(facts, settings, &noisy, Goal{.samples = 400});
  CHECK(with_time[1].solver == "cache");
  CHECK(with_time[2].solver == "cache");
  CHECK(with_time[3].solver == "path");
  CHECK(with_time[2].reason.find("instead of") != std::string::npos);
  // No time for records.
  CHECK(plan::choose(facts, settings, &noisy, Goal{.samples = 16})[2].solver == "path");
  // With a limit of time, half of it is for records, which take 69 samples here; what is missing is traced.
  const auto limited = [&](double samples) {
    return plan::choose(facts, settings, &noisy, Goal{.samples = samples, .cuts_preparation = true});
  };
  CHECK(limited(36)[2].solver == "path");
  CHECK(limited(70)[2].solver == "cache");
  // A third of the records serves more than a third of the picture.
  CHECK(limited(50)[2].solver == "cache");
  // In the window preview samples take part of the time meanwhile.
  Findings slow = noisy;
  slow.waiting = 8;
  CHECK(plan::choose(facts, settings, &slow, Goal{.samples = 70, .cuts_preparation = true})[2].solver ==
        "path");
  CHECK(plan::choose(facts, settings, &slow, Goal{.samples = 400})[2].solver == "path");
  // Direct light has the noise: records would only cost.
  const Findings direct = findings(20, 0.5, 0.3, 0);
  CHECK(plan::choose(facts, settings, &direct, Goal{.samples = 400})[2].solver == "path");
  // A target below the error of records.
  CHECK(plan::choose(facts, settings, &noisy, Goal{.error = 0.005})[2].solver == "path");
  CHECK(plan::choose(facts, settings, &noisy, Goal{.error = 0.1})[2].solver == "cache");
  // A solver that the user has chosen stays.
  Settings mixed = settings;
  mixed.set("components.secondary", "path");
  const auto partly = plan::choose(facts, mixed, &noisy, Goal{.samples = 400});
  CHECK(partly[1].solver == "path");
  CHECK(partly[1].reason.empty());
  CHECK(partly[2].solver == "cache");
}

TEST_CASE("caustics go to photons where they have the noise") {
  const SceneFacts facts = plan::facts_of(room(true, false));
  const Settings settings = all_auto();
  const Findings caustics = findings(0.1, 0.1, 0.1, 30);
  CHECK(plan::choose(facts, settings, &caustics, Goal{.samples = 256})[3].solver == "photons");
  const Findings faint = findings(1, 1, 1, 0.1);
  CHECK(plan::choose(facts, settings, &faint, Goal{.samples = 256})[3].solver == "path");
}

TEST_CASE("solvers that cost more than predicted are replaced while that pays") {
  const SceneFacts facts = plan::facts_of(room(true, false));
  const Settings settings = all_auto();
  const Goal goal{.samples = 128, .cuts_preparation = true};
  Findings caustics = findings(0.1, 0.1, 0.1, 3);
  const auto by = [&](double sample, double spent) {
    caustics.begun = Findings::Begun{
        .solvers = {"path", "path", "path", "photons"}, .samples = 2, .sample = sample, .spent = spent};
    return plan::choose(facts, settings, &caustics, goal)[3].solver;
  };
  REQUIRE(plan::choose(facts, settings, &caustics, goal)[3].solver == "photons");
  CHECK(by(1.7, 4) == "photons");
  // Of the variance .6 of 3.3 is left: a sample may cost five times as much.
  CHECK(by(4, 10) == "photons");
  CHECK(by(8, 16) == "path");
  // As good as paths from here on: samples so far are kept.
  CHECK(by(6.5, 16) == "photons");
  // Too late: the time that is left gives paths more noise.
  CHECK(by(8, 112) == "photons");
  // Photons for what is given cost time, too, which was not predicted.
  Settings given = settings;
  given.set("components.tertiary", "photons");
  caustics.begun->sample = 8, caustics.begun->spent = 16;
  CHECK(plan::choose(facts, given, &caustics, goal)[3].solver == "photons");
}

TEST_CASE("the cost of a sample is that of the last pass, with preparation in what is spent") {
  session::ChoiceReview review;
  CHECK_FALSE(review.note(0, 3, 0.5));
  CHECK_FALSE(review.note(1, 5, 0.5));
  CHECK_FALSE(review.note(1, 5.5, 0.5));
  CHECK_FALSE(review.note(4, 7, 0.5));  // too few to measure
  CHECK_FALSE(review.note(4, 9, 0.5));  // in the middle of a pass
  const auto cost = review.note(8, 15, 0.5);
  REQUIRE(cost);
  CHECK(cost->samples == 8);
  CHECK(cost->sample == 4);
  CHECK(cost->spent == 30);
  review.restart();
  CHECK_FALSE(review.note(4, 4, 0.5));
  CHECK(review.note(8, 8, 0.5)->sample == 2);
}

TEST_CASE("a dark pilot leaves everything to paths") {
  const SceneFacts facts = plan::facts_of(room(true, false));
  const Findings none = findings(0, 0, 0, 0);
  for (const Choice& c : plan::choose(facts, all_auto(), &none, Goal{})) CHECK(c.solver == "path");
}

TEST_CASE(
    "a scene that does not say who computes which light leaves that to the program, but for direct light") {
  Settings settings;
  plan::leave_choice(settings, "");
  CHECK(settings.text("components.primary") == "path");
  for (const char* key : {"components.secondary", "components.tertiary", "components.caustic"})
    CHECK(settings.text(key) == plan::k_auto);
  CHECK(plan::decides_solvers("components.primary"));
  CHECK(plan::decides_solvers("relight.mix"));
  CHECK_FALSE(plan::decides_solvers("cache.rays"));
}

TEST_CASE("goals: samples, the target of adaptive sampling, a limit of time once a sample's time is known") {
  Settings settings;
  settings.set("samples", "77");
  CHECK(plan::goal_of(settings, nullptr).samples == 77);
  CHECK_FALSE(plan::goal_of(settings, nullptr).error);
  settings.set("sampling.mode", "adaptive");
  settings.set("sampling.target_error", "0.02");
  CHECK(plan::goal_of(settings, nullptr).error == 0.02);
  Findings f = findings(1, 1, 1, 1);
  CHECK(plan::goal_of(settings, &f, 10).error);
  f.seconds = 0.5;
  CHECK(plan::goal_of(settings, &f, 10).samples == 20);
  CHECK(plan::goal_of(settings, &f, 10).cuts_preparation);
}

}  // namespace choose_tests
