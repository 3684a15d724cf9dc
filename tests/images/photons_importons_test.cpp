// links: session
// With importons photons are stored only where lookups read them: fewer photons, the same means for directly
// visible surfaces, mirrors and final gathering.
#include <catch2/catch.hpp>

#include "support/render.h"
#include "support/rooms.h"

namespace photons_importons_tests {

using namespace lucerna;

namespace {

struct Rendered {
  film::Image image;
  double photons = 0, spared = 0;
};
Rendered render(const scene::Scene& scene, test::Settings settings, bool importons) {
  settings["photons.importons"] = importons ? "true" : "false";
  settings["photons.per_round"] = "16384";
  settings["samples"] = "48";
  session::Renderer r(test::renderer_options(false));
  r.set_size(32, 32);
  r.set_scene(std::make_shared<scene::Scene>(scene));
  test::set(r, settings);
  Rendered out;
  out.image = test::finish(r);
  for (const auto& report : r.solvers().reports())
    if (report->solver == "photons")
      out.photons = report->figure("photons"), out.spared = report->figure("spared");
  return out;
}

void check_same(const scene::Scene& scene, const test::Settings& settings, double least_spared) {
  const Rendered some = render(scene, settings, true), all = render(scene, settings, false);
  CHECK(all.spared == 0);
  CHECK(some.spared > least_spared * all.photons);
  // Only photons are skipped: stored plus skipped ones equal the number without importons.
  CHECK(some.photons + some.spared == Approx(all.photons).epsilon(1e-9));
  for (int c = 1; c < 4; ++c) {
    double a = 0, b = 0, odd_a = 0, odd_b = 0;
    const auto n = double(some.image.samples.size());
    for (size_t i = 0; i < some.image.samples.size(); ++i) {
      const auto at = [&](const film::Image& image, bool odd) {
        return double(luminance((odd ? image.odd_half : image.components)[size_t(c)][i])) / n;
      };
      a += at(some.image, false), odd_a += at(some.image, true);
      b += at(all.image, false), odd_b += at(all.image, true);
    }
    INFO("component " << c << ": " << a << ", all stored " << b);
    // Passes trace the same paths, so only roulette differs.
    CHECK(std::abs(a - b) <= 0.005 * b + 4 * std::hypot(a - odd_a, b - odd_b));
  }
}

/// A long room, of which the camera sees one end.
scene::Scene long_room(bool mirror) {
  scene::Scene s;
  s.name = "long room";
  s.materials = {test::diffuse({0.7f, 0.6f, 0.5f}), {}, {}};
  s.materials[1].metallic = 1, s.materials[1].roughness = 0, s.materials[1].base_color = vec4(0.9f);
  s.materials[2].metallic = 0, s.materials[2].roughness = 0, s.materials[2].transmission = 1;
  s.materials[2].thickness = 1;
  test::add_box(s, {-1, 0, -2}, {1, 2, 10});
  test::add_ball(s, {0.4f, 0.5f, -1}, 0.3f, 2, 16);
  if (mirror) test::add_quad(s, {-0.8f, 0.4f, -1.95f}, {1.2f, 0, 0}, {0, 1.2f, 0}, 1);
  s.lights = {{.name = "lamp", .intensity = vec3(2), .position = {-0.5f, 1.7f, -0.5f}},
              {.name = "other", .intensity = vec3(2), .position = {0.5f, 1.7f, 7}}};
  scene::Camera front;
  front.yfov = 1.0f, front.to_world[3] = vec4(0, 1, 1.5f, 1);
  s.cameras = {front};
  s.environment.given = true;
  return s;
}

const test::Settings k_all{{"components.secondary", "photons"},
                           {"components.tertiary", "photons"},
                           {"components.caustic", "photons"},
                           {"photons.efficiency", "false"}};

}  // namespace

TEST_CASE("few photons are stored outside the view, and the picture's means stay") {
  check_same(long_room(false), k_all, 0.3);
}
TEST_CASE("surfaces seen in a mirror keep their photons") { check_same(long_room(true), k_all, 0.05); }
TEST_CASE("surfaces read by final gathering keep their photons") {
  check_same(long_room(false), {{"components.tertiary", "photons"}, {"photons.efficiency", "false"}}, 0.0);
}

}  // namespace photons_importons_tests
