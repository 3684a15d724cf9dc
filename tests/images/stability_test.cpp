// links: session
// Extreme inputs stay finite and correct: extreme lights, materials, sizes and positions give no NaN, no
// infinity and no crash. The light is that of the closed form: a non-absorbing object vanishes in an even
// environment, and a picture is independent of scale.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/render.h"

namespace stability_tests {

using namespace lucerna;

namespace {

scene::Primitive quad(vec3 corner, vec3 u, vec3 v, scene::Id material) {
  scene::Primitive p;
  const vec3 n = glm::normalize(glm::cross(u, v));
  p.positions = {corner, corner + u, corner + u + v, corner + v};
  p.normals.assign(4, n);
  p.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  p.triangles = {{0, 1, 2}, {0, 2, 3}};
  p.material = material;
  return p;
}

/// A floor, a box of `material` on it, a small lamp and a camera, all of size `size` metres and moved to
/// `place`.
scene::Scene make_scene(const scene::Material& material, float size, vec3 place, float radiance) {
  scene::Scene s;
  s.name = s.file = "stability";
  scene::Material floor;
  floor.base_color = vec4(0.7f, 0.7f, 0.7f, 1);
  scene::Material lamp;
  lamp.emission = vec3(radiance);
  lamp.double_sided = true;
  s.materials = {floor, material, lamp};
  scene::Mesh mesh;
  const float a = size;
  mesh.primitives.push_back(quad(place + vec3(-a, 0, -a), vec3(0, 0, 2 * a), vec3(2 * a, 0, 0), 0));
  const vec3 low = place + vec3(-0.4f * a, 0.001f * a, -0.4f * a), x(0.8f * a, 0, 0), y(0, 0.8f * a, 0),
             z(0, 0, 0.8f * a);
  mesh.primitives.push_back(quad(low, x, z, 1));
  mesh.primitives.push_back(quad(low + y, z, x, 1));
  mesh.primitives.push_back(quad(low, y, x, 1));
  mesh.primitives.push_back(quad(low + z, x, y, 1));
  mesh.primitives.push_back(quad(low, z, y, 1));
  mesh.primitives.push_back(quad(low + x, y, z, 1));
  mesh.primitives.push_back(
      quad(place + vec3(0.6f * a, 1.5f * a, 0), vec3(0.2f * a, 0, 0), vec3(0, 0, 0.2f * a), 2));
  s.meshes = {mesh};
  s.instances = {{"all", 0, mat4(1), false}};
  scene::Camera c;
  c.to_world = mat4(1);
  const vec3 eye = place + vec3(0.3f * a, 0.7f * a, 2.5f * a),
             forward = glm::normalize(place + vec3(0, 0.3f * a, 0) - eye);
  const vec3 right = glm::normalize(glm::cross(forward, vec3(0, 1, 0)));
  c.to_world = mat4(vec4(right, 0), vec4(glm::cross(right, forward), 0), vec4(-forward, 0), vec4(eye, 1));
  s.cameras = {c};
  s.environment.radiance = vec3(0.1f * radiance);
  return s;
}

/// The box alone in an environment of radiance 1.
scene::Scene box_alone(const scene::Material& material) {
  scene::Scene s = make_scene(material, 1, vec3(0), 1);
  s.meshes[0].primitives = {s.meshes[0].primitives.begin() + 1, s.meshes[0].primitives.end() - 1};
  s.environment.radiance = vec3(1);
  return s;
}

struct Outcome {
  double mean = 0, error = 0;  ///< of the mean, from the halves
  bool finite = true;
  uint64_t dropped = 0;
};

Outcome render(const scene::Scene& s, const test::Settings& settings = {}) {
  session::Renderer r(test::renderer_options(false));
  r.settings().set("path.batch", "16384");
  r.set_size(32, 32);
  r.set_scene(std::make_shared<scene::Scene>(s));
  r.settings().set("samples", "16");
  test::set(r, settings);
  Outcome o;
  const film::Image image = test::finish(r);
  for (size_t i = 0; i < image.samples.size(); ++i) {
    // The halves' difference is twice the error of their mean.
    double off = 0;
    for (size_t c = 0; c < image.components.size(); ++c)
      for (int k = 0; k < 3; ++k)
        off += (double(image.odd_half[c][i][k]) - double(image.components[c][i][k])) / 3;
    o.error += off * off;
  }
  o.error = std::sqrt(o.error) / double(image.samples.size());
  for (const auto& component : image.components)
    for (const vec3& v : component)
      for (int k = 0; k < 3; ++k) {
        o.finite = o.finite && std::isfinite(v[k]) && v[k] >= 0;
        o.mean += v[k] / (3.0 * double(component.size()));
      }
  for (const vec3& v : image.normal) o.finite = o.finite && std::isfinite(v.x + v.y + v.z);
  for (const float z : image.depth) o.finite = o.finite && std::isfinite(z);
  o.dropped = r.stats().dropped;
  return o;
}

scene::Material glass(float roughness, float ior, float thickness) {
  scene::Material m;
  m.base_color = vec4(1);
  m.metallic = 0;
  m.roughness = roughness;
  m.ior = ior;
  m.transmission = 1;
  m.thickness = thickness;
  m.attenuation_color = vec3(0.9f, 0.5f, 0.1f);
  m.attenuation_distance = 0.1f;
  return m;
}

scene::Material metal(float roughness) {
  scene::Material m;
  m.base_color = vec4(1);
  m.roughness = roughness;
  return m;
}

}  // namespace

TEST_CASE("materials at the ends of their ranges") {
  std::vector<std::pair<const char*, scene::Material>> list{{"mirror", metal(0)},
                                                            {"almost a delta", metal(0.0316f)},
                                                            {"just above the delta", metal(0.0317f)},
                                                            {"rough metal", metal(1)},
                                                            {"clear glass", glass(0, 1.5f, 1)},
                                                            {"glass of no refraction", glass(0.3f, 1, 1)},
                                                            {"diamond", glass(0.1f, 2.4f, 1)},
                                                            {"dense rough glass", glass(1, 10, 1)},
                                                            {"window", glass(0, 1.5f, 0)},
                                                            {"frosted window", glass(0.5f, 1.5f, 0)}};
  scene::Material mirror_dielectric;
  mirror_dielectric.metallic = 0;
  mirror_dielectric.ior = 0;
  list.emplace_back("a dielectric with F = 1", mirror_dielectric);
  scene::Material leaf;
  leaf.metallic = 0;
  leaf.diffuse_transmission = 1;
  leaf.alpha_mode = scene::AlphaMode::blend;
  leaf.base_color = vec4(1, 1, 1, 0.5f);
  list.emplace_back("half a leaf", leaf);
  for (auto [name, material] : list) {
    const Outcome lit = render(make_scene(material, 1, vec3(0), 10));
    INFO(name);
    CHECK(lit.finite);
    CHECK(lit.dropped == 0);
    // The box alone in an environment of radiance 1: none of these materials absorbs light except by
    // attenuation.
    material.attenuation_distance = k_infinity;
    const Outcome o = render(box_alone(material), {{"path.max_depth", "1024"}});
    INFO("mean " << o.mean << " +- " << o.error);
    CHECK(o.finite);
    CHECK(o.dropped == 0);
    // In a solid of ior 10 light hits the surface about a hundred times before it leaves, and each hit loses
    // the rounding error of the albedo tables.
    CHECK(std::abs(o.mean - 1) < 4 * o.error + (material.ior > 5 ? 0.15 : 1e-3));
  }
}

TEST_CASE("rough glass with an ior of 1, or almost 1, loses no light") {
  for (const float ior : {1.0f, 1.0005f, 1.002f, 1.01f}) {
    INFO("ior " << ior);
    scene::Material m = glass(0.4f, ior, 1);
    m.attenuation_distance = k_infinity;
    CHECK(render(box_alone(m)).mean == Approx(1).epsilon(0.01));
  }
}

TEST_CASE("sizes, positions and brightness over many orders of magnitude") {
  struct Case {
    const char* name;
    float size;
    vec3 place;
    float radiance;
  };
  // Far away means 10^4 sizes: beyond that, float positions cannot represent the geometry.
  const auto picture = [](float size, vec3 place, float radiance) {
    scene::Material m = glass(0.2f, 1.5f, size);
    m.attenuation_distance *= size;
    const Outcome o = render(make_scene(m, size, place, radiance));
    CHECK(o.finite);
    CHECK(o.dropped == 0);
    return o;
  };
  const Outcome usual = picture(1, vec3(0), 1);
  // The same random numbers are drawn, so only single paths differ, which rounding changes.
  for (const Case& c : {Case{"a micrometre", 1e-6f, vec3(0), 10}, Case{"a planet", 1e7f, vec3(0), 10},
                        Case{"far away", 1, vec3(1e4f, -1e4f, 1e4f), 10}, Case{"blinding", 1, vec3(0), 1e30f},
                        Case{"almost dark", 1, vec3(0), 1e-30f}}) {
    const double mean = picture(c.size, c.place, c.radiance).mean / c.radiance;
    INFO(c.name << ": mean " << mean << " of " << usual.mean << " +- " << usual.error);
    CHECK(std::abs(mean - usual.mean) < (c.place == vec3(0) ? 1e-5 * usual.mean : 3 * usual.error));
  }
}

TEST_CASE("light that is too bright for float is dropped and counted, never written") {
  const Outcome o = render(make_scene(metal(0.3f), 1, vec3(0), 1e38f));
  CHECK(o.finite);
  scene::Scene s = make_scene(metal(0.3f), 1, vec3(0), 1);
  scene::Light l;
  l.intensity = vec3(1e38f);
  l.position = vec3(0, 0.4f, 0.41f);  // close to the side that the camera sees
  s.lights = {l};
  const Outcome p = render(s);
  CHECK(p.finite);
  CHECK(p.dropped > 0);
}

}  // namespace stability_tests
