// links: film
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "film/tonemap.h"

namespace film_io_tonemap_tests {

using namespace lucerna;
using film::ToneCurve;

namespace {

constexpr ToneCurve k_curves[] = {ToneCurve::neutral, ToneCurve::agx, ToneCurve::linear};

float decode(float x) { return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f); }
vec3 decode(const vec3& c) { return {decode(c.x), decode(c.y), decode(c.z)}; }
/// Linear display light.
vec3 shown(const vec3& radiance, ToneCurve curve, float ev = 0) {
  return decode(film::tone_map(radiance, ev, curve));
}

void check_near(const vec3& found, const vec3& expected, float margin) {
  for (int c = 0; c < 3; ++c) CHECK(found[c] == Approx(expected[c]).margin(margin));
}

}  // namespace

TEST_CASE("Every curve is monotone in grey, black stays black and no value exceeds white") {
  for (const ToneCurve curve : k_curves) {
    INFO("curve " << static_cast<int>(curve));
    CHECK(shown(vec3(0), curve).x <= 1e-5f);
    float last = -1;
    for (float stop = -14; stop < 17; stop += 0.01f) {
      const vec3 c = film::tone_map(vec3(std::exp2(stop)), 0, curve);
      REQUIRE(c.x >= last);
      REQUIRE(c.x <= 1);
      REQUIRE(c.y == Approx(c.x).margin(2e-6));
      REQUIRE(c.z == Approx(c.x).margin(2e-6));
      last = c.x;
    }
    CHECK(last > 0.99f);
  }
}

TEST_CASE("Colours stay within 0..1 for any input") {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> stop(-20, 30);
  const float odd[] = {0, -1, NAN, INFINITY, -INFINITY, 3.4e38f, 1e-42f};
  for (const ToneCurve curve : k_curves)
    for (int i = 0; i < 20000; ++i) {
      vec3 c(std::exp2(stop(random)), std::exp2(stop(random)), std::exp2(stop(random)));
      if (i % 3 == 0) c[static_cast<int>(random() % 3)] = odd[random() % 7];
      const vec3 s = film::tone_map(c, stop(random) * 0.2f, curve);
      for (int k = 0; k < 3; ++k) REQUIRE((s[k] >= 0 && s[k] <= 1));
    }
  CHECK(film::tone_map(vec3(NAN), 0, ToneCurve::neutral) == vec3(0));
  check_near(film::tone_map(vec3(INFINITY), 0, ToneCurve::linear), vec3(1), 1e-6f);
}

TEST_CASE("Exposure is in stops and acts before the curve") {
  for (const ToneCurve curve : k_curves)
    CHECK(film::tone_map({0.1f, 0.2f, 0.05f}, 1, curve) == film::tone_map({0.2f, 0.4f, 0.1f}, 0, curve));
  CHECK(film::exposure_factor(0) == 1);
  CHECK(film::exposure_factor(-2) == 0.25f);
}

TEST_CASE("The sRGB encoding has its published values") {
  CHECK(shared::srgb_encode(0.0f) == 0);
  CHECK(shared::srgb_encode(1.0f) == Approx(1));
  CHECK(shared::srgb_encode(0.0031308f) == Approx(0.04045).margin(1e-5));
  CHECK(shared::srgb_encode(0.214041f) == Approx(0.5).margin(1e-5));
  check_near(shown({0.18f, 0.5f, 2}, ToneCurve::linear), {0.18f, 0.5f, 1}, 1e-5f);
}

// The specification: between 0.08 and 0.8 in all channels, out = in - 0.04 exactly.
TEST_CASE("Khronos PBR Neutral preserves base colours") {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> value(0.08f, 0.799f);
  for (int i = 0; i < 1000; ++i) {
    const vec3 c(value(random), value(random), value(random));
    check_near(shown(c, ToneCurve::neutral), c - 0.04f, 2e-6f);
  }
}

TEST_CASE("Khronos PBR Neutral below, above and at its seams") {
  // Below 0.08 the offset is m - 6.25 m^2 with m the smallest channel.
  check_near(shared::tone_neutral({0.04f, 0.3f, 0.5f}), {0.01f, 0.27f, 0.47f}, 1e-6f);
  check_near(shared::tone_neutral({0, 0.3f, 0.5f}), {0, 0.3f, 0.5f}, 1e-6f);
  // White 1: 0.96 after the offset; peak 1 - 0.24^2 / (0.96 + 0.24 - 0.76) = 0.869091.
  check_near(shared::tone_neutral(vec3(1)), vec3(0.8690909f), 1e-6f);
  // Red 4 (no offset): peak 1 - 0.0576 / 3.48 = 0.9834483; kept colour 1 / (0.15 (4 - 0.9834483) + 1) =
  // 0.6884815.
  check_near(shared::tone_neutral({4, 0, 0}), {0.9834483f, 0.3063626f, 0.3063626f}, 1e-5f);
  // Continuous where compression starts.
  check_near(shared::tone_neutral(vec3(0.8f + 1e-5f)), shared::tone_neutral(vec3(0.8f - 1e-5f)), 3e-5f);
}

TEST_CASE("Khronos PBR Neutral shifts no hue: colours stay in the plane of white and the input") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> stop(-4, 5);
  for (int i = 0; i < 1000; ++i) {
    const vec3 c(std::exp2(stop(random)), std::exp2(stop(random)), std::exp2(stop(random)));
    const vec3 t = shared::tone_neutral(c);
    const float size = glm::length(c) * std::sqrt(3.0f);
    CHECK(glm::dot(t, glm::cross(c, vec3(1))) / size == Approx(0).margin(2e-6));
  }
}

TEST_CASE("The AgX-like curve keeps middle grey, spans 16.5 stops and is smooth at its pivot") {
  check_near(shared::tone_agx(vec3(0.18f)), vec3(0.18f), 1e-5f);
  check_near(shared::tone_agx(vec3(0.18f * std::exp2(6.5f))), vec3(1), 1e-4f);
  check_near(shared::tone_agx(vec3(0.18f * std::exp2(-10.0f))), vec3(0), 1e-4f);
  const float x0 = 10.0f / 16.5f, h = 1e-2f;
  const float below = (shared::tone_agx_curve(x0) - shared::tone_agx_curve(x0 - h)) / h;
  const float above = (shared::tone_agx_curve(x0 + h) - shared::tone_agx_curve(x0)) / h;
  CHECK(below == Approx(2.4).margin(0.03));
  CHECK(above == Approx(2.4).margin(0.03));
}

TEST_CASE("The AgX-like curve desaturates strong lights") {
  for (const vec3& light : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}) {
    const auto saturation = [&](float strength) {
      const vec3 c = glm::clamp(shared::tone_agx(light * strength), 0.0f, 1.0f);
      return 1 - std::min({c.x, c.y, c.z}) / std::max({c.x, c.y, c.z});
    };
    CHECK(saturation(0.2f) > 0.85f);
    CHECK(saturation(100) < 0.35f);
    CHECK(saturation(1000) < saturation(10));
  }
}

// Rec.709 primaries and D65 (ITU-R BT.709), each primary moved 20 % of the way to white.
TEST_CASE("The AgX-like matrix follows its rule") {
  using glm::dmat3;
  using glm::dvec2;
  using glm::dvec3;
  const dvec2 white(0.3127, 0.3290);
  const auto to_xyz = [&](double attenuation) {
    dmat3 columns;
    const dvec2 primaries[3] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
    const auto xyz = [](const dvec2& p) { return dvec3(p.x / p.y, 1, (1 - p.x - p.y) / p.y); };
    for (int i = 0; i < 3; ++i) columns[i] = xyz(white + (1 - attenuation) * (primaries[i] - white));
    const dvec3 scale = glm::inverse(columns) * xyz(white);
    for (int i = 0; i < 3; ++i) columns[i] *= scale[i];
    return columns;
  };
  const dmat3 inset = glm::inverse(to_xyz(0)) * to_xyz(0.2);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(0.1, 2);
  for (int i = 0; i < 100; ++i) {
    const dvec3 c(value(random), value(random), value(random));
    dvec3 d = inset * c;
    for (int k = 0; k < 3; ++k) {
      const double x = (std::log2(d[k] / 0.18) + 10) / 16.5;
      d[k] = std::pow(shared::tone_agx_curve(static_cast<float>(x)), 2.2);
    }
    check_near(shared::tone_agx(vec3(c)), vec3(glm::inverse(inset) * d), 1e-5f);
  }
}

TEST_CASE("A picture has rounded bytes and full alpha") {
  const std::vector<vec3> pixels = {vec3(0), vec3(1), vec3(0.2152f, 10, NAN)};
  CHECK(film::tone_map_picture(pixels, 0, ToneCurve::linear) ==
        std::vector<uint8_t>{0, 0, 0, 255, 255, 255, 255, 255, 128, 255, 0, 255});
}

}  // namespace film_io_tonemap_tests
