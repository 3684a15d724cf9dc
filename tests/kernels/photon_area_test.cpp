// links: photons
// The surface area around a point (shaders/photons/area.glsl), compared with closed forms and with sums over
// points of random triangles.
#include <bit>
#include <catch2/catch.hpp>
#include <random>

#include "gpu/stream.h"
#include "shaders/shared/photons/photons.h"
#include "solvers/photons/surface_index.h"
#include "support/rooms.h"
#include "upload/flatten.h"

namespace photon_area_tests {

using namespace lucerna;

namespace {

struct Place {
  vec3 position;
  float radius;
  vec3 normal;
};

/// Areas by Epanechnikov's kernel and by the flat one.
std::vector<vec2> areas(const scene::Scene& scene, const std::vector<Place>& places) {
  static gpu::Device device({"", true});
  static gpu::ShaderCompiler compiler;
  static const gpu::Kernel kernel(
      device, compiler, std::string(LUCERNA_SOURCE_DIR) + "/tests/kernels/shaders/photon_area_probe.comp");
  const upload::FlatScene flat = upload::flatten(scene);
  photons::SurfaceIndex index(device);
  CHECK_FALSE(index.serves(flat));
  index.make(device, flat);
  CHECK(index.serves(flat));
  shared::PhotonFrame frame{};
  frame.surface_nodes = index.nodes();
  frame.most_visits = shared::k_photon_most_visits;
  gpu::Buffer block(device, {"photon lookups", sizeof frame});
  block.write(&frame, sizeof frame);
  gpu::Buffer place_buffer(device, {"places", places.size() * sizeof(Place)});
  place_buffer.write(std::span<const Place>(places));
  const gpu::Buffer answers(device, {"areas", places.size() * sizeof(vec2)});
  gpu::Resources resources;
  index.bind(resources);
  resources.set("PhotonBlock", block);
  resources.set("Places", place_buffer);
  resources.set("Areas", answers);
  gpu::Stream stream(device);
  stream.dispatch(kernel, resources, uint32_t(places.size()), gpu::groups_for(places.size(), 64));
  stream.run();
  CHECK(device.validation_messages() == 0);
  return answers.read_all<vec2>();
}

scene::Scene floor() {
  scene::Scene s;
  s.materials = {test::diffuse(vec3(0.5f))};
  test::add_quad(s, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  s.environment.given = true;
  return s;
}

/// The part to the left of x = d, -1..1, of a disc of radius 1 around the origin, weighted by 2 (1 - d^2) /
/// pi.
float left_of(float d) {
  double sum = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double x = -1 + (double(d) + 1) * (i + 0.5) / n, h = std::sqrt(1 - x * x);
    sum += (2 / 3.14159265358979) * 2 * (h * (1 - x * x) - h * h * h / 3) * (double(d) + 1) / n;
  }
  return float(sum);
}

/// The same unweighted: a segment of the disc.
float segment_left_of(float d) { return 0.5f + (std::asin(d) + d * std::sqrt(1 - d * d)) / k_pi; }

}  // namespace

TEST_CASE("inside a surface the whole disc counts, at its border the share of the closed form") {
  std::vector<Place> places;
  std::vector<vec2> expected;
  const auto expect_both = [&](const vec3& at, float radius, const vec2& area, const vec3& normal) {
    places.push_back({at, radius, normal}), expected.push_back(area);
  };
  const auto expect = [&](const vec3& at, float radius, float area, const vec3& normal = vec3(0, 1, 0)) {
    expect_both(at, radius, vec2(area), normal);
  };
  const vec3 up(0, 1, 0);
  for (const float r : {1e-4f, 0.01f, 0.2f}) {
    expect({0.1f, 0, 0.3f}, r, 1);
    expect({0, 0, 0}, r, 1);  // on the diagonal that two triangles share
    expect({1, 0, 0.1f}, r, 0.5f);
    expect({-1, 0, 1}, r, 0.25f);
    for (const float d : {-0.5f, 0.2f, 0.9f})
      expect_both({1 - d * r, 0, 0.1f}, r, {left_of(d), segment_left_of(d)}, up);
    expect_both({0.1f, 0.1f * r, 0.3f}, r, {0.99f * 0.99f, 0.99f}, up);  // above it: (1 - c^2)^2, 1 - c^2
    expect({0.1f, 0.3f * r, 0.3f}, r, 1.0f / 64);                        // too far above
    expect({0.1f, 0, 0.3f}, r, 1.0f / 64, {1, 0, 0});                    // another side
    expect({0.1f, 0, 0.3f}, r, 1, {0, -1, 0});                           // opposite winding
  }
  expect_both({0, 0, 0}, 10, {2 / k_pi / 100 * 4, 1.0f / 64}, up);  // smaller than the disc
  const std::vector<vec2> found = areas(floor(), places);
  for (size_t i = 0; i < places.size(); ++i) {
    INFO(places[i].position.x << " " << places[i].position.y << " " << places[i].position.z << ", radius "
                              << places[i].radius);
    for (int k = 0; k < 2; ++k)
      CHECK(found[i][k] == Approx(expected[i][k]).margin(i + 1 == places.size() ? 1e-3 : 2e-3));
  }
}

TEST_CASE("plates, layers and surfaces without photons") {
  scene::Scene s = floor();
  test::add_quad(s, {-0.5f, 0.01f, 0.5f}, {1, 0, 0}, {0, 0, -1});  // a mat
  // A plate: its lower side is not part of the upper one.
  test::add_quad(s, {-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
  test::add_quad(s, {-1, 0.98f, -1}, {2, 0, 0}, {0, 0, 2});
  // A mirror that continues a wall.
  s.materials.emplace_back();
  s.materials[1].metallic = 1;
  test::add_quad(s, {-1, 2, 1}, {1, 0, 0}, {0, 0, -2});
  test::add_quad(s, {0, 2, 1}, {1, 0, 0}, {0, 0, -2}, 1);
  const vec3 up(0, 1, 0);
  const std::vector<vec2> a = areas(s, {{{0.5f, 0.01f, 0}, 0.2f, up},  // the mat's border
                                        {{0.5f, 0, 0}, 0.2f, up},      // beside it
                                        {{1, 1, 0}, 0.2f, up},         // the plate's border
                                        {{0, 2, 0}, 0.2f, up},         // where the mirror begins
                                        {{0, 2, 0}, 0.2f, -up}});
  for (int k = 0; k < 2; ++k) {
    CHECK(a[0][k] == Approx(1));
    CHECK(a[1][k] == Approx(1));
    for (const size_t i : {2u, 3u, 4u}) CHECK(a[i][k] == Approx(0.5).margin(1e-3));
  }
  // Another material is another index.
  upload::FlatScene flat = upload::flatten(s);
  CHECK(photons::diffuse_materials(flat) == std::vector<bool>{true, false});
  s.materials[1].metallic = 0.5f;
  CHECK(photons::diffuse_materials(upload::flatten(s)) == std::vector<bool>{true, true});
}

TEST_CASE("for random triangles the area equals a sum over their points") {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0, 1);
  const auto point = [&](float spread) {
    return vec3(spread * (unit(random) - 0.5f), 0.15f * (unit(random) - 0.5f),
                spread * (unit(random) - 0.5f));
  };
  scene::Scene s;
  s.materials = {test::diffuse(vec3(0.5f))};
  s.environment.given = true;
  scene::Primitive p;
  for (uint32_t i = 0; i < 40; ++i) {
    const vec3 at = 6.0f * point(1);
    for (int k = 0; k < 3; ++k) p.positions.push_back(at + point(1.2f));
    p.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  test::add_mesh(s, "shards", p);
  std::vector<Place> places;
  for (int i = 0; i < 64; ++i) {
    const vec3 at = 5.0f * point(1);
    places.push_back({vec3(at.x, 0.3f * at.y, at.z), 0.6f,
                      glm::normalize(vec3(0.3f * (unit(random) - 0.5f), unit(random) < 0.5f ? 1 : -1, 0))});
  }
  const std::vector<vec2> found = areas(s, places);
  double most = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    const Place& at = places[i];
    double sum = 0, flat = 0;
    for (const uvec3& t : p.triangles) {
      const vec3 a = p.positions[t.x], b = p.positions[t.y], c = p.positions[t.z], n = cross(b - a, c - a);
      const float agree = dot(normalize(n), at.normal);
      if (std::abs(agree) <= shared::k_photon_normals) continue;
      const float slab = shared::k_photon_slab * at.radius * (agree < 0 ? shared::k_photon_turned_slab : 1);
      const int steps = 300;
      for (int u = 0; u < steps; ++u)
        for (int v = 0; v + u < steps; ++v)
          for (const float half : {1 / 3.0f, 2 / 3.0f}) {
            if (half > 0.5f && u + v + 2 > steps) continue;
            const vec3 x = a + (b - a) * ((float(u) + half) / steps) + (c - a) * ((float(v) + half) / steps) -
                           at.position;
            const float d2 = dot(x, x) / (at.radius * at.radius);
            if (d2 >= 1 || std::abs(dot(x, at.normal)) >= slab) continue;
            const double share =
                double(glm::length(n) / (k_pi * at.radius * at.radius)) / (2.0 * steps * steps);
            sum += share * double(2 * (1 - d2)), flat += share;
          }
    }
    INFO("place " << i);
    CHECK(double(found[i].x) == Approx(std::clamp(sum, 1.0 / 64, 1.0)).margin(0.004));
    CHECK(double(found[i].y) == Approx(std::clamp(flat, 1.0 / 64, 1.0)).margin(0.006));
    most = std::max(most, sum);
  }
  CHECK(most > 0.3);
}

}  // namespace photon_area_tests
