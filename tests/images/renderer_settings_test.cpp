// links: session
// User settings stay while the scene stays, and are replaced with it.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "session/renderer.h"
#include "support/complaints.h"
#include "support/device.h"
#include "support/render.h"

namespace renderer_settings_tests {

using namespace lucerna;

TEST_CASE("another tracer keeps edits and camera; another scene starts with its own settings") {
  const auto file = [](const std::string& name) {
    return std::string(LUCERNA_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".gltf";
  };
  session::Renderer r(test::renderer_options(true));
  r.settings().set("path.batch", "1024");
  r.set_size(16, 16);
  r.load(file("glass"));
  CHECK(r.tracer_name() == "host");
  CHECK(r.settings().integer("path.batch") == 1024);
  const double own = r.settings().real("film.ev");
  r.settings().set("film.ev", "-3");
  r.settings().set("components.caustic", "off");
  r.apply_settings();
  scene::Camera moved = r.camera();
  moved.to_world[3][0] += 0.25f;
  r.set_camera(moved);

  r.settings().set("tracer", "compute-bvh");
  r.apply_settings();
  CHECK(r.tracer_name() == "compute-bvh");
  CHECK(r.settings().real("film.ev") == -3);
  CHECK(r.enabled_components() == 7);
  CHECK(r.camera().to_world == moved.to_world);
  CHECK(r.step());

  r.load(file("cornell"));
  CHECK(r.settings().real("film.ev") == own);  // both scenes set the same exposure
  CHECK(r.enabled_components() == 15);
  CHECK(r.tracer_name() == "compute-bvh");
  CHECK(r.step());

  // A file that cannot be opened changes nothing.
  r.settings().set("film.ev", "-2");
  CHECK_THROWS_AS(r.load("/no/such.gltf"), Error);
  CHECK(r.settings().real("film.ev") == -2);
  CHECK(r.scene()->name == "cornell");
  CHECK(r.step());
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("a new target continues an adaptive image; in uniform sampling it only changes the question") {
  session::Renderer r(test::renderer_options(true));
  r.set_size(64, 48);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  const auto set = [&](const char* key, const char* value) {
    r.settings().set(key, value);
    r.apply_settings();
  };
  REQUIRE(r.step());
  uint64_t begun = r.restarts();
  set("sampling.target_error", "0.2");
  set("sampling.tile", "8");
  CHECK(r.restarts() == begun);
  const uint64_t uniform_paths = r.stats().paths;
  set("sampling.mode", "adaptive");
  CHECK(r.restarts() == begun);
  CHECK(r.stats().paths == uniform_paths);
  set("sampling.min_samples", "16");
  while (r.step()) {
  }
  const uint32_t least = r.samples();
  const uint64_t paths = r.stats().paths;
  begun = r.restarts();
  set("sampling.target_error", "0.1");
  CHECK_FALSE(r.done());
  while (r.step()) {
  }
  CHECK(r.restarts() == begun);
  CHECK(r.stats().paths > paths);
  CHECK(r.samples() >= least);
  for (const schedule::Tile& tile : r.sampling().adaptive()->tiles())
    CHECK((tile.error <= 0.1f || tile.samples == 1024));
  set("sampling.tile", "16");  // other tiles are another image
  CHECK(r.restarts() == begun + 1);
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("another sampling mode keeps existing samples, and each sample stays the same") {
  session::Renderer r(test::renderer_options(true));
  r.settings().set("path.batch", "1024");
  r.set_size(40, 24);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  const auto set = [&](const char* key, const char* value) {
    r.settings().set(key, value);
    r.apply_settings();
  };
  set("samples", "32");
  while (r.step()) {
  }
  const film::Image unswitched = r.image();
  r.restart();
  // During a pass: some blocks have more samples than others.
  set("sampling.min_samples", "16");
  set("sampling.max_samples", "32");
  set("sampling.target_error", "0.0001");
  const uint64_t begun = r.restarts();
  while (r.samples() < 4) REQUIRE(r.step());
  REQUIRE(r.step());
  for (const char* mode : {"adaptive", "uniform", "balanced", "adaptive"}) {
    const uint64_t paths = r.stats().paths;
    const uint32_t samples = r.samples();
    set("sampling.mode", mode);
    CHECK(r.restarts() == begun);
    CHECK(r.stats().paths == paths);
    CHECK(r.samples() == samples);
    for (int i = 0; i < 3; ++i) REQUIRE(r.step());
  }
  while (r.step()) {
  }
  CHECK(r.samples() == 32);
  const film::Image switched = r.image();
  CHECK(switched.samples == unswitched.samples);
  // The same samples, added in other portions: equal up to rounding.
  double most = 0, light = 0;
  for (const int c : k_components)
    for (size_t i = 0; i < unswitched.samples.size(); ++i) {
      const vec3 d = switched.components[c][i] - unswitched.components[c][i];
      most = std::max({most, std::abs(double(d.x)), std::abs(double(d.y)), std::abs(double(d.z))});
      light = std::max(light, double(unswitched.components[c][i].y));
    }
  CHECK(most < 1e-4 * light);
  // Back to uniform sampling with more: every pixel reaches the same number.
  set("samples", "40");
  set("sampling.mode", "uniform");
  while (r.step()) {
  }
  const film::Image more = r.image();
  for (const uint32_t n : more.samples) CHECK(n == 40);
  // The target is below the present number: no sample is discarded, so none is repeated.
  set("samples", "8");
  CHECK(r.done());
  CHECK(r.samples() == 40);
  set("sampling.max_samples", "48");
  set("sampling.mode", "adaptive");
  while (r.step()) {
  }
  set("sampling.mode", "uniform");
  set("samples", "50");  // less than another pass of the previous size
  while (r.step()) {
  }
  const film::Image longest = r.image();
  for (const uint32_t n : longest.samples) CHECK(n == 50);
  CHECK(r.restarts() == begun);
  r.restart();
  while (r.step()) {
  }
  const film::Image whole = r.image();
  most = 0;
  for (const int c : k_components)
    for (size_t i = 0; i < whole.samples.size(); ++i)
      most = std::max(most, double(luminance(glm::abs(longest.components[c][i] - whole.components[c][i]))));
  CHECK(most < 1e-4 * light);
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("tiles that are finished in the dark continue when a higher exposure shows their noise") {
  session::Renderer r(test::renderer_options());
  r.set_size(40, 24);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  test::set(r, {{"sampling.mode", "adaptive"},
                {"sampling.target_error", "0.05"},
                {"sampling.min_samples", "8"},
                {"sampling.max_samples", "64"},
                {"film.ev", "-12"}});
  const film::Image dark = test::finish(r);
  for (const uint32_t n : dark.samples) CHECK(n == 8);
  const uint64_t begun = r.restarts();
  test::set(r, {{"film.ev", "1"}});
  CHECK_FALSE(r.done());
  const film::Image bright = test::finish(r);
  CHECK(r.done());
  CHECK(r.restarts() == begun);
  CHECK(*std::max_element(bright.samples.begin(), bright.samples.end()) == 64);
  // A lower exposure needs no samples.
  const uint64_t paths = r.stats().paths;
  test::set(r, {{"film.ev", "-12"}});
  test::finish(r);
  CHECK(r.done());
  CHECK(r.stats().paths == paths);
}

TEST_CASE("the heat map of cost distributes the total device time over the pixels") {
  session::Renderer r(test::renderer_options(true));
  r.set_size(96, 64);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  r.settings().set("samples", "16");
  r.settings().set("film.layer", "cost");
  r.settings().set("lights.sampling", "power");  // pilot rays belong to no pixel
  r.apply_settings();
  while (r.step()) {
  }
  const film::HeatScale scale = r.output().view().heat;
  const std::vector<uint8_t> shown = r.output().picture(false);
  double total = 0, stages = 0, least = 1e9, most = 0;
  for (size_t i = 0; i < shown.size(); i += 4) {
    // The place on the ramp.
    float best = 1e9f, place = 0;
    for (int k = 0; k <= 1000; ++k) {
      const vec3 d = shared::ramp_color(scale.ramp, 0.001f * float(k)) -
                     vec3(shown[i], shown[i + 1], shown[i + 2]) / 255.0f;
      if (glm::dot(d, d) < best) best = glm::dot(d, d), place = 0.001f * float(k);
    }
    const double ms = scale.lo * std::pow(double{scale.hi} / scale.lo, double{place});
    total += ms, least = std::min(least, ms), most = std::max(most, ms);
  }
  for (const auto& stage : r.stats().stages) stages += stage.ms;
  CHECK(total == Approx(stages).epsilon(0.05));
  CHECK(most > 2 * least);  // rays that leave through the open front are cheap
  CHECK(r.device().validation_messages() == 0);
}

TEST_CASE("a scene's warnings refer to its own settings, not to earlier ones") {
  const std::string atrium = std::string(LUCERNA_SOURCE_DIR) + "/scenes/atrium/atrium.gltf";  // uses both
  const auto lamps_behind_glass = [](const test::Complaints& said) {
    return std::count_if(said.lines.begin(), said.lines.end(), [](const std::string& line) {
      return line.find("light is incomplete") != std::string::npos;
    });
  };
  session::Renderer r(test::renderer_options(true));
  r.set_size(16, 16);
  CHECK(r.enabled_components() == 0);
  {
    const test::Complaints said;
    r.load(atrium, {},
           {{"components.primary", "off", ""},
            {"components.tertiary", "off", ""},
            {"components.caustic", "off", ""}});
    CHECK(r.enabled_components() == 2);
    CHECK(lamps_behind_glass(said) == 0);
  }
  const test::Complaints said;
  r.load(atrium);
  CHECK(r.enabled_components() == 15);
  CHECK(lamps_behind_glass(said) == 1);
}

}  // namespace renderer_settings_tests
