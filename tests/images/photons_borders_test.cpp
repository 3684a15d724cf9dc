// links: session
// Light along borders and creases of surfaces, where photon discs extend beyond the surface: even light stays
// even up to the edge, and light on another surface is not counted.
#include <catch2/catch.hpp>

#include "support/render.h"
#include "support/rooms.h"

namespace photons_borders_tests {

using namespace lucerna;

namespace {

/// Radii of three of 40 pixels: the discs of a third of all pixels extend beyond their walls.
const test::Settings k_wide{{"components.secondary", "photons"},
                            {"components.tertiary", "photons"},
                            {"photons.efficiency", "false"},
                            {"photons.radius", "3"},
                            {"photons.floor", "3"},
                            {"photons.per_round", "60000"}};

test::Settings without(test::Settings settings) {
  settings["photons.borders"] = "false";
  return settings;
}

/// A sun along +x that a large mirror reflects straight down onto everything below.
scene::Scene sun_from_above() {
  scene::Scene s;
  s.name = "sun from above";
  s.materials = {test::diffuse({0.8f, 0.5f, 0.2f}), {}};
  s.materials[0].double_sided = true;
  s.materials[1].metallic = 1, s.materials[1].roughness = 0, s.materials[1].double_sided = true;
  s.materials[1].base_color = vec4(1);
  test::add_quad(s, {-2, 4, -2}, {4, -4, 0}, {0, 0, 4}, 1);
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = vec3(3)}};
  s.lights[0].direction = {1, 0, 0};
  s.cameras = {test::looking_down({0, 0.9f, 0}, 0.8f)};
  s.environment.given = true;
  return s;
}

/// The caustics' luminance over its true value, averaged over pixels whose centre satisfies `counts`.
template <class F>
double brightness(const scene::Scene& s, const test::Settings& more, uint32_t samples, F&& counts) {
  constexpr uint32_t k_size = 48;
  test::Settings settings = k_wide;
  settings["components.caustic"] = "photons", settings["photons.efficiency"] = "false",
  settings["photons.per_round"] = "200000";
  settings["components.secondary"] = settings["components.tertiary"] = "off";
  for (const auto& [key, value] : more) settings[key] = value;
  const test::Result r = test::render(s, settings, samples, k_size);
  const double radiance = 3 * double(luminance(vec3(0.8f, 0.5f, 0.2f))) / double(k_pi);
  const float pixel = 2 * 0.9f * std::tan(0.4f) / k_size;
  double sum = 0;
  int count = 0;
  for (uint32_t i = 0; i < k_size * k_size; ++i) {
    const vec2 at(pixel * (float(i % k_size) + 0.5f - k_size / 2),
                  pixel * (float(i / k_size) + 0.5f - k_size / 2));
    if (!counts(at, pixel)) continue;
    sum += double(luminance(r.image.components[3][i])) / radiance, ++count;
  }
  REQUIRE(count > 20);
  return sum / count;
}

}  // namespace

TEST_CASE("in a closed room of one albedo light is even up to the creases") {
  scene::Scene s;
  s.name = "closed room";
  const double a = 0.5;
  s.materials = {test::diffuse(vec3(float(a)), vec3(1))};
  test::add_box(s, vec3(-1), vec3(1));
  s.cameras = {test::looking_down({0, 0.9f, 0}, 1.9f)};
  const test::Result r = test::render(s, k_wide, 16, 40), lost = test::render(s, without(k_wide), 16, 40);
  CHECK(test::mean(r.image.components[1]) == Approx(a * a).epsilon(0.005));
  CHECK(test::mean(r.image.components[2]) == Approx(a * a * a / (1 - a)).epsilon(0.01));
  CHECK(test::mean(lost.image.components[1]) < 0.97 * a * a);
  // Row by row: some rows are entirely crease.
  for (uint32_t y = 0; y < 40; ++y) {
    double row = 0;
    for (uint32_t x = 0; x < 40; ++x) row += double(r.image.components[1][y * 40 + x].y) / 40;
    INFO("row " << y);
    CHECK(row == Approx(a * a).epsilon(0.03));
  }
}

TEST_CASE("even light on a floor is even up to its border, and on a strip narrower than a disc") {
  scene::Scene s = sun_from_above();
  test::add_quad(s, {-0.2f, 0, 0.2f}, {0.4f, 0, 0}, {0, 0, -0.4f}, 0);
  const auto rim = [](const vec2& at, float pixel) {
    const float to_border = 0.2f - std::max(std::abs(at.x), std::abs(at.y));
    return to_border > 0.5f * pixel && to_border < 2 * pixel;
  };
  CHECK(brightness(s, {}, 16, rim) == Approx(1).epsilon(0.02));
  CHECK(brightness(s, {{"photons.borders", "false"}}, 16, rim) < 0.85);
  // A strip two pixels wide, under discs of six.
  scene::Scene strip = sun_from_above();
  const float width = 2 * 0.9f * std::tan(0.4f) / 48;
  test::add_quad(strip, {-width, 0, 0.4f}, {2 * width, 0, 0}, {0, 0, -0.8f}, 0);
  const auto on_strip = [](const vec2& at, float pixel) {
    return std::abs(at.x) < pixel && std::abs(at.y) < 0.3f;
  };
  CHECK(brightness(strip, {}, 16, on_strip) == Approx(1).epsilon(0.03));
}

TEST_CASE("mats, seams and flipped halves of a floor are no brighter than the rest") {
  const auto middle = [](const vec2& at, float pixel) {
    return std::abs(at.x) < 2 * pixel && std::abs(at.y) < 0.2f;
  };
  // Two halves that meet in the middle, with opposite winding.
  scene::Scene s = sun_from_above();
  test::add_quad(s, {-0.4f, 0, 0.4f}, {0.4f, 0, 0}, {0, 0, -0.8f}, 0);
  test::add_quad(s, {0, 0, -0.4f}, {0.4f, 0, 0}, {0, 0, 0.8f}, 0);
  CHECK(brightness(s, {}, 16, middle) == Approx(1).epsilon(0.02));
  // A mat whose border runs through the middle.
  scene::Scene mat = sun_from_above();
  test::add_quad(mat, {-0.4f, 0, 0.4f}, {0.8f, 0, 0}, {0, 0, -0.8f}, 0);
  test::add_quad(mat, {-0.4f, 0.001f, 0.4f}, {0.4f, 0, 0}, {0, 0, -0.8f}, 0);
  CHECK(brightness(mat, {}, 16, middle) == Approx(1).epsilon(0.02));
}

}  // namespace photons_borders_tests
