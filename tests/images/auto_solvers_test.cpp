// links: session
// Components with the setting auto: a pilot chooses their solvers; where it chooses paths, the picture is
// that of paths bit for bit.
#include <catch2/catch.hpp>

#include "session/renderer.h"
#include "support/render.h"
#include "support/rooms.h"

namespace auto_solvers_tests {

using namespace lucerna;

namespace {

test::Settings all(const char* solver) {
  return {{"components.primary", solver},
          {"components.secondary", solver},
          {"components.tertiary", solver},
          {"components.caustic", solver}};
}

struct Chosen {
  film::Image image;
  std::array<plan::Choice, 4> choices;
  std::optional<solvers::Findings> findings;
  uint64_t restarts = 0;
};

Chosen render(const scene::Scene& scene, test::Settings settings, const char* samples) {
  session::Renderer r(test::renderer_options());
  r.set_size(32, 32);
  r.set_scene(std::make_shared<scene::Scene>(scene));
  settings["samples"] = samples;
  test::set(r, settings);
  const uint64_t before = r.restarts();
  Chosen result;
  result.image = test::finish(r);
  result.choices = r.choices();
  result.findings = r.findings();
  result.restarts = r.restarts() - before;
  CHECK_FALSE(r.choosing());
  CHECK(r.device().validation_messages() == 0);
  return result;
}

}  // namespace

TEST_CASE("for few samples paths are chosen, and the picture is that of paths, not begun again") {
  const scene::Scene room = test::block_room();
  const Chosen by_auto = render(room, all("auto"), "4"), by_path = render(room, all("path"), "4");
  for (size_t c = 0; c < 4; ++c) {
    INFO(by_auto.choices[c].reason);
    CHECK(by_auto.choices[c].solver == "path");
    CHECK_FALSE(by_auto.choices[c].reason.empty());
    CHECK(test::identical(by_auto.image.components[c], by_path.image.components[c]));
  }
  CHECK(by_auto.restarts == 0);
  REQUIRE(by_auto.findings);
  CHECK(by_auto.findings->components[1].variance > 0);
  CHECK_FALSE(by_path.findings);
}

TEST_CASE("with time for records, noisy interreflection is cached, as if the cache had been chosen") {
  // Lit by a small panel that faces a corner, so that most light arrives indirectly.
  scene::Scene room = test::block_room();
  room.lights.clear();
  room.materials.push_back(test::diffuse(vec3(0), vec3(900)));
  test::add_quad(room, {-1.9f, 0.1f, -1.5f}, {0, 0, 0.1f}, {0, 0.1f, 0}, 1);
  test::Settings cheap{{"cache.rays", "64"}, {"cache.max_rays", "64"}, {"cache.passes", "1"}};
  const auto start = [&](session::Renderer& r, test::Settings settings) {
    r.set_size(160, 96);
    r.set_scene(std::make_shared<scene::Scene>(room));
    for (const auto& [key, value] : cheap) settings[key] = value;
    test::set(r, settings);
  };
  session::Renderer r(test::renderer_options());
  test::Settings settings = all("auto");
  settings["samples"] = "1024";
  start(r, settings);
  while (r.choosing()) REQUIRE(r.step());
  INFO(r.choices()[2].reason);
  CHECK(r.choices()[1].solver == "cache");
  CHECK(r.choices()[2].solver == "cache");
  CHECK(r.choices()[3].solver == "path");
  REQUIRE(r.solver("cache"));
  while (r.samples() < 1) REQUIRE(r.step());
  session::Renderer fixed(test::renderer_options());
  settings = all("path");
  settings["components.secondary"] = settings["components.tertiary"] = "cache";
  settings["samples"] = "1024";
  start(fixed, settings);
  while (fixed.samples() < 1) REQUIRE(fixed.step());
  for (size_t c = 0; c < 4; ++c) CHECK(test::identical(r.image().components[c], fixed.image().components[c]));
}

namespace {

/// A renderer as in the window, with a picture of that size.
std::unique_ptr<session::Renderer> in_window(const scene::Scene& scene, uint32_t width, uint32_t height,
                                             std::optional<double> patience, bool choose) {
  session::RendererOptions options = test::renderer_options(false);
  options.interactive = true;
  options.patience = patience;
  auto r = std::make_unique<session::Renderer>(options);
  r->set_size(width, height);
  r->set_scene(std::make_shared<scene::Scene>(scene), {}, {}, choose);
  return r;
}

/// What the session does while it has time: preview samples first, then the picture.
void work(session::Renderer& r) {
  if (r.previews().draw())
    r.choose_by_previews();
  else
    REQUIRE(r.step());
}

}  // namespace

TEST_CASE("in the window preview samples choose, before the picture's first sample") {
  const scene::Scene room = test::block_room();
  const auto r = in_window(room, 512, 256, {}, true);
  CHECK(r->settings().text("components.secondary") == plan::k_auto);
  CHECK(r->choosing());
  while (r->choosing()) work(*r);
  CHECK(r->samples() == 0);
  REQUIRE(r->findings());
  CHECK(r->findings()->components[1].variance > 0);
  CHECK(r->findings()->rays > 1);
  CHECK(r->findings()->seconds > 0);
  CHECK(r->findings()->pixels == 512 * 256);
  // Nearly the same as the samples of a small picture find, which has too few pixels for preview samples.
  // (Noise of direct light is at edges here, of which both have another share.)
  const auto small = in_window(room, 128, 64, {}, true);
  while (small->choosing()) work(*small);
  CHECK(small->samples() > 0);
  for (const size_t c : {1, 2}) {
    const double a = r->findings()->components[c].variance, b = small->findings()->components[c].variance;
    CAPTURE(c, a, b);
    CHECK(a < 1.5 * b);
    CHECK(b < 1.5 * a);
  }
  CHECK(r->findings()->rays < 1.1 * small->findings()->rays);
  CHECK(small->findings()->rays < 1.1 * r->findings()->rays);
}

TEST_CASE("nothing is chosen for a scene that says who computes which light, or without the request") {
  scene::Scene room = test::block_room();
  CHECK_FALSE(in_window(room, 64, 64, {}, false)->choosing());
  room.settings = {{"components.caustic", "photons"}};
  const auto r = in_window(room, 64, 64, {}, true);
  CHECK_FALSE(r->choosing());
  CHECK(r->settings().text("components.secondary") == "path");
  CHECK(r->settings().text("components.caustic") == "photons");
}

TEST_CASE("with little patience preparation ends once its data are usable, unless a user steps through it") {
  const auto stopped_by = [](std::optional<double> patience, const char* pause) {
    const auto r = in_window(test::block_room(), 96, 96, patience, false);
    test::set(*r, {{"components.secondary", "cache"},
                   {"components.tertiary", "cache"},
                   {"cache.pause", pause},
                   {"cache.max_records", test::k_room}});
    while (r->preparing())
      if (r->waits())
        r->solvers().command("cache", "run");
      else
        REQUIRE(r->step());
    return r->solvers().statistics().at("cache").at("stopped_by").get<std::string>();
  };
  CHECK(stopped_by(1e-9, "off") == "finished early");
  CHECK(stopped_by(1e-9, "pass") == "covered");
  CHECK(stopped_by({}, "off") == "covered");
  CHECK(stopped_by(1e9, "off") == "covered");
}

TEST_CASE("the choice is the same in every run, whatever the batches") {
  const scene::Scene room = test::block_room();
  const Chosen a = render(room, all("auto"), "3");
  test::Settings small = all("auto");
  small["path.batch"] = "1024";
  const Chosen b = render(room, small, "3");
  for (size_t c = 0; c < 4; ++c) {
    CHECK(a.choices[c].solver == b.choices[c].solver);
    CHECK(a.findings->components[c].variance == b.findings->components[c].variance);
  }
}

}  // namespace auto_solvers_tests
