// links: film_io
#include "film/io/flip.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "film/io/compare.h"

namespace film_io_flip_tests {

using namespace lucerna;

namespace {

constexpr uint32_t k_size = 24;
using Picture = std::vector<vec3>;

Picture flat(const vec3& colour) { return Picture(k_size * k_size, colour); }

Picture noise(uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> u(0, 1);
  Picture p(k_size * k_size);
  for (vec3& v : p) v = {u(random), u(random), u(random)};
  return p;
}

double mean(const std::vector<float>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / double(v.size());
}

/// A part of CIELAB: f(t) of the cube root, for t above 0.0089.
double f(double t) { return std::cbrt(t); }

/// The greatest distance, between pure green and pure blue, by the formulas of CIELAB and HyAB. XYZ over
/// white's of sRGB's primaries (IEC 61966-2-1).
double most_distance() {
  const double gx = 0.3576 / 0.9505, gy = 0.7152, gz = 0.1192 / 1.0890, bx = 0.1805 / 0.9505, by = 0.0722,
               bz = 0.9505 / 1.0890;
  const double gl = 116 * f(gy) - 16, bl = 116 * f(by) - 16;
  const double ga = 0.01 * gl * 500 * (f(gx) - f(gy)), gb = 0.01 * gl * 200 * (f(gy) - f(gz)),
               ba = 0.01 * bl * 500 * (f(bx) - f(by)), bb = 0.01 * bl * 200 * (f(by) - f(bz));
  return std::pow(gl - bl + std::hypot(ga - ba, gb - bb), 0.7);
}

/// Of a distance of lightness alone.
double flip_of_lightness(double distance) {
  const double most = most_distance(), d = std::pow(distance, 0.7);
  return d < 0.4 * most ? 0.95 * d / (0.4 * most) : 0.95 + 0.05 * (d - 0.4 * most) / (0.6 * most);
}

void check_flat(const vec3& a, const vec3& b, double expected) {
  for (const float e : film::flip(k_size, flat(a), flat(b)))
    CHECK(e == Approx(expected).epsilon(1e-3).margin(1e-6));
}

}  // namespace

TEST_CASE("FLIP of equal pictures is 0, and it is symmetric") {
  const Picture a = noise(1), b = noise(2);
  for (const float e : film::flip(k_size, a, a)) CHECK(e == 0);
  for (const float e : film::flip_hdr(k_size, a, a)) CHECK(e == 0);
  const std::vector<float> there = film::flip(k_size, a, b), back = film::flip(k_size, b, a);
  CHECK(there == back);
  for (const float e : there) {
    CHECK(e > 0);
    CHECK(e <= 1);
  }
}

TEST_CASE("FLIP of flat colours follows from their distance") {
  check_flat(vec3(0, 1, 0), vec3(0, 0, 1), 1);  // the largest distance
  check_flat(vec3(0), vec3(1), flip_of_lightness(100));
  CHECK(flip_of_lightness(100) == Approx(0.967).margin(0.002));
  // Greys of luminance 0.2 and 0.25: lightness 116 cbrt(Y) - 16.
  check_flat(vec3(0.2f), vec3(0.25f), flip_of_lightness(116 * (f(0.25) - f(0.2))));
  // Colours beyond the display's are shown as its brightest.
  check_flat(vec3(5), vec3(1), 0);
}

TEST_CASE("FLIP counts a line more than the same difference spread out, and less from afar") {
  Picture line = flat(vec3(0.2f)), spread = line;
  for (uint32_t y = 0; y < k_size; ++y) {
    line[y * k_size + 12] = vec3(0.6f);
    for (uint32_t x = 0; x < k_size; ++x) spread[y * k_size + x] = vec3(0.2f + 0.4f / k_size);
  }
  const Picture grey = flat(vec3(0.2f));
  const std::vector<float> e = film::flip(k_size, line, grey);
  CHECK(e[12 * k_size + 12] > 2 * film::flip(k_size, spread, grey)[12 * k_size + 12]);
  CHECK(e[12 * k_size] < 0.1f * e[12 * k_size + 12]);
  CHECK(mean(film::flip(k_size, noise(1), noise(2), {.pixels_per_degree = 134})) <
        0.9 * mean(film::flip(k_size, noise(1), noise(2))));
}

TEST_CASE(
    "FLIP of radiance does not depend on the unit, and sees differences in the dark and in the bright") {
  Picture reference = flat(vec3(0.01f));
  for (uint32_t i = 0; i < k_size * k_size / 3; ++i) reference[i] = vec3(20);
  const auto changed = [&](size_t pixel, float factor) {
    Picture p = reference;
    for (size_t i = 0; i < p.size(); ++i)
      if (i / k_size == pixel / k_size) p[i] *= factor;
    return film::flip_hdr(k_size, p, reference)[pixel];
  };
  const size_t bright = 3 * k_size + 10, dark = 18 * k_size + 10;
  CHECK(changed(bright, 1.3f) > 0.05f);
  CHECK(changed(dark, 1.3f) > 0.05f);
  Picture a = noise(3), b = noise(4);
  const double before = mean(film::flip_hdr(k_size, a, b));
  for (Picture* p : {&a, &b})
    for (vec3& v : *p) v *= 1024.0f;
  CHECK(mean(film::flip_hdr(k_size, a, b)) == Approx(before).epsilon(1e-4));
  CHECK(mean(film::flip_hdr(k_size, flat(vec3(0)), flat(vec3(0)))) == 0);
}

TEST_CASE("A comparison contains FLIP where it is defined") {
  const auto image = [](const vec3& colour) {
    film::FilmImage i{.width = 16, .height = 16, .channels = {}, .halves = {}, .metadata = {}};
    for (const auto& [name, value] :
         {std::pair("R", colour.x), {"G", colour.y}, {"B", colour.z}, {"Z", 1.0f}})
      i.channels.emplace_back(name, std::vector<float>(256, value));
    return i;
  };
  const film::FilmImage a = image(vec3(0.2f)), b = image(vec3(0.25f));
  film::CompareOptions encoded;
  encoded.encoded = true;
  CHECK(film::compare(a, a).flip == 0.0);
  const double of_light = film::compare(a, b).flip.value_or(-1),
               of_display = film::compare(a, b, "", encoded).flip.value_or(-1);
  CHECK(of_light > 0.02);
  // Encoded 0.2 and 0.25 are linear 0.0331 and 0.0508.
  CHECK(of_display == Approx(flip_of_lightness(116 * (f(0.050876) - f(0.033105)))).epsilon(1e-3));
  CHECK_FALSE(film::compare(a, b, "Z").flip);
  film::FilmImage bad = a;
  bad.channels[1].second[7] = std::nanf("");
  CHECK_FALSE(film::compare(bad, b).flip);
  CHECK(film::to_text(film::compare(a, b)).find("FLIP") != std::string::npos);
  CHECK(film::to_json(film::compare(bad, b)).find("\"flip\":null") != std::string::npos);
}

}  // namespace film_io_flip_tests
