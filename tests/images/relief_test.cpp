// links: session
// Relief by height textures: slopes of shallow relief in closed form; deep relief against the geometry that
// it stands for, its energy, and the same light by paths from the eye and from lights.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/caustics.h"

namespace relief_tests {

using namespace lucerna;

namespace {

constexpr double k_pi_d = 3.14159265358979323846;

scene::TextureUse add_texture(scene::Scene& s, uint32_t width, scene::Wrap wrap, double (*height)(double)) {
  scene::Image image;
  image.name = "height", image.width = width, image.height = 1;
  for (uint32_t i = 0; i < width; ++i) {
    const auto h = float(height((i + 0.5) / width));
    image.floats.insert(image.floats.end(), {h, h, h, 1});
  }
  s.images.push_back(image);
  s.textures.push_back({.image = scene::Id(s.images.size() - 1), .wrap_u = wrap, .wrap_v = wrap});
  return {.texture = scene::Id(s.textures.size() - 1)};
}

/// Orthographic, from `from` to the origin; the picture shows 2 * half metres.
scene::Camera view(const vec3& from, float half) {
  scene::Camera c;
  const vec3 z = normalize(from), x = normalize(cross(vec3(0, 0, -1), z)), y = cross(z, x);
  c.to_world = mat4(vec4(x, 0), vec4(y, 0), vec4(z, 0), vec4(3.f * z, 1));
  c.orthographic = true, c.xmag = c.ymag = half;
  return c;
}

scene::Light sun(const vec3& to_sun) {
  scene::Light l{.name = "sun", .kind = scene::LightKind::directional, .intensity = vec3(2)};
  l.direction = -normalize(to_sun);
  return l;
}

/// A floor of 2 by 2 m, seen from above, below a sun.
scene::Scene lit_floor(const vec3& to_sun) {
  scene::Scene s;
  s.name = "floor";
  s.materials = {test::diffuse(vec3(0.5f))};
  test::add_quad(s, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 0);
  s.lights = {sun(to_sun)};
  s.cameras = {view({0, 1, 0}, 0.4f)};
  s.environment.given = true;
  return s;
}

double ramp(double u) { return u; }

constexpr float k_height = 0.1f, k_period = 0.25f;
double wave(double u) { return 0.5 + 0.5 * std::cos(2 * k_pi_d * u); }

/// Waves along x, white on y = 0: by a texture, or as a surface.
scene::Scene waves(bool real, float albedo, const vec3& from) {
  scene::Scene s = lit_floor({-1, 0.7f, 0.2f});
  s.materials = {test::diffuse(vec3(albedo))};
  s.cameras = {view(from, 0.3f)};
  if (!real) {
    scene::Material& m = s.materials[0];
    m.height_texture = add_texture(s, 256, scene::Wrap::repeat, wave);
    m.height_texture.m[0] = 2 / k_period;
    m.height = k_height, m.deep_relief = true;
    return s;
  }
  s.meshes = {}, s.instances = {};
  scene::Primitive p;
  constexpr uint32_t k_steps = 8 * 64;
  for (uint32_t i = 0; i <= k_steps; ++i)
    for (const float z : {1.f, -1.f}) {
      const double x = -1 + 2.0 * i / k_steps, phase = 2 * k_pi_d * (x + 1) / double(k_period);
      p.positions.emplace_back(float(x), k_height * float(0.5 * std::cos(phase) - 0.5), z);
      const double slope = -double(k_height) * k_pi_d / double(k_period) * std::sin(phase);
      p.normals.push_back(normalize(vec3(float(-slope), 1, 0)));
    }
  for (uint32_t i = 0; i < k_steps; ++i) {
    const uint32_t a = 2 * i;
    p.triangles.emplace_back(a, a + 2, a + 3);
    p.triangles.emplace_back(a, a + 3, a + 1);
  }
  test::add_mesh(s, "waves", p);
  return s;
}

double mean(const film::Image& image) {
  double sum = 0;
  for (int c = 0; c < 4; ++c) sum += test::mean_of(image, c).value.y;
  return sum;
}

}  // namespace

TEST_CASE("shallow relief is lit by its slope: heights in metres, both sets of coordinates, transforms") {
  const vec3 to_sun = normalize(vec3(0.5f, 1, 0.3f));
  for (const float height : {0.4f, -0.8f})
    for (const bool second : {false, true}) {
      INFO("height " << height << ", second set " << second);
      scene::Scene s = lit_floor(to_sun);
      scene::Material& m = s.materials[0];
      m.height_texture = add_texture(s, 64, scene::Wrap::clamp, ramp);
      m.height = height;
      vec3 normal = normalize(vec3(-height / 2, 1, 0));
      if (second) {
        // u towards -z, over twice the floor.
        s.meshes[0].primitives[0].uv1 = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
        m.height_texture.uv_set = 1, m.height_texture.m = {0.5f, 0, 0.25f, 0, 0.5f, 0};
        normal = normalize(vec3(0, 1, height / 4));
      }
      const test::Result r = test::render(s, {{"path.max_depth", "1"}}, 4, 16);
      CHECK(test::mean_of(r.image, 0).value.y ==
            Approx(0.5 / k_pi_d * 2 * double(dot(normal, to_sun))).epsilon(2e-3));
    }
}

TEST_CASE("deep relief looks like the geometry that it stands for") {
  const vec3 from(0.9f, 1, 0.2f);
  // The sun alone: what hides, and what shadows.
  const test::Settings direct{{"path.max_depth", "1"}};
  const test::Result relief = test::render(waves(false, 0.6f, from), direct, 32, 48),
                     real = test::render(waves(true, 0.6f, from), direct, 32, 48);
  CHECK(mean(relief.image) == Approx(mean(real.image)).epsilon(0.01));
  double off = 0;
  size_t dark = 0;
  for (size_t i = 0; i < real.image.components[0].size(); ++i) {
    const double a = double(relief.image.components[0][i].y), b = double(real.image.components[0][i].y);
    off += std::abs(a - b), dark += b < 0.02;
  }
  const auto pixels = double(real.image.components[0].size());
  CHECK(off / pixels < 0.03 * mean(real.image));
  CHECK(double(dark) > 0.2 * pixels);  // shadows are there
  // Light between its slopes, below an even sky.
  const auto below_sky = [&](bool is_real) {
    scene::Scene s = waves(is_real, 0.8f, from);
    s.lights.clear();
    s.environment.radiance = vec3(1);
    return mean(test::render(s, {}, 256, 32).image);
  };
  const double seen = below_sky(false), expected = below_sky(true);
  REQUIRE(expected < 0.77);  // of .8 without relief
  CHECK(seen == Approx(expected).epsilon(0.01));
}

TEST_CASE("white deep relief below an even sky is as bright as the sky") {
  scene::Scene s = waves(false, 1, {0.9f, 1, 0.2f});
  s.lights.clear();
  s.environment.radiance = vec3(1);
  CHECK(mean(test::render(s, {{"path.max_depth", "64"}}, 64, 32).image) == Approx(1).epsilon(5e-3));
}

TEST_CASE("deep relief is lit alike by paths from the eye, light tracing and photons") {
  const vec3 from(0.9f, 1, 0.2f), to_sun = normalize(vec3(-0.45f, 1, -0.1f));
  const test::Settings direct{{"path.max_depth", "1"}};
  scene::Scene plain = waves(false, 0.8f, from);
  plain.lights = {sun(to_sun)};
  const double paths = test::mean_of(test::render(plain, direct, 64, 32).image, 0).value.y;
  // The same light by way of a mirror, which paths cannot find.
  scene::Scene mirrored = waves(false, 0.8f, from);
  mirrored.lights = {sun({-1, 0, 0})};
  scene::Material mirror = test::diffuse(vec3(1));
  mirror.metallic = 1, mirror.roughness = 0;
  mirrored.materials.push_back(mirror);
  const vec3 n = normalize(-to_sun - vec3(1, 0, 0)), u = normalize(cross(n, vec3(0, 0, 1))), v = cross(n, u);
  test::add_quad(mirrored, 2.5f * to_sun - u - v, 2.f * u, 2.f * v, 1);
  test::Settings only{
      {"components.primary", "off"}, {"components.secondary", "off"}, {"components.tertiary", "off"}};
  const auto caustic = [&](const test::Settings& settings) {
    return test::mean_of(test::render(mirrored, test::with(only, settings), 32, 32, false).image, 3).value.y;
  };
  const double light = caustic({{"components.caustic", "light"}, {"light.per_round", "200000"}}),
               photons = caustic({{"components.caustic", "photons"},
                                  {"photons.efficiency", "false"},
                                  {"photons.per_round", "200000"},
                                  {"photons.radius", "0.3"}});
  INFO("light tracing " << light / paths << ", photons " << photons / paths);
  CHECK(light == Approx(paths).epsilon(0.02));
  CHECK(photons == Approx(paths).epsilon(0.02));
}

TEST_CASE("without a direction of texture coordinates there is no relief, and no error") {
  for (const bool deep : {false, true}) {
    scene::Scene s = lit_floor({0, 1, 0});
    s.meshes[0].primitives[0].uv0.assign(4, vec2(0.5f));
    scene::Material& m = s.materials[0];
    m.height_texture = add_texture(s, 64, scene::Wrap::clamp, ramp);
    m.height = 0.4f, m.deep_relief = deep;
    const test::Result r = test::render(s, {{"path.max_depth", "1"}}, 4, 16);
    CHECK(test::mean_of(r.image, 0).value.y == Approx(0.5 / k_pi_d * 2).epsilon(1e-3));
  }
}

}  // namespace relief_tests
