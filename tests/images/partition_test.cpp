// links: session
// The four components are a partition: their sum is the plain path tracer's image, switching one off changes
// no other by a bit, and the image is a function of scene, settings and seed alone.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "support/render.h"

using namespace lucerna;
using test::identical;

namespace {

constexpr const char* k_names[] = {"primary", "secondary", "tertiary", "caustic"};

}  // namespace

TEST_CASE("the components' sum agrees with a tracer that has no automaton") {
  for (const char* scene : {"cornell", "glass"}) {
    const test::Result parts = test::render({.scene = scene, .samples = 256, .settings = {{"seed", "1"}}});
    const test::Result whole = test::render({.scene = scene,
                                             .samples = 256,
                                             .settings = {{"seed", "2"}},
                                             .defines = {{"LUCERNA_NO_AUTOMATON", "1"}}});
    // Z-test of 8x8-pixel blocks, errors from the halves of both; 64 blocks of 3 channels. The halves' errors
    // of the 64 pixels estimate each block's variance. |z| < 5 leaves a false alarm below 1 in 5000
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
    for (int c = 1; c < film::k_components; ++c)
      for (const vec3& v : whole.image.components[c]) CHECK(v == vec3(0));
  }
}

TEST_CASE("switching a component off leaves the others bit-identical") {
  const test::Result all = test::render({.scene = "glass", .width = 48, .height = 48, .samples = 8});
  for (int off = 0; off < 4; ++off) {
    const test::Result some =
        test::render({.scene = "glass",
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
    // Off is not merely multiplied by zero. (Caustics are found on the way to tertiary light, which goes on.)
    CHECK(some.stats.rays <= all.stats.rays);
    if (off != 3) CHECK(some.stats.rays < all.stats.rays);
  }
}

TEST_CASE("the image does not depend on the size of batches, the tracer's threads or a second run") {
  for (const char* tracer : {"host", "compute-bvh"}) {
    const test::Render base{
        .scene = "glass", .width = 40, .height = 36, .samples = 8, .settings = {{"tracer", tracer}}};
    test::Render small = base;
    small.settings["path.batch"] = "1024";
    const test::Result a = test::render(base), b = test::render(base), c = test::render(small);
    CHECK(a.tracer == tracer);
    CHECK(identical(a.image, b.image));
    CHECK(identical(a.image, c.image));
    test::Render other = base;
    other.settings["seed"] = "7";
    CHECK_FALSE(identical(a.image, test::render(other).image));
  }
}

TEST_CASE("coherent sampling changes the noise, not the mean") {
  // Pixels of a tile are not independent, so the deviation of the picture's mean is measured over seeds:
  // Student's t with 46 degrees of freedom, two-sided at 1e-3 for each of five layers, is 3.5.
  constexpr int k_seeds = 24;
  double mean[2][5] = {}, squares[2][5] = {};
  session::Renderer r({.device = "cpu", .validation = false, .shaders = {}, .defines = {}});
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

TEST_CASE("both tracers make the same image but for grazing ties") {
  test::Render r{.scene = "glass", .width = 40, .height = 36, .samples = 8, .settings = {{"tracer", "host"}}};
  const test::Result host = test::render(r);
  r.settings["tracer"] = "compute-bvh";
  const test::Result compute = test::render(r);
  size_t different = 0;
  for (size_t i = 0; i < host.image.samples.size(); ++i)
    different += test::sum_at(host.image, i) != test::sum_at(compute.image, i);
  INFO(different << " of " << host.image.samples.size() << " pixels differ");
  CHECK(different < host.image.samples.size() / 50);
}
