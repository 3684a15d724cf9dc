// links: plan scene_io bvh_embree
// The scenes that come with the program: each loads without warnings with valid settings, and is listed; rays
// leave rooms only through their openings.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "bvh/embree/host_tracer.h"
#include "plan/settings.h"
#include "scene/io/load.h"
#include "scene/lamp.h"
#include "unit/bvh_support.h"

namespace scenes_tests {

using namespace lucerna;
using bvh::test::Random;

namespace {

const std::filesystem::path k_scenes = std::filesystem::path(LUCERNA_SOURCE_DIR) / "scenes";

std::filesystem::path file_of(const std::string& name) { return k_scenes / name / (name + ".gltf"); }

std::set<std::string> names() {
  std::set<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(k_scenes))
    if (entry.is_directory() && entry.path().filename() != "generate") out.insert(entry.path().filename());
  return out;
}

/// An opening of a room: an axis-aligned rectangle in the outer face of its wall or roof.
struct Opening {
  vec3 lo, hi;
};

/// Also true for rays that start outside, for example at the eaves that a ray through a window can hit.
bool passes(const shared::Ray& ray, const Opening& o) {
  const int axis = o.lo.x == o.hi.x ? 0 : o.lo.y == o.hi.y ? 1 : 2;
  if (std::abs(ray.origin[axis]) > std::abs(o.lo[axis])) return true;
  const float t = (o.lo[axis] - ray.origin[axis]) / ray.direction[axis];
  if (!(t > 0)) return false;
  for (int k = 0; k < 3; ++k) {
    const float at = ray.origin[k] + t * ray.direction[k];
    if (k != axis && (at < o.lo[k] - 1e-3f || at > o.hi[k] + 1e-3f)) return false;
  }
  return true;
}

bvh::test::Mesh triangles(const scene::Scene& s) {
  bvh::test::Mesh mesh;
  for (const scene::Instance& instance : s.instances)
    for (const scene::Primitive& p : s.meshes[instance.mesh].primitives) {
      const auto at = [&](uint32_t i) { return vec3(instance.to_world * vec4(p.positions[i], 1)); };
      for (const uvec3& t : p.triangles) mesh.add(at(t.x), at(t.y), at(t.z));
    }
  return mesh;
}

/// Rays in all directions from the cameras, then from their hit points; returns the number of rays that hit
/// nothing and passed no opening.
size_t leaks(const scene::Scene& s, const std::vector<Opening>& openings, size_t& left) {
  const bvh::test::Mesh mesh = triangles(s);
  const bvh::HostTracer tracer(mesh.view());
  Random random(7);
  std::vector<shared::Ray> rays(1 << 16);
  std::vector<shared::Hit> hits(rays.size());
  size_t count = 0;
  left = 0;
  for (const scene::Camera& camera : s.cameras) {
    for (auto& ray : rays) ray = bvh::test::make_ray(vec3(camera.to_world[3]), random.direction());
    for (int bounce = 0; bounce < 4; ++bounce) {
      tracer.trace(bvh::Query::closest, rays, hits, nullptr, static_cast<uint32_t>(rays.size()), false);
      for (size_t i = 0; i < rays.size(); ++i) {
        const shared::Ray ray = rays[i];
        const vec3 from(ray.origin[0], ray.origin[1], ray.origin[2]),
            d(ray.direction[0], ray.direction[1], ray.direction[2]);
        vec3 next = vec3(camera.to_world[3]);
        vec3 direction = random.direction();
        if (hits[i].prim == shared::k_no_hit) {
          ++left;
          bool allowed = false;
          for (const Opening& o : openings) allowed = allowed || passes(ray, o);
          count += !allowed;
        } else {
          const vec3* v = &mesh.vertices[3 * size_t{hits[i].prim}];
          vec3 n = glm::normalize(glm::cross(v[1] - v[0], v[2] - v[0]));
          if (glm::dot(n, d) > 0) n = -n;
          next = from + hits[i].t * d + 1e-5f * n;
          if (glm::dot(direction, n) < 0) direction = -direction;
        }
        rays[i] = bvh::test::make_ray(next, direction);
      }
    }
  }
  return count;
}

}  // namespace

TEST_CASE("every scene loads without warnings, with valid settings and a camera named main") {
  REQUIRE(names().size() >= 14);
  for (const std::string& name : names()) {
    INFO(name);
    const scene::Scene s = scene::load(file_of(name));
    for (const std::string& warning : s.warnings) FAIL_CHECK(warning);
    CHECK(s.unknown_extensions.empty());
    CHECK_NOTHROW(scene::find_camera(s, "main"));
    plan::Settings settings;
    for (const auto& [key, value] : s.settings) CHECK_NOTHROW(settings.set(key, value));
    CHECK(settings.text("about").size() > 40);
  }
}

TEST_CASE("every scene is in the list") {
  std::ifstream file(k_scenes / "README.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (const std::string& name : names()) {
    INFO(name);
    CHECK(text.find("`" + name + "`") != std::string::npos);
  }
}

TEST_CASE("rays leave rooms only through their openings") {
  struct Room {
    const char* scene;
    std::vector<Opening> openings;
  };
  const Room rooms[] = {
      {"teapot", {}},
      {"ajar", {}},
      {"conference", {}},
      {"arcade", {}},
      {"sun-patch", {{{-2.6f, 0.98f, 0.12f}, {-2.6f, 2.18f, 1.0f}}}},
      {"window", {{{-2.49f, 1.02f, -1.62f}, {-2.49f, 2.06f, -0.70f}}}},
      {"classroom",
       {{{-4.16f, 0.92f, -3.35f}, {-4.16f, 2.85f, -1.25f}},
        {{-4.16f, 0.92f, -0.85f}, {-4.16f, 2.85f, 1.25f}},
        {{-4.16f, 0.92f, 1.65f}, {-4.16f, 2.85f, 3.75f}}}},
      {"hall",
       {{{-2.5f, 9.6f, 3.85f}, {2.5f, 9.6f, 8.95f}},
        {{-2.5f, 9.6f, -2.55f}, {2.5f, 9.6f, 2.55f}},
        {{-2.5f, 9.6f, -8.95f}, {2.5f, 9.6f, -3.85f}}}},
  };
  for (const Room& room : rooms) {
    INFO(room.scene);
    size_t left = 0;
    CHECK(leaks(scene::load(file_of(room.scene)), room.openings, left) == 0);
    CHECK((left > 0) == !room.openings.empty());
  }
}

TEST_CASE("the arcade has about a thousand lamps of plausible power") {
  const scene::Scene s = scene::load(file_of("arcade"));
  CHECK(s.cameras.size() == 3);
  // Lamps with an extent: connected emissive surfaces. Panes of the vault belong to the sky.
  size_t lamps = s.lights.size();
  double watts = 0, sky = 0;
  for (const scene::Light& light : s.lights) {
    const double power = double(luminance(light.intensity)) * scene::solid_angle(light);
    CHECK(light.kind == scene::LightKind::spot);
    CHECK(power > 0.5);
    CHECK(power < 16);
    watts += power;
  }
  for (const scene::Instance& instance : s.instances)
    for (const scene::Primitive& p : s.meshes[instance.mesh].primitives) {
      const scene::Material& material = s.materials[p.material];
      const auto radiance = double(luminance(material.emission));
      if (!(radiance > 0)) continue;
      const auto at = [&](uint32_t i) { return vec3(instance.to_world * vec4(p.positions[i], 1)); };
      double area = 0;
      for (const uvec3& t : p.triangles)
        area += 0.5 * double(glm::length(glm::cross(at(t.y) - at(t.x), at(t.z) - at(t.x))));
      const double power = 3.14159265 * radiance * area;
      if (material.name == "night glass") {
        sky += power;
        continue;
      }
      INFO(material.name);
      CHECK(power > 0.05);
      CHECK(power < 60);  // a chandelier
      watts += power, ++lamps;
    }
  CHECK(lamps > 900);
  CHECK(lamps < 1300);
  CHECK(watts > 1000);
  CHECK(watts < 4000);
  CHECK(sky < 0.05 * watts);
}

TEST_CASE("the conference hall's twenty spots are unobstructed") {
  const scene::Scene s = scene::load(file_of("conference"));
  REQUIRE(s.lights.size() == 20);
  const bvh::test::Mesh mesh = triangles(s);
  const bvh::HostTracer tracer(mesh.view());
  Random random(11);
  std::vector<shared::Ray> rays;
  for (const scene::Light& light : s.lights) {
    CHECK(light.kind == scene::LightKind::spot);
    for (int i = 0; i < 64;) {
      const vec3 direction = random.direction();
      if (glm::dot(direction, light.direction) < std::cos(light.outer_cone)) continue;
      rays.push_back(bvh::test::make_ray(light.position, direction));
      ++i;
    }
  }
  std::vector<shared::Hit> hits(rays.size());
  tracer.trace(bvh::Query::closest, rays, hits, nullptr, static_cast<uint32_t>(rays.size()), false);
  // The ceiling around the recessed lamps does not block them: curtains and walls are the nearest surfaces.
  size_t near = 0;
  for (const shared::Hit& hit : hits) near += hit.prim == shared::k_no_hit || hit.t < 0.8f;
  CHECK(near == 0);
}

}  // namespace scenes_tests
