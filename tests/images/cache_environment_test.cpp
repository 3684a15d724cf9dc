// links: session
// Pictures in which records store environment light (components.primary=cache), compared with path-traced
// ones for each component: no light is lost or counted twice, for all combinations of lobes and emitters.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "support/render.h"
#include "support/rooms.h"

namespace cache_environment_tests {

using namespace lucerna;
using test::identical, test::mean, test::Mean, test::Result, test::Settings;

namespace {

const Settings k_sky{
    {"components.secondary", "cache"}, {"components.tertiary", "cache"}, {"components.primary", "cache"},
    {"cache.error", "0.15"},           {"cache.noise", "0.1"},           {"cache.max_rays", "1024"}};

struct Room {
  bool sun = false;     ///< a patch of 2x2 texels of the environment is a thousand times brighter
  bool patch = false;   ///< the environment is dark except for a part visible through the window
  bool glossy = false;  ///< the floor has a rough coat
  bool mirror = false;  ///< on the back wall
  bool pane = false;    ///< in the window
  bool lamp = false;    ///< a panel under the ceiling
};

/// A room of 3 x 2.5 x 3 m with a window of 1.4 x 1.2 m in its right wall; the camera sees the back wall, the
/// floor and the window.
scene::Scene make_room(const Room& room) {
  scene::Scene s;
  s.name = "room", s.file = "room.gltf";
  enum { k_wall, k_floor, k_mirror, k_pane, k_lamp };
  s.materials.assign(5, test::diffuse(vec3(0.5f)));
  if (room.glossy)
    s.materials[k_floor].specular = 1, s.materials[k_floor].ior = 3, s.materials[k_floor].roughness = 0.5f;
  s.materials[k_mirror].metallic = 1, s.materials[k_mirror].roughness = 0, s.materials[k_mirror].specular = 1;
  s.materials[k_mirror].base_color = vec4(0.9f, 0.9f, 0.9f, 1);
  s.materials[k_pane].transmission = 1, s.materials[k_pane].roughness = 0, s.materials[k_pane].specular = 1;
  s.materials[k_pane].base_color = vec4(0.8f, 0.9f, 1, 1);
  s.materials[k_lamp] = test::diffuse(vec3(0), vec3(0.5f));
  const auto add = [&](const vec3& a, const vec3& u, const vec3& v, uint32_t material) {
    test::add_quad(s, a, u, v, material);
  };
  const vec3 o(-1.5f, 0, -1.5f), x(3, 0, 0), y(0, 2.5f, 0), z(0, 0, 3);
  add(o, z, x, k_floor), add(o + y, x, z, k_wall);
  add(o, x, y, k_wall), add(o + z, y, x, k_wall), add(o, y, z, k_wall);
  // The right wall around its window: z from -0.7 to 0.7, y from 0.8 to 2.
  const auto right = [&](float y0, float y1, float z0, float z1, uint32_t material) {
    add({1.5f, y0, z0}, {0, 0, z1 - z0}, {0, y1 - y0, 0}, material);
  };
  right(0, 0.8f, -1.5f, 1.5f, k_wall), right(2, 2.5f, -1.5f, 1.5f, k_wall);
  right(0.8f, 2, -1.5f, -0.7f, k_wall), right(0.8f, 2, 0.7f, 1.5f, k_wall);
  if (room.pane) right(0.8f, 2, -0.7f, 0.7f, k_pane);
  if (room.mirror) add({-1.2f, 0.3f, -1.49f}, {1.4f, 0, 0}, {0, 1.8f, 0}, k_mirror);
  if (room.lamp) add({-1.2f, 2.4f, -1.2f}, {2.4f, 0, 0}, {0, 0, 2.4f}, k_lamp);
  scene::Image sky;
  sky.name = "sky", sky.width = 32, sky.height = 16;
  for (uint32_t row = 0; row < 16; ++row)
    for (uint32_t column = 0; column < 32; ++column) {
      // Towards +x (column 16) and 35 degrees up: through the window onto the floor.
      const bool sun = room.sun && (column == 15 || column == 16) && (row == 4 || row == 5);
      const bool patch = column >= 13 && column < 19 && row >= 4 && row < 8;
      const float value = sun          ? 120.0f
                          : room.sun   ? 0.5f + float(16 - row) / 16
                          : room.patch ? (patch ? 2.0f : 0.1f)
                                       : 1.0f;
      sky.floats.insert(sky.floats.end(), {value, value, value, 1});
    }
  s.images.push_back(sky);
  s.environment.image = 0;
  s.environment.scale = 3;
  s.environment.given = true;
  scene::Camera camera;
  camera.yfov = 1.5f;
  camera.to_world =
      glm::inverse(glm::lookAt(vec3(-1.3f, 1.6f, 1.35f), vec3(0.5f, 0.7f, -0.6f), vec3(0, 1, 0)));
  s.cameras = {camera};
  return s;
}

Result render(const scene::Scene& scene, const Settings& settings, uint32_t samples, uint32_t size = 32) {
  return test::render(scene, settings, samples, size);
}

/// The means of every component agree: two-sided at 1e-4 for each figure (3.9 standard errors, from the
/// films' halves) plus 2 % of the component for record errors. The standard error is less than 1 % of the
/// picture, so a component that is lost or counted twice fails. The primary component must also agree in each
/// of 16 parts of the picture, within 5 %.
void compare(const Result& path, const Result& cached) {
  double whole = 0;
  for (const auto& c : path.image.components) whole += mean(c);
  for (int c = 0; c < 4; ++c) {
    const double truth = mean(path.image.components[c]), value = mean(cached.image.components[c]);
    const double noise = std::hypot(path.error.rms[c + 1] / std::sqrt(path.error.pixels),
                                    cached.error.rms[c + 1] / std::sqrt(cached.error.pixels));
    INFO(paths::k_component_names[c] << ": " << value << " of " << truth << ", noise of the mean " << noise);
    CHECK(std::abs(value - truth) <= 3.9 * noise + 0.02 * truth);
    CHECK(noise < 0.01 * whole);
  }
  for (uint32_t part = 0; part < 16; ++part) {
    const Mean truth = test::block_mean(path.image, 0, part % 4, part / 4),
               value = test::block_mean(cached.image, 0, part % 4, part / 4);
    const double noise = std::hypot(truth.noise, value.noise);
    INFO("part " << part << ": " << value.value << " of " << truth.value << ", noise " << noise);
    CHECK(std::abs(value.value - truth.value) <= 4.5 * noise + 0.05 * truth.value);
  }
}

/// Median over the picture of the relative difference of the sums.
double median_difference(const Result& a, const Result& b) {
  std::vector<double> all;
  for (size_t i = 0; i < a.image.samples.size(); ++i) {
    const double truth = luminance(test::sum_at(b.image, i));
    all.push_back(std::abs(luminance(test::sum_at(a.image, i)) - truth) / truth);
  }
  std::nth_element(all.begin(), all.begin() + all.size() / 2, all.end());
  return all[all.size() / 2];
}

}  // namespace

TEST_CASE("a room under an even environment") {
  const scene::Scene room = make_room({});
  const Result path = render(room, {}, 256), cached = render(room, k_sky, 16);
  compare(path, cached);
  // The picture has little noise, and reports that it may be biased.
  const Result sampled = render(room, {{"lights.portals", "marked"}}, 16);  // without portals
  CHECK(median_difference(cached, path) < 0.5 * median_difference(sampled, path));
  CHECK_FALSE(cached.bias_known[0]);
  CHECK_FALSE(cached.bias_known[1]);
  CHECK(cached.bias_known[3]);
  // Points that no record covers sample the environment themselves.
  Settings few = k_sky;
  few["cache.max_records"] = "40";
  compare(path, render(room, few, 64));
}

TEST_CASE("a sun in the environment image is always sampled directly") {
  const scene::Scene room = make_room({.sun = true});
  const Result path = render(room, {}, 256), cached = render(room, k_sky, 64);
  compare(path, cached);
}

TEST_CASE("a lamp together with an environment") {
  const scene::Scene room = make_room({.lamp = true});
  compare(render(room, {}, 256), render(room, k_sky, 64));
}

TEST_CASE("glossy lobes beside the diffuse one sample the environment themselves, also through a pane") {
  const scene::Scene room = make_room({.patch = true, .glossy = true, .pane = true});
  const Result path = render(room, {}, 512);
  compare(path, render(room, k_sky, 256));
}

TEST_CASE("a mirror shows the environment and the surfaces it lights") {
  const scene::Scene room = make_room({.mirror = true});
  compare(render(room, {}, 256), render(room, k_sky, 32));
}

TEST_CASE("under a constant environment a cached picture is exact after one sample") {
  scene::Scene plane;
  plane.name = "plane", plane.file = "plane.gltf";
  plane.materials = {test::diffuse({0.5f, 0.25f, 0.125f})};
  test::add_quad(plane, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
  plane.environment.radiance = vec3(2), plane.environment.given = true;
  scene::Camera camera;
  camera.to_world = glm::inverse(glm::lookAt(vec3(0, 3, 0), vec3(0), vec3(0, 0, 1)));
  plane.cameras = {camera};
  Settings settings = k_sky;
  // No surface is near, so records have the maximum radius.
  settings["cache.rays"] = "64";
  const Result cached = render(plane, settings, 1, 16);
  size_t off = 0;
  for (const vec3& v : cached.image.components[0])
    off += glm::length(v / vec3(1, 0.5f, 0.25f) - vec3(1)) > 1e-5f;
  CHECK(off == 0);
  for (const int c : {1, 2, 3}) CHECK(mean(cached.image.components[c]) == 0);
  settings["components.primary"] = "path";
  const Result sampled = render(plane, settings, 1, 16);
  CHECK(cached.stats.shadow_rays < sampled.stats.shadow_rays);
  CHECK(glm::length(sampled.image.components[0][0] - vec3(1, 0.5f, 0.25f)) > 1e-3f);
}

TEST_CASE("without an environment or without a cache, components.primary=cache changes nothing") {
  test::Render r{.scene = "cornell", .width = 16, .height = 16, .samples = 2, .settings = k_sky};
  r.settings["cache.passes"] = "1";
  const test::Result on = test::render(r);
  r.settings["components.primary"] = "path";
  const test::Result off = test::render(r);
  for (int c = 0; c < 4; ++c) CHECK(identical(on.image.components[c], off.image.components[c]));
  const scene::Scene room = make_room({.sun = true});
  const Result plain = render(room, {}, 4), with_option = render(room, {{"components.primary", "cache"}}, 4);
  for (int c = 0; c < 4; ++c) CHECK(identical(plain.image.components[c], with_option.image.components[c]));
  CHECK(with_option.bias_known[0]);
}

TEST_CASE("components.primary can be switched while a scene is shown") {
  session::Renderer r(test::renderer_options(true));
  r.set_size(16, 16);
  r.set_scene(std::make_shared<scene::Scene>(make_room({.sun = true})));
  const auto finish = [&] {
    test::set(r, {{"samples", "2"}});
    return test::finish(r);
  };
  for (const auto& [key, value] : k_sky) r.settings().set(key, value);
  for (const char* key : {"cache.rays", "cache.max_rays"}) r.settings().set(key, "64");
  r.settings().set("cache.passes", "1");
  r.settings().set("cache.metric", "split-sphere");  // places and radii do not depend on the light
  const film::Image first = finish();
  r.settings().set("cache.environment_threshold", "1000");
  const film::Image no_sun = finish();
  CHECK_FALSE(identical(no_sun.components[0], first.components[0]));
  r.settings().set("components.primary", "path");
  finish();
  r.set_environment(3, 20);
  r.settings().set("components.primary", "cache");
  r.settings().set("cache.environment_threshold", "16");
  finish();
  r.set_environment(3, 0);
  const film::Image again = finish();
  for (int c = 0; c < 4; ++c) CHECK(identical(again.components[c], first.components[c]));
  // The environment is switched off and on again.
  r.set_environment(0, 0);
  CHECK(mean(finish().components[0]) == 0);
  r.set_environment(3, 0);
  CHECK(identical(finish().components[1], first.components[1]));
  CHECK(r.device().validation_messages() == 0);
}

}  // namespace cache_environment_tests
