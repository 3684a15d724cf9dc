// links: session
// The four components are a partition: their sum is the plain path tracer's image, switching one off changes
// no bit of another, and the image depends on scene, settings and seed only.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "support/render.h"
#include "support/rooms.h"

namespace partition_tests {

using namespace lucerna;
using test::identical;

namespace {

constexpr const char* k_names[] = {"primary", "secondary", "tertiary", "caustic"};

/// An open room under an uneven environment with a lamp, a textured emissive panel, textured walls, and in
/// front of its block of rough glass leaves, a pane and a leaf with a texture mask: everything that paths and
/// light samples pass.
scene::Scene open_room() {
  scene::Scene s = test::block_room(true);
  scene::Image image;
  image.name = "checks", image.width = image.height = 4;
  for (int k = 0; k < 16; ++k) {
    const bool odd = (k + k / 4) % 2;
    image.bytes.insert(image.bytes.end(),
                       {uint8_t(odd ? 250 : 90), 160, uint8_t(odd ? 60 : 200), uint8_t(odd ? 255 : 0)});
  }
  const auto picture = scene::Id(s.images.size());
  s.images.push_back(image);
  s.textures = {{.image = picture, .nearest = true, .srgb = true}};
  s.materials[0].base_color_texture.texture = 0;
  s.materials[1] = {};
  s.materials[1].metallic = 0, s.materials[1].roughness = 0.4f, s.materials[1].transmission = 1,
  s.materials[1].thickness = 1;
  scene::Material pane, leaf = test::diffuse({0.2f, 0.7f, 0.3f}), masked = leaf,
                        glow = test::diffuse(vec3(0.3f), {3, 2, 1});
  pane.metallic = 0, pane.roughness = 0, pane.transmission = 1, pane.base_color = vec4(0.9f, 0.95f, 1, 1);
  leaf.alpha_mode = scene::AlphaMode::blend, leaf.base_color.w = 0.4f, leaf.diffuse_transmission = 0.5f;
  masked.alpha_mode = scene::AlphaMode::mask, masked.base_color_texture.texture = 0;
  glow.emission_texture.texture = 0;
  s.materials.insert(s.materials.end(), {pane, leaf, masked, glow});
  test::add_quad(s, {-1.2f, 0.2f, 0.4f}, {1.6f, 0, 0}, {0, 1.4f, 0}, 2);
  test::add_quad(s, {-0.8f, 0.4f, 0.6f}, {1.0f, 0, 0}, {0, 1.2f, 0}, 3);
  test::add_quad(s, {-0.4f, 0.9f, 0.8f}, {1.4f, 0, 0}, {0, 0.8f, 0}, 4);
  test::add_quad(s, {0.2f, 0.5f, 0.7f}, {1.0f, 0, 0}, {0, 1.2f, 0}, 2);
  test::add_quad(s, {1.99f, 0.6f, -1}, {0, 0, 1}, {0, 1, 0}, 5);
  return s;
}
test::Result show(const test::Render& r) {
  static const scene::Scene room = open_room();
  return test::render(r, r.scene == "open room" ? &room : nullptr);
}

}  // namespace

TEST_CASE("the components' sum agrees with a path tracer without components") {
  for (const char* scene : {"open room", "glass"}) {
    const test::Result parts = show({.scene = scene, .samples = 128, .settings = {{"seed", "1"}}});
    const test::Result whole = show({.scene = scene,
                                     .samples = 128,
                                     .settings = {{"seed", "2"}},
                                     .defines = {{"LUCERNA_NO_AUTOMATON", "1"}}});
    for (const auto& component : parts.image.components) CHECK(test::mean(component) > 1e-3);
    // Z-test of 8x8-pixel blocks, errors from the halves of both; 64 blocks of 3 channels. The halves' errors
    // of the 64 pixels estimate each block's variance. |z| < 5 keeps the false alarm rate below 1 in 5000
    // (t-distributed, 64 degrees of freedom).
    for (uint32_t block = 0; block < 64; ++block)
      for (int channel = 0; channel < 3; ++channel) {
        double difference = 0, variance = 0;
        for (uint32_t k = 0; k < 64; ++k) {
          const size_t i = size_t(block / 8 * 8 + k / 8) * 64 + block % 8 * 8 + k % 8;
          const double a = test::sum_at(parts.image, i)[channel], b = test::sum_at(whole.image, i)[channel];
          double odd_a = 0;
          for (const auto& half : parts.image.odd_half) odd_a += half[i][channel];
          const double odd_b = whole.image.odd_half[0][i][channel];
          difference += a - b;
          variance += (odd_a - a) * (odd_a - a) + (odd_b - b) * (odd_b - b);
        }
        INFO(scene << ": block " << block << " channel " << channel << " difference " << difference / 64);
        CHECK(std::abs(difference) < 5 * std::sqrt(variance) + 1e-4);
      }
    for (uint32_t c = 1; c < shared::k_component_count; ++c)
      for (const vec3& v : whole.image.components[c]) CHECK(v == vec3(0));
  }
}

TEST_CASE("switching a component off leaves the others bit-identical") {
  const test::Result all = show({.scene = "open room", .width = 48, .height = 48, .samples = 8});
  for (int off = 0; off < 4; ++off) {
    const test::Result some = show({.scene = "open room",
                                    .width = 48,
                                    .height = 48,
                                    .samples = 8,
                                    .settings = {{std::string("components.") + k_names[off], "off"}}});
    for (int c = 0; c < 4; ++c) {
      INFO(k_names[off] << " off, " << k_names[c]);
      if (c == off)
        for (const vec3& v : some.image.components[c]) CHECK(v == vec3(0));
      else
        CHECK(identical(all.image.components[c], some.image.components[c]));
    }
    // A component that is off is not merely multiplied by zero. (Caustics are found on the way to tertiary
    // light, which stays on.)
    CHECK(some.stats.rays <= all.stats.rays);
    if (off != 3) CHECK(some.stats.rays < all.stats.rays);
  }
}

TEST_CASE("the image does not depend on batch size, the tracer's threads or a second run") {
  for (const char* tracer : {"host", "compute-bvh"}) {
    const test::Render base{
        .scene = "open room", .width = 40, .height = 36, .samples = 8, .settings = {{"tracer", tracer}}};
    test::Render small = base;
    small.settings["path.batch"] = "1024";
    const test::Result a = show(base), b = show(base), c = show(small);
    CHECK(a.tracer == tracer);
    CHECK(identical(a.image, b.image));
    CHECK(identical(a.image, c.image));
    test::Render other = base;
    other.settings["seed"] = "7";
    CHECK_FALSE(identical(a.image, show(other).image));
  }
}

TEST_CASE("coherent sampling changes the noise, not the mean") {
  // Pixels of a tile are not independent, so the deviation of the picture's mean is measured over seeds:
  // Student's t with 46 degrees of freedom, two-sided at 1e-3 for each of five layers, is 3.5.
  constexpr int k_seeds = 24;
  double mean[2][5] = {}, squares[2][5] = {};
  session::Renderer r(test::renderer_options(false));
  r.set_size(32, 32);
  r.load(std::string(LUCERNA_SOURCE_DIR) + "/scenes/cornell/cornell.gltf");
  r.settings().set("samples", "8");
  std::vector<vec3> first[2];
  for (const int coherent : {0, 1}) {
    r.settings().set("sampling.coherent", coherent ? "true" : "false");
    for (int seed = 0; seed < k_seeds; ++seed) {
      r.settings().set("seed", std::to_string(seed));
      r.apply_settings();
      while (r.step()) {
      }
      const film::Image image = r.image();
      if (seed == 0) first[coherent] = image.components[0];
      double of[5] = {};
      for (int c = 0; c < 4; ++c)
        for (const vec3& v : image.components[c])
          of[c + 1] += luminance(v) / 1024, of[0] += luminance(v) / 1024;
      for (int k = 0; k < 5; ++k) mean[coherent][k] += of[k] / k_seeds, squares[coherent][k] += of[k] * of[k];
    }
  }
  CHECK_FALSE(identical(first[0], first[1]));
  for (int k = 0; k < 5; ++k) {
    double variance = 0;
    for (const int c : {0, 1})
      variance += (squares[c][k] - k_seeds * mean[c][k] * mean[c][k]) / (k_seeds - 1) / k_seeds;
    INFO("layer " << k << ": " << mean[0][k] << " and " << mean[1][k]);
    CHECK(std::abs(mean[0][k] - mean[1][k]) <= 3.5 * std::sqrt(variance));
  }
}

TEST_CASE("both tracers make the same image except at grazing ties") {
  test::Render r{
      .scene = "open room", .width = 40, .height = 36, .samples = 8, .settings = {{"tracer", "host"}}};
  const test::Result host = show(r);
  r.settings["tracer"] = "compute-bvh";
  const test::Result compute = show(r);
  size_t different = 0;
  for (size_t i = 0; i < host.image.samples.size(); ++i)
    different += test::sum_at(host.image, i) != test::sum_at(compute.image, i);
  INFO(different << " of " << host.image.samples.size() << " pixels differ");
  CHECK(different < host.image.samples.size() / 50);
}

}  // namespace partition_tests
