// links: session
// Paths that start inside absorbing solids, from cameras and from lights, and nested solids.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/render.h"
#include "support/rooms.h"

namespace media_tests {

using namespace lucerna;

namespace {

const vec3 k_water(0.5f, 0.25f, 0.8f);  // transmittance per metre

/// With index of refraction 1, so light is not bent; vec3(1): clear.
scene::Material solid(const vec3& a_metre) {
  scene::Material m;
  m.metallic = 0, m.roughness = 0, m.transmission = 1, m.ior = 1, m.thickness = 1;
  m.attenuation_color = a_metre, m.attenuation_distance = 1;
  return m;
}

void add_solid(scene::Scene& s, const vec3& lo, const vec3& hi, uint32_t material) {
  test::add_box(s, lo, hi, material);
  for (uvec3& t : s.meshes.back().primitives[0].triangles) std::swap(t.y, t.z);  // outwards
}

/// A camera that looks along -z at a lamp of radiance 1 at z = -10.
scene::Scene before_lamp(const vec3& eye, bool parallel) {
  scene::Scene s;
  s.name = "media", s.file = "media.gltf";
  s.materials = {test::diffuse(vec3(0), vec3(1)), solid(k_water), solid(vec3(1))};
  test::add_quad(s, {-50, -50, -10}, {100, 0, 0}, {0, 100, 0}, 0);
  scene::Camera c;
  c.orthographic = parallel, c.xmag = c.ymag = 0.2f, c.yfov = 0.01f;
  c.to_world[3] = vec4(eye, 1);
  s.cameras = {c};
  s.environment.given = true;
  return s;
}

const test::Settings k_no_roulette{{"path.roulette_depth", "64"}};

vec3 mean_color(const film::Image& image) {
  glm::dvec3 sum(0);
  for (size_t i = 0; i < image.samples.size(); ++i) sum += glm::dvec3(test::sum_at(image, i));
  return vec3(sum / double(image.samples.size()));
}

vec3 after(double metres) { return glm::pow(k_water, vec3(float(metres))); }

void check_color(const vec3& seen, const vec3& expected, double epsilon) {
  for (int c = 0; c < 3; ++c) CHECK(double(seen[c]) == Approx(double(expected[c])).epsilon(epsilon));
}

}  // namespace

TEST_CASE("a camera inside water sees through the water in between") {
  for (const bool parallel : {false, true}) {
    scene::Scene s = before_lamp({0.1f, 0.2f, 0}, parallel);
    add_solid(s, {-3, -3, -2}, {3, 3, 3}, 1);
    check_color(mean_color(test::render(s, k_no_roulette, 4, 8).image), after(2), 1e-3);
    // Half of a picture with parallel rays.
    if (!parallel) continue;
    s = before_lamp({0, 0, 0}, true);
    add_solid(s, {0, -3, -2}, {3, 3, 3}, 1);
    check_color(mean_color(test::render(s, k_no_roulette, 4, 8).image), 0.5f * (after(2) + vec3(1)), 1e-3);
  }
}

TEST_CASE("behind a clear object in water there is water again") {
  for (const float z : {5.0f, 0.0f}) {  // in front of the water, and inside
    scene::Scene s = before_lamp({0.1f, 0.2f, z}, true);
    add_solid(s, {-3, -3, -6}, {3, 3, 1}, 1);
    add_solid(s, {-1, -1, -3}, {1, 1, -1.5f}, 2);
    check_color(mean_color(test::render(s, k_no_roulette, 4, 8).image), after(z > 0 ? 5.5 : 4.5), 1e-3);
  }
}

TEST_CASE("a camera inside a clear object in water, and in a cavity of the water") {
  scene::Scene s = before_lamp({0.1f, 0.2f, 0}, true);
  add_solid(s, {-3, -3, -6}, {3, 3, 3}, 1);
  add_solid(s, {-1, -1, -1}, {1, 1, 1}, 2);
  check_color(mean_color(test::render(s, k_no_roulette, 4, 8).image), after(5), 1e-3);
  // The inner wall of a shell of water belongs to the same mesh, and faces inwards.
  s = before_lamp({0.1f, 0.2f, 0}, true);
  add_solid(s, {-3, -3, -6}, {3, 3, 3}, 1);
  test::add_box(s, vec3(-1), vec3(1), 1);
  check_color(mean_color(test::render(s, k_no_roulette, 4, 8).image), after(5), 1e-3);
}

TEST_CASE("where solids overlap the one entered last absorbs") {
  scene::Scene s = before_lamp({0.1f, 0.2f, 5}, true);
  s.materials.push_back(solid(vec3(0.7f)));
  add_solid(s, {-3, -3, -4}, {3, 3, 0}, 1);
  add_solid(s, {-3, -3, -6}, {3, 3, -2}, 3);
  // Two metres of water, then two of the solid entered last, then two of that solid alone.
  check_color(mean_color(test::render(s, k_no_roulette, 4, 8).image), after(2) * std::pow(0.7f, 4.0f), 1e-3);
}

TEST_CASE("lamps inside absorbing solids give the same light with photons, light tracing and paths") {
  // A lamp of either kind in the middle of a ball of water above a floor.
  for (const bool mesh : {false, true}) {
    scene::Scene clear;
    for (const bool absorbs : {false, true}) {
      scene::Scene s;
      s.name = "lamp", s.file = "lamp.gltf";
      s.materials = {test::diffuse(vec3(0.8f)), solid(absorbs ? k_water : vec3(1)),
                     test::diffuse(vec3(0), vec3(40)), solid(vec3(0.9f))};
      test::add_quad(s, {-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, 0);
      test::add_ball(s, {0, 1.5f, 0}, 0.5f, 1, 12);
      test::add_ball(s, {9, 1.5f, 0}, 0.5f, 3, 4);  // so that one material absorbs
      if (mesh)
        test::add_ball(s, {0, 1.5f, 0}, 0.05f, 2, 6);
      else
        s.lights.push_back({.name = "lamp", .intensity = vec3(5), .position = {0, 1.5f, 0}});
      s.cameras = {test::looking_down({0, 0.7f, 0}, 0.5f)};
      s.environment.given = true;
      if (!absorbs) {
        clear = s;
        continue;
      }
      vec3 expected = after(0.497);  // facets of the ball lie slightly inside it
      for (const char* way : {"path", "photons", "light"}) {
        if (!mesh && std::string(way) == "path") continue;
        const test::Settings settings{{"components.caustic", way}, {"photons.efficiency", "false"}};
        const uint32_t samples = std::string(way) == "path" ? 512 : 8;
        const vec3 with = mean_color(test::render(s, settings, samples, 16, false).image),
                   without = mean_color(test::render(clear, settings, samples, 16, false).image);
        INFO((mesh ? "mesh, " : "point, ") << way);
        if (std::string(way) == "path") expected = with / without;
        check_color(with / without, expected, 0.015);
        CHECK(expected.x < 0.8f);
      }
    }
  }
}

TEST_CASE("light under water reaches a camera under water with every solver") {
  // The room is filled with water of index of refraction 1.
  test::PanelRoom room;
  room.s.materials.push_back(solid(k_water));
  add_solid(room.s, {-1.5f, -0.5f, -1.5f}, {1.5f, 1.5f, 1.5f}, 2);
  room.s.lights.push_back({.name = "lamp", .intensity = vec3(1), .position = {-0.5f, 0.5f, 0}});
  // A mirror for caustics.
  room.s.materials.push_back({});
  room.s.materials[3].metallic = 1, room.s.materials[3].roughness = 0.3f;
  room.quad({-0.9f, 0.01f, -0.5f}, {0, 0, 1}, {0.3f, 0.3f, 0}, 3);
  const test::Result paths = test::render(room.s, {}, 2048, 32, false);
  const auto check = [&](const test::Settings& settings, std::initializer_list<int> components,
                         uint32_t samples, double epsilon) {
    const test::Result r = test::render(room.s, settings, samples, 32, false);
    for (const int c : components)
      for (int channel = 0; channel < 3; ++channel) {
        double truth = 0, seen = 0;
        for (size_t i = 0; i < r.image.samples.size(); ++i)
          truth += double(paths.image.components[size_t(c)][i][channel]),
              seen += double(r.image.components[size_t(c)][i][channel]);
        INFO(settings.begin()->first << "=" << settings.begin()->second << ", component " << c << ", channel "
                                     << channel);
        CHECK(seen == Approx(truth).epsilon(epsilon));
      }
  };
  check({{"components.caustic", "light"}}, {3}, 32, 0.05);
  check({{"components.caustic", "photons"},
         {"components.secondary", "photons"},
         {"components.tertiary", "photons"},
         {"photons.efficiency", "false"}},
        {1, 2, 3}, 16, 0.05);
  check({{"components.secondary", "cache"}, {"components.tertiary", "cache"}}, {1, 2}, 16, 0.05);
}

}  // namespace media_tests
