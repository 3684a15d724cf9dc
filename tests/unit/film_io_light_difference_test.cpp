// links: film_io
// Figures of two pictures as light, and the colours of their difference.
#include <catch2/catch.hpp>
#include <cmath>

#include "film/io/light_difference.h"
#include "support/folder.h"
#include "support/ocio.h"

namespace film_io_light_difference_tests {

using namespace lucerna;

namespace {

std::vector<vec3> grey(size_t pixels, float value) { return std::vector<vec3>(pixels, vec3(value)); }

/// Lightness in CIELAB of a sRGB-encoded colour.
float lightness(const vec3& encoded) {
  float y = 0;
  const float weight[] = {0.2126f, 0.7152f, 0.0722f};
  for (int i = 0; i < 3; ++i)
    y += weight[i] *
         (encoded[i] <= 0.04045f ? encoded[i] / 12.92f : std::pow((encoded[i] + 0.055f) / 1.055f, 2.4f));
  return 116 * std::cbrt(y) - 16;
}

}  // namespace

TEST_CASE("equal pictures differ by nothing, and a constant factor gives its closed form") {
  const film::LightDifference same = film::light_difference(16, grey(256, 2), grey(256, 2));
  CHECK(same.relative_squared == 0);
  CHECK(same.as_seen == 0);
  CHECK(same.flip == 0);
  const film::LightDifference brighter = film::light_difference(16, grey(256, 1.1f), grey(256, 1));
  CHECK(brighter.relative_squared == Approx(0.01 / 1.01).epsilon(1e-4));
  CHECK(brighter.as_seen == Approx(0.1 / 1.05).epsilon(1e-4));
  CHECK(brighter.flip > 0);
  CHECK(film::light_difference(16, grey(256, 2), grey(256, 1)).flip > brighter.flip);
}

TEST_CASE("what the view does not show is no difference: light beyond its white") {
  const auto differs = [](const film::ViewTransform& view, float a, float b) {
    const film::LightDifference d = film::light_difference(16, grey(256, a), grey(256, b), view);
    CHECK((d.flip > 1e-3) == (d.as_seen > 1e-3));
    CHECK(d.relative_squared > 0);
    return d.flip > 1e-3;
  };
  const film::ViewTransform linear{.curve = shared::k_tone_linear}, agx{.curve = shared::k_tone_agx};
  CHECK_FALSE(differs(linear, 2, 3));
  CHECK(differs(agx, 2, 3));
  CHECK(differs({.ev = -2, .curve = shared::k_tone_linear}, 2, 3));
  const test::Folder f;
  const test::OcioVariable variable(test::write_ocio(f.path).string());
  CHECK_FALSE(differs({.ocio = "Other: Plain"}, 2, 3));
  CHECK(differs({.ocio = "Other: Plain"}, 0.2f, 0.3f));
  CHECK(differs({.ocio = "Screen: sRGB: Film"}, 2, 3));
  // Without a configuration the curve counts.
  const test::OcioVariable none("");
  CHECK(differs({.curve = shared::k_tone_agx, .ocio = "Other: Plain"}, 2, 3));
}

TEST_CASE("against display colours only FLIP is known") {
  const film::ViewTransform view{.ev = 1, .curve = shared::k_tone_agx};
  const std::vector<vec3> light = grey(256, 0.5f), shown = film::shown_light(view, light);
  const film::LightDifference same = film::display_difference(16, light, shown, view);
  CHECK(same.flip < 1e-4);
  CHECK(std::isnan(same.relative_squared));
  CHECK(std::isnan(same.as_seen));
  CHECK(film::display_difference(16, light, shown, {.ev = -1, .curve = shared::k_tone_agx}).flip > 0.1);
}

TEST_CASE("a difference is blue below zero, white at zero, orange above, and darkens evenly to both ends") {
  const vec3 zero = film::difference_color(0), dark = film::difference_color(-1),
             bright = film::difference_color(1);
  for (int i = 0; i < 3; ++i) CHECK(zero[i] > 0.93f);
  CHECK(dark.z > dark.x + 0.3f);
  CHECK(bright.x > bright.z + 0.3f);
  for (const float sign : {-1.0f, 1.0f}) {
    float before = lightness(zero);
    for (int step = 1; step <= 10; ++step) {
      const float now = lightness(film::difference_color(sign * 0.1f * float(step)));
      CHECK(before - now > 2);
      CHECK(before - now < 8);
      before = now;
    }
  }
  CHECK(film::difference_color(NAN) == zero);
  CHECK(film::difference_color(-INFINITY) == dark);
}

TEST_CASE("the picture of a difference has these colours, by luminance and gain") {
  const std::vector<uint8_t> rgba = film::difference_colors(std::vector{vec3(1), vec3(1), vec3(3)},
                                                            std::vector{vec3(1), vec3(1.5f), vec3(1)}, 2);
  REQUIRE(rgba.size() == 12);
  const vec3 expected[] = {film::difference_color(0), film::difference_color(-1), film::difference_color(1)};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t c = 0; c < 3; ++c) CHECK(int(rgba[4 * i + c]) == int(expected[i][int(c)] * 255 + 0.5f));
    CHECK(rgba[4 * i + 3] == 255);
  }
}

}  // namespace film_io_light_difference_tests
