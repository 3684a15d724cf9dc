// links: session
// Dispersion: a prism deviates every wavelength by its own angle, for eye paths and for light paths; a
// parallel plate keeps white light white.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/caustics.h"

namespace dispersion_tests {

using namespace lucerna;

namespace {

constexpr double k_wedge = 20 * 3.14159265358979 / 180;
constexpr float k_ior = 1.5f, k_dispersion = 2;

/// As in shaders/lib/dispersion.glsl: `place` 0..1 is 400 to 700 nm.
double ior_at(double place) {
  const double wavelength = 0.4 + 0.3 * place;
  const double lines = 1 / (0.4861 * 0.4861) - 1 / (0.6563 * 0.6563);
  return k_ior +
         (k_ior - 1) * k_dispersion / (20 * lines) * (1 / (wavelength * wavelength) - 1 / (0.5876 * 0.5876));
}
double color_at(double place, int channel) {
  const double middle[] = {0.78, 0.5, 0.22}, half[] = {0.22, 0.24, 0.22};
  return std::max(1 - std::abs(place - middle[channel]) / half[channel], 0.0) / half[channel];
}
double transmittance(double cosine, double eta) {
  const double there = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
  const double p = (eta * cosine - there) / (eta * cosine + there),
               s = (cosine - eta * there) / (cosine + eta * there);
  return 1 - 0.5 * (p * p + s * s);
}
/// Of a ray that enters a prism at right angles: the deviation, and what is let through.
double deviation(double n) { return std::asin(n * std::sin(k_wedge)) - k_wedge; }
double through(double n) { return transmittance(1, n) * transmittance(std::cos(k_wedge), 1 / n); }
/// Mean over the wavelengths.
template <class F>
double mean_over(int channel, const F& f) {
  constexpr int k_steps = 20000;
  double sum = 0;
  for (int i = 0; i < k_steps; ++i) {
    const double place = (i + 0.5) / k_steps;
    sum += color_at(place, channel) * f(ior_at(place));
  }
  return sum / k_steps;
}

scene::Material glass(float dispersion) {
  scene::Material m;
  m.metallic = 0, m.roughness = 0, m.transmission = 1, m.thickness = 1, m.ior = k_ior;
  m.dispersion = dispersion;
  return m;
}

/// Radiance of the sky, by the angle from -z towards -x.
double sky_at(double angle) { return std::clamp((angle * 180 / 3.14159265358979 - 8) / 8, 0.0, 1.0); }

/// A parallel view along -z through a prism, whose second face is turned by k_wedge towards -x, onto that
/// sky.
scene::Scene prism() {
  scene::Scene s;
  s.name = "prism";
  s.materials = {glass(k_dispersion)};
  test::add_quad(s, {-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 0);
  const float t = float(std::tan(k_wedge));
  test::add_quad(s, {5, -5, -3 + 5 * t}, {-10, 0, -10 * t}, {0, 10, 0}, 0);
  scene::Camera c;
  c.orthographic = true, c.xmag = c.ymag = 0.1f, c.to_world[3] = vec4(0, 0, 2, 1);
  s.cameras = {c};
  scene::Image sky;
  sky.name = "sky", sky.width = 3600, sky.height = 2;
  for (uint32_t i = 0; i < 2 * sky.width; ++i) {
    // u = 1/4 is -z; smaller ones lie towards -x.
    const double u = (i % sky.width + 0.5) / sky.width;
    const auto value = float(u < 0.25 ? sky_at((0.25 - u) * 2 * 3.14159265358979) : 0);
    sky.floats.insert(sky.floats.end(), {value, value, value, 1});
  }
  s.images.push_back(sky);
  s.environment.image = 0, s.environment.given = true;
  return s;
}

}  // namespace

TEST_CASE("a prism spreads the sky behind it by wavelength") {
  const test::Settings direct{{"path.max_depth", "2"}};  // no reflections within the prism
  const test::Result r = test::render(prism(), direct, 256, 8);
  const auto expected = [](int c) {
    return mean_over(c, [](double n) { return through(n) * sky_at(deviation(n)); });
  };
  REQUIRE(expected(2) > 1.2 * expected(0));
  const test::MeanOf m = test::mean_of(r.image, 0);
  for (int c = 0; c < 3; ++c) CHECK(m.value[c] == Approx(expected(c)).epsilon(0.015));
  // Without dispersion: one deviation for all.
  scene::Scene plain = prism();
  plain.materials[0].dispersion = 0;
  const test::MeanOf same = test::mean_of(test::render(plain, direct, 16, 8).image, 0);
  for (int c = 0; c < 3; ++c)
    CHECK(same.value[c] == Approx(through(k_ior) * sky_at(deviation(k_ior))).epsilon(0.01));
}

TEST_CASE("a plate of dispersive glass under an even sky looks like one without dispersion") {
  for (const float roughness : {0.0f, 0.4f}) {
    INFO("roughness " << roughness);
    glm::dvec3 found[2];
    for (const bool disperses : {false, true}) {
      scene::Scene s;
      s.name = "plate";
      s.materials = {glass(disperses ? 0.6f : 0.0f)};
      s.materials[0].roughness = roughness;
      test::add_box(s, {-4, -4, -1}, {4, 4, 0});
      // Outwards.
      for (scene::Mesh& mesh : s.meshes)
        for (scene::Primitive& p : mesh.primitives) {
          for (uvec3& t : p.triangles) std::swap(t.y, t.z);
          for (vec3& n : p.normals) n = -n;
        }
      scene::Camera c;
      c.orthographic = true, c.xmag = c.ymag = 0.1f, c.to_world[3] = vec4(0, 0, 2, 1);
      s.cameras = {c};
      s.environment.radiance = vec3(1), s.environment.given = true;
      glm::dvec3 sum(0);
      const test::Result r = test::render(s, {{"path.max_depth", "32"}}, 256, 8);
      for (int component = 0; component < 4; ++component) sum += test::mean_of(r.image, component).value;
      found[disperses] = sum;
    }
    for (int c = 0; c < 3; ++c) CHECK(found[1][c] == Approx(found[0][c]).epsilon(0.02));
  }
}

TEST_CASE("light paths leave a prism by wavelength too") {
  // The sun shines down through a narrow prism onto a floor below it, which a parallel camera sees from
  // between.
  constexpr float k_half = 0.1f, k_height = 1;
  scene::Scene s;
  s.name = "prism over a floor";
  s.materials = {test::diffuse(vec3(0.5f)), glass(k_dispersion)};
  test::add_quad(s, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 0);
  const float t = float(std::tan(k_wedge));
  test::add_quad(s, {-k_half, k_height + 0.2f, 1}, {2 * k_half, 0, 0}, {0, 0, -2}, 1);
  test::add_quad(s, {k_half, k_height + k_half * t, 1}, {-2 * k_half, -2 * k_half * t, 0}, {0, 0, -2}, 1);
  s.lights = {{.name = "sun", .kind = scene::LightKind::directional, .intensity = vec3(1)}};
  s.lights[0].direction = {0, -1, 0};
  s.cameras = {test::looking_down({0, 0.5f, 0}, 0.8f)};
  s.cameras[0].orthographic = true, s.cameras[0].xmag = s.cameras[0].ymag = 0.5f;
  s.environment.given = true;
  constexpr uint32_t k_side = 64;
  const test::Result r =
      test::render(s, {{"components.caustic", "light"}, {"light.per_round", "100000"}}, 24, k_side);
  glm::dvec3 light(0), moment(0);
  for (uint32_t y = 0; y < k_side; ++y)
    for (uint32_t x = 0; x < k_side; ++x) {
      const glm::dvec3 v(r.image.components[3][size_t{y} * k_side + x]);
      light += v, moment += v * ((x + 0.5) / k_side - 0.5);
    }
  // The rays are turned towards the thick end, as the second face's normal (sin, -cos) leans to +x.
  for (int c = 0; c < 3; ++c) {
    const auto part = [&](double n) { return through(n); };
    const auto moved = [&](double n) { return -k_height * std::tan(deviation(n)) * through(n); };
    const double total = mean_over(c, part);
    // Radiance 1/2 / pi over a stripe 0.2 m wide in a picture 1 m wide.
    CHECK(light[c] / (k_side * k_side) == Approx(total * 0.2 * 0.5 / double(k_pi)).epsilon(0.02));
    CHECK(std::abs(moment[c] / light[c]) == Approx(std::abs(mean_over(c, moved) / total)).epsilon(0.02));
  }
  CHECK(std::abs(moment[2] / light[2]) > 1.05 * std::abs(moment[0] / light[0]));
}

}  // namespace dispersion_tests
