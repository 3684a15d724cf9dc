// links: film
// Automatic exposure: of even pictures, of noise, of windows and of objects in the dark; and of a point.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "film/exposure.h"

namespace film_exposure_tests {

using namespace lucerna;
using namespace lucerna::film;

namespace {

constexpr uint32_t k_width = 240, k_height = 135;

template <class F>
std::vector<vec3> picture(F&& at) {
  std::vector<vec3> pixels;
  for (uint32_t y = 0; y < k_height; ++y)
    for (uint32_t x = 0; x < k_width; ++x) pixels.push_back(at(x, y));
  return pixels;
}

float ev_of(const std::vector<vec3>& pixels) {
  return measure_picture(pixels, k_width, k_height).ev.value_or(99);
}

}  // namespace

TEST_CASE("an even picture becomes middle grey, whatever its scale") {
  for (const float grey : {1e-4f, 0.05f, 0.18f, 3.0f, 1e4f}) {
    const float ev = ev_of(picture([&](uint32_t, uint32_t) { return vec3(grey); }));
    CHECK(grey * std::exp2(ev) == Approx(0.18).epsilon(0.04));  // a tenth of a stop
  }
}

TEST_CASE("one noisy sample per pixel is enough") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(0, 1);
  // Nine pixels of ten are black, as where light is rarely found.
  const float ev = ev_of(picture([&](uint32_t, uint32_t) { return vec3(u(random) < 0.1f ? 0.5f : 0.0f); }));
  CHECK(0.05 * std::exp2(ev) == Approx(0.18).epsilon(0.15));
}

TEST_CASE("a window does not darken the room, a sunlit wall does") {
  const auto room = [](float bright, float share) {
    return ev_of(
        picture([&](uint32_t x, uint32_t) { return vec3(float(x) < share * k_width ? bright : 0.1f); }));
  };
  CHECK(std::abs(room(0.1f, 0) - room(1000, 0.03f)) < 1);
  CHECK(5 * std::exp2(room(5, 0.4f)) <= 2.2f);  // at most one stop above white
  CHECK(room(5, 0.4f) < room(0.1f, 0) - 1);
}

TEST_CASE("objects in the dark set the exposure, not the dark around them") {
  const auto thing = picture([](uint32_t x, uint32_t y) {
    return vec3(std::hypot(float(x) - 120, float(y) - 67) < 40 ? 0.4f : 0.0f);
  });
  CHECK(0.4 * std::exp2(ev_of(thing)) == Approx(0.18).epsilon(0.35));
  // A lamp of only a few pixels is shown, not overexposed away.
  const auto lamp = picture([](uint32_t x, uint32_t y) { return vec3(x < 4 && y < 4 ? 50.0f : 0.0f); });
  CHECK(ev_of(lamp) > -8);
  CHECK(ev_of(lamp) < 5);
}

TEST_CASE("black has no exposure; non-finite values are ignored") {
  CHECK_FALSE(measure_picture(picture([](uint32_t, uint32_t) { return vec3(0); }), k_width, k_height).ev);
  CHECK_FALSE(measure_picture({}, 0, 0).ev);
  CHECK_FALSE(measure_picture({}, 10, 10).ev);
  const auto odd = picture([](uint32_t x, uint32_t) { return vec3(x % 50 == 0 ? NAN : 0.18f); });
  CHECK(std::abs(ev_of(odd)) < 0.06f);
  CHECK(ev_of(picture([](uint32_t, uint32_t) { return vec3(1e-30f); })) == 20);
}

TEST_CASE("a point becomes middle grey by its surroundings") {
  const auto halves = picture([](uint32_t x, uint32_t) { return x < 120 ? vec3(0.02f, 0.01f, 0) : vec3(2); });
  const Brightness left = measure_point(halves, k_width, k_height, {0.25f, 0.5f});
  CHECK(luminance(vec3(0.02f, 0.01f, 0)) * std::exp2(*left.ev) == Approx(0.18));
  CHECK(left.color.y == Approx(0.01));
  CHECK(2 * std::exp2(*measure_point(halves, k_width, k_height, {1, 1}).ev) == Approx(0.18));
  CHECK(2 * std::exp2(*measure_point(halves, k_width, k_height, {7, -3}).ev) == Approx(0.18));  // clamped
  CHECK_FALSE(
      measure_point(picture([](uint32_t, uint32_t) { return vec3(0); }), k_width, k_height, {0, 0}).ev);
}

}  // namespace film_exposure_tests
